// A run: its objects, its frames, and the state of all objects at any recorded moment.

import { readChunk } from "./chunk.js";
import { openIndex } from "./mcap.js";
import { readContacts, readPoints, readTopology } from "./points.js";
import { readCameras } from "./track.js";
import { Damage, Trouble } from "./trouble.js";

// Unpacked frames are kept up to this many bytes.
const KEPT_BYTES = 384e6;
const FRAMES_AHEAD = 6;

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
    // A frame is a chunk in which something moves; the meshes may lie in a chunk of their own.
    this.frames = index.chunks.filter((chunk) => points.some((id) => chunk.channels.has(id)));
    this.unpacked = new Map(); // chunk to promise of its moments, the longest unused first
    this.bytes = 0;
    if (this.objects.length === 0 || this.frames.length === 0) {
      throw this.complete
        ? new Trouble("There is no Nucleus run in this file.", "It is an MCAP file, but of something else.")
        : new Trouble("The file breaks off before its first whole frame.", "Was the run stopped at once?");
    }
  }

  // Frame number of the frame at `index`, from its time.
  frameNumber(index) {
    return this.run.start + Math.round((this.frames[index].end / 1e9) * this.run.fps);
  }

  // The first frame of this number or a later one; the last if there is none.
  indexOf(number) {
    const index = this.frames.findIndex((_, k) => this.frameNumber(k) >= number);
    return index < 0 ? this.frames.length - 1 : index;
  }

  // What the solver said about a frame; null if nothing.
  async report(index) {
    return (await this.unpack(this.frames[index])).report;
  }

  // Seconds from the start of the run to the end of the frame at `index`.
  time(index) {
    return this.frames[index].end / 1e9;
  }

  // The state at a moment of the frame at `index`; its last moment if `moment` is not given.
  async state(index, moment = Infinity) {
    const { moments, report } = await this.unpack(this.frames[index]);
    const last = Math.min(moment, moments.length - 1);
    if (moments.length === 0) {
      throw new Damage();
    }
    const all = this.objects.map((_, k) => this.objectAt(k, index, last, moments[last].nanoseconds));
    const [positions, meshes] = [[], []];
    for (const found of await Promise.all(all)) {
      positions.push(found.positions);
      meshes.push(found.mesh);
    }
    const { frame, substep, substeps, time } = moments[last];
    const contacts = this.objects.map((object) => moments[last].contacts.get(object.contacts) ?? null);
    return { index, moment: last, moments: moments.length, frame, substep, substeps, time, report, positions, meshes, contacts };
  }

  // Unpacks the frames that playing will need next. A damaged one is told of when it is shown.
  async prefetch(index) {
    for (let ahead = 1; ahead <= FRAMES_AHEAD; ahead += 1) {
      const chunk = this.frames[(index + ahead) % this.frames.length];
      if (!this.unpacked.has(chunk)) {
        await this.unpack(chunk).catch(() => {});
      }
    }
  }

  // The positions of an object at a moment and the mesh that they are of. Each mesh has a number, so that one that is lost
  // is never taken for another.
  async objectAt(object, index, moment, nanoseconds) {
    const { positions, number } = await this.positionsOf(object, index, moment);
    const mesh = await this.meshAt(this.objects[object], nanoseconds);
    if (mesh.number !== number || mesh.points * 3 !== positions.length) {
      throw new Damage();
    }
    return { positions, mesh };
  }

  // A mesh, with the radius of its particles: that is said once for a run.
  topologyOf(channel, data) {
    const name = this.objects.find(({ mesh }) => mesh === channel)?.name;
    return { ...readTopology(data), radius: this.run.radii.get(name) ?? null };
  }

  // The mesh of an object at a time: the last that came before. The first is kept, the others with their frames.
  async meshAt(object, nanoseconds) {
    for (const chunk of object.meshChunks.slice(1).reverse()) {
      const { meshes } = chunk.start <= nanoseconds ? await this.unpack(chunk) : { meshes: [] };
      const held = meshes.findLast(({ channel, time }) => channel === object.mesh && time <= nanoseconds);
      if (held) {
        return held.topology;
      }
    }
    return object.topology;
  }

  // An object that did not move has no message: its last one holds.
  async positionsOf(object, index, moment) {
    const { points } = this.objects[object];
    for (let k = index; k >= 0; k -= 1) {
      if (!this.frames[k].channels.has(points)) {
        continue;
      }
      const { moments } = await this.unpack(this.frames[k]);
      const from = k === index ? moment : moments.length - 1;
      for (let m = from; m >= 0; m -= 1) {
        const found = moments[m].positions.get(points);
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
    const moments = known ?? this.readMoments(chunk);
    this.unpacked.set(chunk, moments);
    moments.catch(() => this.unpacked.delete(chunk)); // the next try may go better
    return moments;
  }

  async readMoments(chunk) {
    const { messages } = await readChunk(this.source, chunk);
    const moments = new Map(); // by time
    const at = (time) => {
      const moment = moments.get(time) ?? { nanoseconds: time, positions: new Map(), contacts: new Map() };
      moments.set(time, moment);
      return moment;
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
        const { positions, number, ...stamp } = readPoints(data);
        Object.assign(at(time), stamp).positions.set(channel, { positions, number });
        count(positions.byteLength);
      } else if (encoding === "nucleus.contacts.v1") {
        at(time).contacts.set(channel, readContacts(data));
        count(data.length);
      } else if (encoding === "nucleus.topology.v1" && time > 0) {
        meshes.push({ channel, time, topology: this.topologyOf(channel, data) });
        count(data.length);
      } else if (topic === "/report") {
        report = readReport(data);
      }
    }
    this.forget();
    return { moments: [...moments.values()].filter(({ frame }) => frame !== undefined).sort((a, b) => a.time - b.time), meshes, report };
  }

  forget() {
    for (const chunk of this.unpacked.keys()) {
      if (this.bytes <= KEPT_BYTES || this.unpacked.size <= FRAMES_AHEAD + 2) {
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
        if (error instanceof Trouble && !(error instanceof Damage)) {
          throw error;
        }
        throw new Trouble(`The mesh of “${object.name}” cannot be read.`, "The file is damaged at its beginning.");
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
      const channel = (what) => all.find((channel) => channel.topic === `/${name}/${what}`)?.id;
      return { name, mesh: id, points: channel("points"), contacts: channel("contacts") };
    })
    .filter(({ points }) => points !== undefined);
}

function readRun(metadata) {
  const run = metadata.get("nucleus.run") ?? new Map();
  const scene = metadata.get("nucleus.scene") ?? new Map();
  const number = (key, otherwise) => {
    const value = Number(run.get(key) ?? NaN);
    return Number.isFinite(value) ? value : otherwise;
  };
  return {
    start: number("start", 0),
    end: number("end", null),
    fps: Math.max(number("fps", 24), 1e-3),
    version: run.get("version") ?? "",
    scene: scene.get("path") ?? "",
    cameras: readCameras(metadata.get("nucleus.cameras")),
    floor: levelPlane(run.get("ground")),
    radii: readRadii(run),
  };
}

// The radius of the particles of each object that has some, by its name.
function readRadii(run) {
  const before = "radius of ";
  const found = [...run].filter(([key, text]) => key.startsWith(before) && Number(text) > 0);
  return new Map(found.map(([key, text]) => [key.slice(before.length), Number(text)]));
}

// The height of a plane given as point and normal, if it is level.
function levelPlane(text) {
  const [, y, , a, b, c] = (text ?? "").split(" ").map(Number);
  return Number.isFinite(y) && b > 0.999 * Math.hypot(a, b, c) ? y : null;
}

// Figures that older caches hold under another name: former name to present name.
const RENAMED_FIGURES = {
  caught: "pairs_reverted",
  crossed: "pairs_unresolved",
  pairs: "candidate_pairs",
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
