// Finds what a file holds that was never finished, by walking from record to record: a run that
// was killed leaves every whole frame behind, but no summary.

import { Reader } from "./bytes.js";
import { readChunk } from "./chunk.js";
import { MAGIC, OP, readChannel, readMetadata } from "./records.js";

// How much is read at once. What follows a chunk is small, so a step seldom needs more.
const WINDOW = 64 * 1024;
const HEAD = 9;

export async function scan(source, onProgress = () => {}) {
  const index = { channels: new Map(), chunks: [], metadata: new Map(), complete: false };
  const window = new Window(source);
  let at = MAGIC.length;
  while (at + HEAD <= source.size) {
    const head = new Reader(await window.read(at, HEAD));
    const [op, length] = [head.u8(), head.u64()];
    if (op === OP.dataEnd || op === OP.footer || at + HEAD + length > source.size) {
      break;
    }
    try {
      await take(index, window, { op, at, length });
    } catch (error) {
      if (!(error instanceof RangeError)) {
        throw error;
      }
      // A damaged record; the next one may be whole.
    }
    at += HEAD + length;
    onProgress(at / source.size);
  }
  await nameChannels(index, source);
  return index;
}

async function take(index, window, { op, at, length }) {
  const body = async (most) => new Reader(await window.read(at + HEAD, Math.min(length, most)));
  if (op === OP.chunk) {
    const times = await body(16);
    const [start, end] = [times.u64(), times.u64()];
    index.chunks.push({ start, end, offset: at, length: HEAD + length, channels: new Set() });
  } else if (op === OP.messageIndex) {
    const channel = (await body(2)).u16();
    index.chunks.at(-1)?.channels.add(channel);
  } else if (op === OP.channel) {
    const channel = readChannel(await body(length));
    index.channels.set(channel.id, channel);
  } else if (op === OP.metadata) {
    const { name, values } = readMetadata(await body(length));
    index.metadata.set(name, values);
  }
}

// Channels are introduced inside the chunk that first uses them. The last chunk may lack its
// message indexes, so what it holds is looked up too.
async function nameChannels(index, source) {
  const last = index.chunks.at(-1);
  for (const chunk of index.chunks) {
    const isNews = [...chunk.channels].some((id) => !index.channels.has(id));
    if (!isNews && chunk !== last && chunk.channels.size > 0) {
      continue;
    }
    try {
      const { channels, messages } = await readChunk(source, chunk);
      channels.forEach((channel) => index.channels.set(channel.id, channel));
      messages.forEach(({ channel }) => chunk.channels.add(channel));
    } catch {
      chunk.damaged = true;
    }
  }
  index.chunks = index.chunks.filter((chunk) => !chunk.damaged);
}

// Reads small pieces through a large one.
class Window {
  constructor(source) {
    this.source = source;
    this.start = 0;
    this.bytes = new Uint8Array();
  }

  async read(offset, length) {
    if (offset < this.start || offset + length > this.start + this.bytes.length) {
      const most = Math.min(Math.max(length, WINDOW), this.source.size - offset);
      this.bytes = await this.source.read(offset, most);
      this.start = offset;
    }
    return this.bytes.subarray(offset - this.start, offset - this.start + length);
  }
}
