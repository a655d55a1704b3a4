// The records of an MCAP file, as far as a player needs them. The format: https://mcap.dev/spec.

import { Reader } from "./bytes.js";

export const OP = {
  header: 0x01, footer: 0x02, channel: 0x04, message: 0x05, chunk: 0x06, messageIndex: 0x07,
  chunkIndex: 0x08, metadata: 0x0c, metadataIndex: 0x0d, dataEnd: 0x0f,
};
export const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];

// Opcode and body of each record in a run of bytes; a record that is cut off ends it.
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
