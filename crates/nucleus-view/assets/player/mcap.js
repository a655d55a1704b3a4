// The index of an MCAP file: from its summary, or from a scan of its records if it has none.

import { PlayerError } from "./source.js";
import { MAGIC, OP, Reader, crc32, readChannel, readChunk, readChunkIndex, readMetadata, records } from "./records.js";

const FOOTER_LENGTH = 9 + 20 + MAGIC.length;
// Length of the part of the footer that the checksum of the summary covers.
const CHECKED_FOOTER = 9 + 16;
const MAX_SUMMARY = 256e6;

// The index of a file: `channels` by id, `chunks` in order of time, `metadata` by name, and whether the file is
// `complete`, which means that it has a summary.
export async function openIndex(source, onProgress) {
  await checkStart(source);
  const summary = await readSummary(source);
  const index = summary ?? (await scan(source, onProgress));
  index.chunks.sort((a, b) => a.end - b.end || a.offset - b.offset);
  return index;
}

async function checkStart(source) {
  if (source.size === 0) {
    throw new PlayerError("The file is empty.");
  }
  const bytes = await source.read(0, Math.min(source.size, 4096));
  if (!startsWithMagic(bytes)) {
    throw new PlayerError("This is not a cache.", "A Nucleus cache is an MCAP file; its name ends in .mcap.");
  }
}

function startsWithMagic(bytes) {
  return MAGIC.every((byte, k) => bytes[k] === byte);
}

// The index from the summary at the end of the file; null if the summary is missing or damaged.
async function readSummary(source) {
  if (source.size < FOOTER_LENGTH + MAGIC.length) {
    return null;
  }
  const footer = new Reader(await source.read(source.size - FOOTER_LENGTH, FOOTER_LENGTH));
  const [op, , start, , sum] = [footer.u8(), footer.u64(), footer.u64(), footer.u64(), footer.u32()];
  const length = source.size - FOOTER_LENGTH - start;
  if (op !== OP.footer || !startsWithMagic(footer.bytes.subarray(29)) || start === 0) {
    return null;
  }
  if (!(length >= 0 && length <= MAX_SUMMARY)) {
    return null;
  }
  const bytes = await source.read(start, length + FOOTER_LENGTH);
  const checked = bytes.subarray(0, length + CHECKED_FOOTER);
  if (sum !== 0 && crc32(checked) !== sum) {
    return null;
  }
  try {
    return await parseSummary(source, bytes.subarray(0, length));
  } catch (error) {
    return nullUnlessPlayerError(error);
  }
}

// An error of a damaged record means that there is no summary; an error of the source is passed on.
function nullUnlessPlayerError(error) {
  if (error instanceof PlayerError) {
    throw error;
  }
  return null;
}

async function parseSummary(source, bytes) {
  const index = { channels: new Map(), chunks: [], metadata: new Map(), complete: true };
  const places = [];
  for (const { op, body } of records(bytes)) {
    if (op === OP.channel) {
      const channel = readChannel(body);
      index.channels.set(channel.id, channel);
    } else if (op === OP.chunkIndex) {
      index.chunks.push(readChunkIndex(body));
    } else if (op === OP.metadataIndex) {
      places.push({ offset: body.u64(), length: body.u64() });
    }
  }
  const isInside = ({ offset, length }) => offset + length <= source.size;
  if (!index.chunks.every(isInside) || !places.every(isInside)) {
    return null;
  }
  for (const { offset, length } of places.filter(({ length }) => length <= MAX_SUMMARY)) {
    for (const { op, body } of records(await source.read(offset, length))) {
      if (op === OP.metadata) {
        const { name, values } = readMetadata(body);
        index.metadata.set(name, values);
      }
    }
  }
  return index;
}

// Bytes per read. The records after a chunk are small, so a step rarely needs more.
const WINDOW = 64 * 1024;
const HEAD = 9;

// Walks from record to record. A run that was killed leaves complete frames, but no summary.
async function scan(source, onProgress = () => {}) {
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
      // A damaged record; the next one may be valid.
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

// Channels are declared in the chunk that first uses them. The last chunk is unpacked too, because its message indexes
// may be missing.
async function nameChannels(index, source) {
  const last = index.chunks.at(-1);
  for (const chunk of index.chunks) {
    const hasUnknown = [...chunk.channels].some((id) => !index.channels.has(id));
    if (!hasUnknown && chunk !== last && chunk.channels.size > 0) {
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

// Serves small reads from one large read.
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
