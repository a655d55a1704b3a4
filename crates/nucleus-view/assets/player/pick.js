// Picked points: found under the pointer, written as the components of a scene, and measured.

import { multiply } from "./camera.js";
import { NUMBERS } from "./particles.js";

// Distance in pixels within which a click beside all faces picks a point.
const REACH = 14;
// Most points that a text may name.
const MAX_READ = 1e5;

// The point of a visible object under a place on the canvas, in pixels: the nearest particle or face that is hit, of the face
// its nearest corner, of a surface the particle nearest to that; else the nearest point within reach. Null where there is none.
export function pointAt(scene, camera, [x, y]) {
  const { view, projection } = camera.matrices(scene.aspect);
  const matrix = multiply(projection, view);
  const { clientWidth, clientHeight } = scene.canvas;
  const place = (p, at) => {
    const [a, b, w] = [0, 1, 3].map((row) => matrix[row] * p[at] + matrix[4 + row] * p[at + 1] + matrix[8 + row] * p[at + 2] + matrix[12 + row]);
    return w > 0 ? [(0.5 + (0.5 * a) / w) * clientWidth - x, (0.5 - (0.5 * b) / w) * clientHeight - y, w] : null;
  };
  let best = { depth: Infinity, gap: Infinity, found: null };
  for (const { name, mesh, isShown, looks, recorded } of scene.objects) {
    if (!isShown || !mesh.points) {
      continue;
    }
    const places = Array.from({ length: mesh.count }, (_, v) => (mesh.isInvalid[v] ? null : place(mesh.positions, 3 * v)));
    const perDepth = ((mesh.radius ?? 0) * projection[5] * clientHeight) / 2;
    const radius = (v) => (perDepth * (looks?.[NUMBERS * v] ?? 1)) / places[v][2];
    best = mesh.kind === "particles" ? nearestDisc(name, places, radius, best) : nearestHit(name, mesh, places, best);
    const isSurface = mesh.kind === "surface";
    if (isSurface && best.found?.object === name) {
      best.found.point = nearestParticle(recorded, mesh.points, best.found.point);
    }
    best = best.depth < Infinity || isSurface ? best : nearestPoint(name, mesh, places, best);
  }
  return best.found;
}

// The particle that is nearest to a point of their surface.
function nearestParticle(particles, points, point) {
  const distance = (at) => Math.hypot(...[0, 1, 2].map((axis) => particles[3 * at + axis] - points[3 * point + axis]));
  let [found, least] = [0, Infinity];
  for (let at = 0; 3 * at < particles.length; at += 1) {
    const own = distance(at);
    [found, least] = own < least ? [at, own] : [found, least];
  }
  return found;
}

// The nearest triangle that contains the pointer, which is the origin of the places, and its nearest corner.
function nearestHit(object, mesh, places, best) {
  const corners = mesh.drawnTriangles;
  for (let k = 0; k < corners.length; k += 3) {
    const [a, b, c] = [places[corners[k]], places[corners[k + 1]], places[corners[k + 2]]];
    const shares = a && b && c && [area(b, c), area(c, a), area(a, b)];
    const sum = shares && shares[0] + shares[1] + shares[2];
    if (!sum || shares.some((share) => share / sum < 0)) {
      continue;
    }
    // Inverse depth is linear on the screen.
    const depth = sum / (shares[0] / a[2] + shares[1] / b[2] + shares[2] / c[2]);
    if (depth < best.depth) {
      const vertex = [0, 1, 2].map((j) => corners[k + j]).reduce((p, q) => (gapOf(places[q]) < gapOf(places[p]) ? q : p));
      best = { depth, gap: 0, found: { object, point: mesh.vertexPoint[vertex] } };
    }
  }
  return best;
}

// The nearest disc that contains the pointer, given the radius of each in pixels.
function nearestDisc(object, places, radius, best) {
  places.forEach((place, point) => {
    if (place && place[2] < best.depth && gapOf(place) < radius(point)) {
      best = { depth: place[2], gap: 0, found: { object, point } };
    }
  });
  return best;
}

// The nearest point within reach, where nothing is hit.
function nearestPoint(object, mesh, places, best) {
  places.forEach((place, v) => {
    const gap = place ? gapOf(place) : Infinity;
    if (gap < Math.min(REACH, best.gap)) {
      best = { depth: Infinity, gap, found: { object, point: mesh.vertexPoint[v] } };
    }
  });
  return best;
}

const area = (a, b) => a[0] * b[1] - a[1] * b[0];
const gapOf = (place) => Math.hypot(place[0], place[1]);

// Picked points, in the order in which they were picked.
export class Picks {
  constructor() {
    this.all = [];
  }

  // Picks a point in place of all others; with `isMore` beside them, or drops it again. Null drops all.
  pick(found, isMore) {
    const isSame = ({ object, point }) => object === found.object && point === found.point;
    if (!found || !isMore) {
      this.all = found ? [found] : isMore ? this.all : [];
    } else if (this.all.some(isSame)) {
      this.all = this.all.filter((one) => !isSame(one));
    } else {
      this.all = [...this.all, found];
    }
  }

  // As the components of a scene name them: `cloth1.vtx[0:3]`, `cloth1.vtx[7]`.
  get components() {
    return this.objects.flatMap(({ object, points }) => (
      runsOf(points).map(([first, last]) => `${object}.vtx[${first === last ? first : `${first}:${last}`}]`)
    ));
  }

  // Picks the points of such texts.
  read(texts) {
    this.all = texts.flatMap((text) => {
      const [, object, first, last = first] = /^(.+)\.vtx\[(\d+)(?::(\d+))?\]$/.exec(text) ?? [];
      const count = Math.min(MAX_READ, Number(last) - Number(first) + 1);
      return count > 0 ? Array.from({ length: count }, (_, k) => ({ object, point: Number(first) + k })) : [];
    });
  }

  // The points of each object, in ascending order.
  get objects() {
    const points = new Map();
    this.all.forEach(({ object, point }) => points.set(object, [...(points.get(object) ?? []), point]));
    return [...points].map(([object, own]) => ({ object, points: own.sort((a, b) => a - b) }));
  }

  // The places of the picked points that exist in the scene, in the order of picking.
  places(scene) {
    const placeOf = ({ object, point }) => {
      const own = scene.objects.find(({ name }) => name === object);
      const points = own?.recorded ?? own?.mesh.points ?? [];
      return 3 * point + 2 < points.length ? Array.from(points.slice(3 * point, 3 * point + 3)) : null;
    };
    return this.all.map(placeOf).filter(Boolean);
  }
}

// The first and the last of each run of consecutive numbers.
function runsOf(numbers) {
  const runs = [];
  for (const number of numbers) {
    runs.at(-1)?.[1] === number - 1 ? (runs.at(-1)[1] = number) : runs.push([number, number]);
  }
  return runs;
}
