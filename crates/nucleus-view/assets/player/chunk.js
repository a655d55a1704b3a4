// Unpacks one chunk, which holds one frame.

import { decompress } from "../vendor/fzstd.mjs";
import { Reader } from "./bytes.js";
import { crc32 } from "./crc.js";
import { OP, readChannel, records } from "./records.js";
import { Damage, Trouble } from "./trouble.js";

const LARGEST = 2 ** 30;

// The channels that a chunk introduces and its messages: { channel, time, data }.
export async function readChunk(source, { offset, length }) {
  if (length > LARGEST) {
    throw new Damage();
  }
  const record = new Reader(await source.read(offset, length));
  try {
    return unpack(record);
  } catch (error) {
    throw error instanceof Trouble ? error : new Damage();
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
  if (size > LARGEST) {
    throw new RangeError("too large");
  }
  if (compression === "") {
    return bytes;
  }
  if (compression !== "zstd") {
    throw new Trouble(`The file is compressed with ${compression}, which this player cannot read.`, "It reads zstd.");
  }
  const expanded = decompress(bytes, new Uint8Array(size));
  if (expanded.length !== size) {
    throw new RangeError("wrong length");
  }
  return expanded;
}
