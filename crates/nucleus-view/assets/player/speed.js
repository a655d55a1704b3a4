// The speed of particles, and of points of their surface; and the scale that fits the speeds of a run.

import { percentile } from "./compare.js";
import { roundUp } from "./figures.js";

// Frames to which the scale is fitted.
const SAMPLES = 9;

// The scale of the speeds of a run, in units per second: 99 % of the points of each object are slower in a few of its frames,
// rounded up. 0 if nothing moves.
export async function fittedSpeed(cache) {
  const last = cache.frames.length - 1;
  const frames = Array.from({ length: SAMPLES }, (_, k) => Math.max(1, Math.round((last * (k + 1)) / SAMPLES)));
  let largest = 0;
  for (const index of new Set(frames.filter((index) => index <= last))) {
    const [own, before] = [await cache.state(index).catch(() => null), await cache.state(index - 1).catch(() => null)];
    const speeds = own && before ? cache.objects.map((object, k) => speedsOf(object, k, own, before)) : [];
    largest = Math.max(largest, ...speeds.map((all) => percentile(all.filter(Number.isFinite).sort(), 0.99)));
  }
  return largest > 0 ? roundUp(largest) : 0;
}

// The speeds of the points of object `k`, empty where they are not known.
function speedsOf({ topology }, k, own, before) {
  if (own.meshes[k].kind === "particles") {
    return particleSpeeds(topology, k, own, before) ?? new Float32Array();
  }
  const isSame = own.meshes[k].number === before.meshes[k].number;
  const seconds = own.time - before.time;
  return isSame ? distances(own.positions[k], before.positions[k], (p) => p).map((x) => x / seconds) : new Float32Array();
}

// The speed of each particle of object `k`, in units per second: from its velocity where that is recorded, else from its
// positions at this frame and the one before, 0 if it is new. Null where it is not known: particles that are born or die
// without a recorded number cannot be found in the frame before.
export function particleSpeeds(topology, k, { positions, velocities, numbers, time, index }, before) {
  const vectors = velocities[k];
  if (vectors) {
    return Float32Array.from({ length: vectors.length / 3 }, (_, p) => (
      Math.hypot(vectors[3 * p], vectors[3 * p + 1], vectors[3 * p + 2]) || 0
    ));
  }
  const [now, then] = [positions[k], before?.positions[k] ?? null];
  if (numbers[k] && then) {
    const places = new Map(Array.from(before.numbers[k] ?? [], (number, p) => [number, p]));
    return distances(now, then, (p) => places.get(numbers[k][p])).map((x) => x / (time - before.time) || 0);
  }
  if (now.length !== 3 * topology.points || (then ? then.length !== now.length : index > 0)) {
    return null;
  }
  const seconds = then && time - before.time;
  return distances(now, then ?? now, (p) => p).map((x) => x / seconds || 0);
}

// The distance of each point of `now` to that of `then` at the place that `placeOf` gives; 0 where it gives none.
function distances(now, then, placeOf) {
  return Float32Array.from({ length: now.length / 3 }, (_, p) => {
    const place = placeOf(p);
    return place === undefined ? 0 : Math.hypot(...[0, 1, 2].map((axis) => now[3 * p + axis] - then[3 * place + axis]));
  });
}

// For each point, the value of the nearest of `others`; 0 where none is near.
export function nearestValues(points, others, values) {
  const cells = new Cells(others);
  return Float32Array.from({ length: points.length / 3 }, (_, p) => {
    const nearest = cells.nearest([points[3 * p], points[3 * p + 1], points[3 * p + 2]]);
    return nearest < 0 ? 0 : values[nearest];
  });
}

// Rings of cells that are searched round a point; a surface is near its particles.
const MAX_RINGS = 8;

// Points in the cubes of a grid.
class Cells {
  constructor(points) {
    this.points = points;
    const axes = [0, 1, 2].map((axis) => points.filter((x, k) => k % 3 === axis && Number.isFinite(x)));
    this.low = axes.map((all) => all.reduce((a, b) => Math.min(a, b), Infinity));
    const extent = axes.map((all, axis) => all.reduce((a, b) => Math.max(a, b), -Infinity) - this.low[axis]);
    const count = points.length / 3;
    const [long, middle, short] = extent.sort((a, b) => b - a);
    // About two points in a cell of a filled box, sheet or line.
    const sizes = [Math.cbrt((2 * long * middle * short) / count), Math.sqrt((2 * long * middle) / count), (2 * long) / count];
    this.size = Math.max(1e-9, long / 512, ...sizes.filter(Number.isFinite));
    this.cells = new Map();
    for (let k = 0; k < count; k += 1) {
      const key = this.key(...this.cellOf([points[3 * k], points[3 * k + 1], points[3 * k + 2]]));
      this.cells.has(key) ? this.cells.get(key).push(k) : this.cells.set(key, [k]);
    }
  }

  cellOf(at) {
    return at.map((x, axis) => Math.floor((x - this.low[axis]) / this.size));
  }

  key(x, y, z) {
    return ((x + 1024) * 4096 + y + 1024) * 4096 + z + 1024;
  }

  // The nearest point, or -1 if none is near.
  nearest(at) {
    const [x, y, z] = this.cellOf(at);
    let [found, least] = [-1, Infinity];
    for (let ring = 0; ring <= MAX_RINGS; ring += 1) {
      // Every point of this ring is at least ring - 1 cells away.
      if (least <= ((ring - 1) * this.size) ** 2) {
        break;
      }
      for (let i = -ring; i <= ring; i += 1) {
        for (let j = -ring; j <= ring; j += 1) {
          const isSide = Math.max(Math.abs(i), Math.abs(j)) === ring;
          for (let k = -ring; k <= ring; k += isSide || ring === 0 ? 1 : 2 * ring) {
            for (const point of this.cells.get(this.key(x + i, y + j, z + k)) ?? []) {
              const [a, b, c] = [0, 1, 2].map((axis) => this.points[3 * point + axis] - at[axis]);
              const square = a * a + b * b + c * c;
              [found, least] = square < least ? [point, square] : [found, least];
            }
          }
        }
      }
    }
    return found;
  }
}
