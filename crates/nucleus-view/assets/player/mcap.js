// Finds what an MCAP file holds without reading all of it: footer, then summary, then chunk indexes.

import { Reader } from "./bytes.js";
import { crc32 } from "./crc.js";
import { MAGIC, OP, readChannel, readChunkIndex, readMetadata, records } from "./records.js";
import { scan } from "./scan.js";
import { Trouble } from "./trouble.js";

const FOOTER_LENGTH = 9 + 20 + MAGIC.length;
// The part of the footer that the checksum of the summary covers: all before the sum itself.
const GUARDED_FOOTER = 9 + 16;
const LARGEST_SUMMARY = 256e6;

// What a file holds: `channels` by id, `chunks` in order of time, `metadata` by name, and
// whether it is `complete`, that is, was closed with a summary.
export async function openIndex(source, onProgress) {
  await checkStart(source);
  const summary = await readSummary(source);
  const index = summary ?? (await scan(source, onProgress));
  index.chunks.sort((a, b) => a.end - b.end || a.offset - b.offset);
  return index;
}

async function checkStart(source) {
  if (source.size === 0) {
    throw new Trouble("The file is empty.");
  }
  const bytes = await source.read(0, Math.min(source.size, 4096));
  if (!startsWithMagic(bytes)) {
    throw new Trouble("This is not a cache.", "A Nucleus cache is an MCAP file; its name mostly ends in .mcap.");
  }
}

function startsWithMagic(bytes) {
  return MAGIC.every((byte, k) => bytes[k] === byte);
}

// The summary at the end of the file, or null if the file was never finished or its summary is damaged.
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
  if (!(length >= 0 && length <= LARGEST_SUMMARY)) {
    return null;
  }
  const bytes = await source.read(start, length + FOOTER_LENGTH);
  const guarded = bytes.subarray(0, length + GUARDED_FOOTER);
  if (sum !== 0 && crc32(guarded) !== sum) {
    return null;
  }
  try {
    return await parseSummary(source, bytes.subarray(0, length));
  } catch (error) {
    return unlessTrouble(error);
  }
}

// What a damaged record throws means "not there"; a server that is gone is still to be told of.
function unlessTrouble(error) {
  if (error instanceof Trouble) {
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
  for (const { offset, length } of places.filter(({ length }) => length <= LARGEST_SUMMARY)) {
    for (const { op, body } of records(await source.read(offset, length))) {
      if (op === OP.metadata) {
        const { name, values } = readMetadata(body);
        index.metadata.set(name, values);
      }
    }
  }
  return index;
}
