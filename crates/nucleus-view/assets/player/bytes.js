// Reads little-endian numbers, strings and maps out of bytes, one after the other.

export class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }

  get left() {
    return this.bytes.length - this.at;
  }

  u8() {
    return this.view.getUint8(this.advance(1));
  }

  u16() {
    return this.view.getUint16(this.advance(2), true);
  }

  u32() {
    return this.view.getUint32(this.advance(4), true);
  }

  i32() {
    return this.view.getInt32(this.advance(4), true);
  }

  f64() {
    return this.view.getFloat64(this.advance(8), true);
  }

  // As a float: exact up to 2^53, which is past every length and time of a real file.
  u64() {
    const at = this.advance(8);
    return this.view.getUint32(at, true) + this.view.getUint32(at + 4, true) * 2 ** 32;
  }

  take(length) {
    const at = this.advance(length);
    return this.bytes.subarray(at, at + length);
  }

  string() {
    return new TextDecoder().decode(this.take(this.u32()));
  }

  // A map is its length in bytes, then keys and values.
  map(key, value) {
    const inside = new Reader(this.take(this.u32()));
    const map = new Map();
    while (inside.left > 0) {
      map.set(key(inside), value(inside));
    }
    return map;
  }

  advance(length) {
    const at = this.at;
    if (!(length >= 0 && length <= this.left)) {
      throw new RangeError(`${length} bytes wanted, ${this.left} left`);
    }
    this.at += length;
    return at;
  }
}
