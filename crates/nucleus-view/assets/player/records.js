// The records of an MCAP file, as far as the player needs them (https://mcap.dev/spec): bytes, checksum, chunks.

import { decompress } from "../vendor/fzstd.mjs";
import { DamagedFrame, PlayerError } from "./source.js";

// Reads little-endian numbers, strings and maps out of bytes in sequence.
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

  // As a float: exact up to 2^53, beyond any length and time in a file.
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

  // A map: its length in bytes, then keys and values.
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
      throw new RangeError(`${length} bytes requested, ${this.left} left`);
    }
    this.at += length;
    return at;
  }
}

// The checksum of MCAP (ISO 3309).
const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let sum = byte;
  for (let bit = 0; bit < 8; bit += 1) {
    sum = sum & 1 ? (sum >>> 1) ^ 0xedb88320 : sum >>> 1;
  }
  return sum;
});

export function crc32(bytes) {
  let sum = -1;
  for (let k = 0; k < bytes.length; k += 1) {
    sum = CRC_TABLE[(sum ^ bytes[k]) & 255] ^ (sum >>> 8);
  }
  return ~sum >>> 0;
}

export const OP = {
  header: 0x01, footer: 0x02, channel: 0x04, message: 0x05, chunk: 0x06, messageIndex: 0x07,
  chunkIndex: 0x08, metadata: 0x0c, metadataIndex: 0x0d, dataEnd: 0x0f,
};
export const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];

// Opcode and body of each record in a sequence of bytes, up to the first truncated record.
export function* records(bytes) {
  const reader = new Reader(bytes);
  while (reader.left >= 9) {
    const op = reader.u8();
    const length = reader.u64();
    if (length > reader.left) {
      return;
    }
    yield { op, body: new Reader(reader.take(length)) };
  }
}

export function readChannel(body) {
  const id = body.u16();
  body.u16(); // schema
  return { id, topic: body.string(), encoding: body.string() };
}

export function readMetadata(body) {
  return { name: body.string(), values: body.map((r) => r.string(), (r) => r.string()) };
}

export function readChunkIndex(body) {
  const [start, end, offset, length] = [body.u64(), body.u64(), body.u64(), body.u64()];
  const channels = new Set(body.map((r) => r.u16(), (r) => r.u64()).keys());
  return { start, end, offset, length, channels };
}

// Largest chunk that is unpacked, in bytes. A chunk holds one frame.
const MAX_CHUNK = 2 ** 30;

// The channels that are declared in a chunk, and its messages: { channel, time, data }.
export async function readChunk(source, { offset, length }) {
  if (length > MAX_CHUNK) {
    throw new DamagedFrame();
  }
  const record = new Reader(await source.read(offset, length));
  try {
    return unpack(record);
  } catch (error) {
    throw error instanceof PlayerError ? error : new DamagedFrame();
  }
}

function unpack(record) {
  if (record.u8() !== OP.chunk) {
    throw new RangeError("not a chunk");
  }
  record.u64(); // length of the record
  record.take(16); // times of the first and last message
  const [size, sum, compression] = [record.u64(), record.u32(), record.string()];
  const bytes = expand(record.take(record.u64()), compression, size);
  if (sum !== 0 && crc32(bytes) !== sum) {
    throw new RangeError("wrong checksum");
  }
  const chunk = { channels: [], messages: [] };
  for (const { op, body } of records(bytes)) {
    if (op === OP.channel) {
      chunk.channels.push(readChannel(body));
    } else if (op === OP.message) {
      const channel = body.u16();
      body.u32(); // sequence
      const time = body.u64();
      body.u64(); // publish time
      chunk.messages.push({ channel, time, data: body.take(body.left) });
    }
  }
  return chunk;
}

function expand(bytes, compression, size) {
  if (size > MAX_CHUNK) {
    throw new RangeError("too large");
  }
  if (compression === "") {
    return bytes;
  }
  if (compression !== "zstd") {
    throw new PlayerError(`The file is compressed with ${compression}.`, "This player reads zstd only.");
  }
  const expanded = decompress(bytes, new Uint8Array(size));
  if (expanded.length !== size) {
    throw new RangeError("wrong length");
  }
  return expanded;
}
