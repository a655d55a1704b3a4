// A cache: the objects and frames of a run, and the state of all objects at any recorded time.

import { openIndex } from "./mcap.js";
import { planeAt, planeOf } from "./plane.js";
import { readCameras, readContacts, readLooks, readParticleNumbers, readPoints, readTopology } from "./messages.js";
import { readChunk } from "./records.js";
import { DamagedFrame, PlayerError } from "./source.js";

// Memory for unpacked frames, in bytes.
const MAX_UNPACKED_BYTES = 384e6;
const PREFETCHED_FRAMES = 6;

export class Cache {
  static async open(source, onProgress) {
    const cache = new Cache(source, await openIndex(source, onProgress));
    await cache.readObjects();
    return cache;
  }

  constructor(source, index) {
    this.source = source;
    this.complete = index.complete;
    this.channels = index.channels;
    this.run = readRun(index.metadata);
    this.objects = objectsOf(index.channels);
    this.chunks = index.chunks;
    const points = this.objects.map((object) => object.points);
    // A frame is a chunk with positions; meshes may have separate chunks.
    this.frames = index.chunks.filter((chunk) => points.some((id) => chunk.channels.has(id)));
    this.unpacked = new Map(); // chunk to promise of its content, least recently used first
    this.bytes = 0;
    if (this.objects.length === 0 || this.frames.length === 0) {
      throw this.complete
        ? new PlayerError("This MCAP file holds no Nucleus run.", "It was written by another program.")
        : new PlayerError("The file ends before its first complete frame.", "The run was stopped too early.");
    }
  }

  // The number of the frame at `index`.
  frameNumber(index) {
    return this.run.start + Math.round((this.frames[index].end / 1e9) * this.run.fps);
  }

  // The index of the first frame with this number or a higher one; of the last frame if there is none.
  indexOf(number) {
    const index = this.frames.findIndex((_, k) => this.frameNumber(k) >= number);
    return index < 0 ? this.frames.length - 1 : index;
  }

  // The index of the frame with this number; null if the run has none.
  indexAt(number) {
    const index = this.indexOf(number);
    return this.frameNumber(index) === number ? index : null;
  }

  // The report of the solver for a frame; null if there is none.
  async report(index) {
    return (await this.unpack(this.frames[index])).report;
  }

  // Seconds from the start of the run to the end of the frame at `index`.
  time(index) {
    return this.frames[index].end / 1e9;
  }

  // The state at a recorded time of the frame at `index`, by default the end of the frame.
  async state(index, timeIndex = Infinity) {
    const { times, report } = await this.unpack(this.frames[index]);
    const last = Math.min(timeIndex, times.length - 1);
    if (times.length === 0) {
      throw new DamagedFrame();
    }
    const all = this.objects.map((_, k) => this.objectAt(k, index, last, times[last].nanoseconds));
    const [positions, velocities, meshes] = [[], [], []];
    for (const found of await Promise.all(all)) {
      positions.push(found.positions);
      velocities.push(found.velocities);
      meshes.push(found.mesh);
    }
    const { frame, substep, substeps, time } = times[last];
    const contacts = this.objects.map((object) => times[last].contacts.get(object.contacts) ?? null);
    const looks = this.objects.map((object) => times[last].looks.get(object.looks) ?? null);
    const numbers = this.objects.map((object) => times[last].numbers.get(object.numbers) ?? null);
    const at = { index, timeIndex: last, times: times.length, frame, substep, substeps, time };
    return { ...at, report, positions, velocities, meshes, contacts, looks, numbers };
  }

  // Unpacks the next frames. A damaged frame is reported when it is shown.
  async prefetch(index) {
    for (let ahead = 1; ahead <= PREFETCHED_FRAMES; ahead += 1) {
      const chunk = this.frames[(index + ahead) % this.frames.length];
      if (!this.unpacked.has(chunk)) {
        await this.unpack(chunk).catch(() => {});
      }
    }
  }

  // The positions of an object at a recorded time, and their mesh. Meshes are numbered, so that positions are never
  // combined with another mesh if theirs is lost.
  async objectAt(object, index, timeIndex, nanoseconds) {
    const { positions, velocities = null, number } = await this.positionsOf(object, index, timeIndex);
    const mesh = await this.meshAt(this.objects[object], nanoseconds);
    const isOfMesh = mesh.points * 3 === positions.length;
    if (mesh.number !== number || (!isOfMesh && mesh.kind !== "particles")) {
      throw new DamagedFrame();
    }
    // Particles come and go.
    return { positions, velocities, mesh: isOfMesh ? mesh : { ...mesh, points: positions.length / 3, rest: positions } };
  }

  // A mesh, with the radius of its particles, which is constant over a run.
  topologyOf(channel, data) {
    const name = this.objects.find(({ mesh }) => mesh === channel)?.name;
    return { ...readTopology(data), radius: this.run.radii.get(name) ?? null };
  }

  // The mesh of an object at a time: the last one before it. The first mesh is kept in memory, others with their chunks.
  async meshAt(object, nanoseconds) {
    for (const chunk of object.meshChunks.slice(1).reverse()) {
      const { meshes } = chunk.start <= nanoseconds ? await this.unpack(chunk) : { meshes: [] };
      const found = meshes.findLast(({ channel, time }) => channel === object.mesh && time <= nanoseconds);
      if (found) {
        return found.topology;
      }
    }
    return object.topology;
  }

  // An object that did not move has no message; its last message remains valid.
  async positionsOf(object, index, timeIndex) {
    const { points } = this.objects[object];
    for (let k = index; k >= 0; k -= 1) {
      if (!this.frames[k].channels.has(points)) {
        continue;
      }
      const { times } = await this.unpack(this.frames[k]);
      const from = k === index ? timeIndex : times.length - 1;
      for (let t = from; t >= 0; t -= 1) {
        const found = times[t].positions.get(points);
        if (found) {
          return found;
        }
      }
    }
    return { positions: this.objects[object].topology.rest, number: 0 };
  }

  unpack(chunk) {
    const known = this.unpacked.get(chunk);
    this.unpacked.delete(chunk);
    const content = known ?? this.readContent(chunk);
    this.unpacked.set(chunk, content);
    content.catch(() => this.unpacked.delete(chunk)); // so that it is read again next time
    return content;
  }

  // The recorded times of a chunk, the meshes that begin in it, and the report of its frame.
  async readContent(chunk) {
    const { messages } = await readChunk(this.source, chunk);
    const times = new Map(); // by nanoseconds
    const at = (time) => {
      const entry = times.get(time) ?? { nanoseconds: time, positions: new Map(), contacts: new Map(), looks: new Map(), numbers: new Map() };
      times.set(time, entry);
      return entry;
    };
    const count = (bytes) => {
      this.bytes += bytes;
      chunk.bytes = (chunk.bytes ?? 0) + bytes;
    };
    const meshes = [];
    let report = null;
    for (const { channel, time, data } of messages) {
      const { topic, encoding } = this.channels.get(channel) ?? {};
      if (encoding === "nucleus.points.v1") {
        const { positions, velocities, number, ...stamp } = readPoints(data);
        Object.assign(at(time), stamp).positions.set(channel, { positions, velocities, number });
        count(positions.byteLength + (velocities?.byteLength ?? 0));
      } else if (encoding === "nucleus.contacts.v1") {
        at(time).contacts.set(channel, readContacts(data));
        count(data.length);
      } else if (encoding === "nucleus.looks.v1") {
        const looks = readLooks(data);
        at(time).looks.set(channel, looks);
        count(looks.byteLength);
      } else if (encoding === "nucleus.particles.v1") {
        const numbers = readParticleNumbers(data);
        at(time).numbers.set(channel, numbers);
        count(numbers.byteLength);
      } else if (encoding === "nucleus.topology.v1" && time > 0) {
        meshes.push({ channel, time, topology: this.topologyOf(channel, data) });
        count(data.length);
      } else if (topic === "/report") {
        report = readReport(data);
      }
    }
    this.evict();
    const recorded = [...times.values()].filter(({ frame }) => frame !== undefined);
    return { times: recorded.sort((a, b) => a.time - b.time), meshes, report };
  }

  // Drops the least recently used chunks beyond the memory limit.
  evict() {
    for (const chunk of this.unpacked.keys()) {
      if (this.bytes <= MAX_UNPACKED_BYTES || this.unpacked.size <= PREFETCHED_FRAMES + 2) {
        return;
      }
      this.unpacked.delete(chunk);
      this.bytes -= chunk.bytes ?? 0;
      chunk.bytes = 0;
    }
  }

  async readObjects() {
    for (const object of this.objects) {
      try {
        object.meshChunks = this.chunks.filter(({ channels }) => channels.has(object.mesh));
        const { messages } = await readChunk(this.source, object.meshChunks[0]);
        object.topology = this.topologyOf(object.mesh, messages.find(({ channel }) => channel === object.mesh).data);
      } catch (error) {
        if (error instanceof PlayerError && !(error instanceof DamagedFrame)) {
          throw error;
        }
        throw new PlayerError(`The mesh of “${object.name}” cannot be read.`, "The beginning of the file is damaged; `nucleus recover` may restore it.");
      }
    }
  }
}

function objectsOf(channels) {
  const all = [...channels.values()];
  return all
    .filter(({ encoding }) => encoding === "nucleus.topology.v1")
    .map(({ id, topic }) => {
      const name = topic.replace(/^\//, "").replace(/\/topology$/, "");
      const channel = (kind) => all.find((channel) => channel.topic === `/${name}/${kind}`)?.id;
      const [points, contacts, looks, numbers] = ["points", "contacts", "looks", "particles"].map(channel);
      return { name, mesh: id, points, contacts, looks, numbers };
    })
    .filter(({ points }) => points !== undefined);
}

function readRun(metadata) {
  const run = metadata.get("nucleus.run") ?? new Map();
  const scene = metadata.get("nucleus.scene") ?? new Map();
  const number = (key, fallback) => {
    const value = Number(run.get(key) ?? NaN);
    return Number.isFinite(value) ? value : fallback;
  };
  return {
    start: number("start", 0),
    end: number("end", null),
    fps: Math.max(number("fps", 24), 1e-3),
    unitsPerMetre: number("units_per_metre", 1),
    version: run.get("version") ?? "",
    scene: scene.get("path") ?? "",
    cameras: readCameras(metadata.get("nucleus.cameras")),
    floor: planeOf(run.get("ground")),
    floors: (run.get("ground motion") ?? "").split("\n").map(planeOf),
    radii: readRadii(run),
    selections: readSelections(metadata.get("nucleus.selections")),
  };
}

// The points that constraints name: the constraint, the object, and the points with runs as their ends, `3 5:8`.
function readSelections(keys) {
  const entries = [...(keys ?? [])].filter(([key]) => key.startsWith("selection ")).sort(([a], [b]) => (a < b ? -1 : 1));
  return entries.map(([, text]) => {
    const [owner, object, points] = text.split("\n");
    const runs = (points ?? "").split(" ").filter(Boolean).map((run) => run.split(":").map(Number));
    return { owner, object, points: runs.flatMap(([first, last = first]) => Array.from({ length: last - first + 1 }, (_, k) => first + k)) };
  });
}

// The radius of the particles of each object with particles, by its name.
function readRadii(run) {
  const before = "radius of ";
  const found = [...run].filter(([key, text]) => key.startsWith(before) && Number(text) > 0);
  return new Map(found.map(([key, text]) => [key.slice(before.length), Number(text)]));
}

// The ground plane at a time in frames from the start, if it moves; linear between two frames.
export function floorAt({ floors }, frames) {
  const place = Math.min(Math.max(frames, 0), floors.length - 1);
  return planeAt(floors[Math.floor(place)], floors[Math.ceil(place)], place % 1);
}

// Figures that older caches hold under another name: former name to present name.
const RENAMED_FIGURES = {
  caught: "pairs_reverted",
  crossed: "pairs_unresolved",
  pairs: "candidate_pairs",
  pinched: "compressed",
  trapped: "depenetrating",
  tangled: "intersections",
  refused: "sanitized",
};

function readReport(data) {
  try {
    const report = JSON.parse(new TextDecoder().decode(data));
    return Object.fromEntries(Object.entries(report ?? {}).map(([key, value]) => [RENAMED_FIGURES[key] ?? key, value]));
  } catch {
    return null;
  }
}
