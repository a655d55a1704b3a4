// What a camera frames at first, and the boxes around objects, as in the pictures of `nucleus render`.

import { MAX_COORDINATE } from "./mesh.js";

// Number of particles from which on a camera leaves some out.
const FEW = 20;

// The bounding box of points, or of balls of a radius, without points that are not finite.
export function boxOf(points, radius = 0) {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let k = 0; k < points.length; k += 3) {
    const isDrawn = [0, 1, 2].every((axis) => Math.abs(points[k + axis]) <= MAX_COORDINATE); // false for NaN
    for (let axis = 0; isDrawn && axis < 3; axis += 1) {
      low[axis] = Math.min(low[axis], points[k + axis] - radius);
      high[axis] = Math.max(high[axis], points[k + axis] + radius);
    }
  }
  return { low, high };
}

// The union of boxes; null if all are empty. The bounds of an empty box are infinite and do not extend the union.
export function unionOf(boxes) {
  const low = [0, 1, 2].map((axis) => Math.min(...boxes.map((box) => box.low[axis])));
  const high = [0, 1, 2].map((axis) => Math.max(...boxes.map((box) => box.high[axis])));
  return low.every((x, axis) => x <= high[axis]) ? { low, high } : null;
}

// The box of what a camera frames: the simulated objects, of many particles most, and the colliders near them. A collider of
// more than three times their extent, such as a landscape, does not count. `objects` have a kind, points, and how far these are
// shown from where they are; null without any.
export function boxToFrame(objects) {
  const colliders = boxes(objects.filter(({ kind }) => kind === "collider"));
  const simulated = unionOf(boxes(objects.filter(({ kind }) => kind !== "collider")));
  if (!simulated) {
    return unionOf(colliders);
  }
  const extent = extentOf(simulated);
  const isNear = (box) => [0, 1, 2].every((axis) => (
    box.low[axis] <= simulated.high[axis] + extent / 2 && box.high[axis] >= simulated.low[axis] - extent / 2
  ));
  return unionOf([simulated, ...colliders.filter((box) => extentOf(box) <= 3 * extent && isNear(box))]);
}

// The box of objects, however large and far away; of many particles most. Null without any.
export function boxOfAll(objects) {
  return objects.length > 0 ? unionOf(boxes(objects)) : null;
}

const boxes = (objects) => objects.map(({ kind, points, shift }) => (
  moved(kind === "particles" ? boxOfMost(points) : boxOf(points), shift)
));

const moved = ({ low, high }, by = [0, 0, 0]) => ({
  low: low.map((x, axis) => x + by[axis]), high: high.map((x, axis) => x + by[axis]),
});

export const extentOf = ({ low, high }) => Math.max(...high.map((x, axis) => x - low[axis]));

// The box that has 95 % of the points below and above each of its sides: a few stray drops must not make everything else
// small.
function boxOfMost(points) {
  const all = boxOf(points);
  const beyond = Math.floor(points.length / 60);
  if (points.length < 3 * FEW) {
    return all;
  }
  for (let axis = 0; axis < 3; axis += 1) {
    const along = points.filter((x, k) => k % 3 === axis && Math.abs(x) <= MAX_COORDINATE).sort();
    const last = along.length - 1;
    if (last > 2 * beyond) {
      [all.low[axis], all.high[axis]] = [along[beyond], along[last - beyond]];
    }
  }
  return all;
}
