// The two messages of an object: its mesh, once and whenever it changes, and its positions, every frame.

import { Reader } from "./bytes.js";

export const KINDS = ["cloth", "collider", "particles"];

// A mesh: kind, number of points, faces as `starts` into `corners`, positions at rest, and how many other meshes the object
// had before.
export function readTopology(data) {
  const reader = new Reader(data);
  const [kind, points, faces, corners] = [reader.u32(), reader.u32(), reader.u32(), reader.u32()];
  return {
    kind: KINDS[kind] ?? "collider",
    points,
    starts: words(reader, faces + 1, Uint32Array),
    corners: words(reader, corners, Uint32Array),
    rest: words(reader, 3 * points, Float32Array),
    number: reader.left >= 4 ? reader.u32() : 0,
  };
}

// Positions at one moment of a frame, and how many meshes the object had before that which they are of.
export function readPoints(data) {
  const reader = new Reader(data);
  const [frame, substep, substeps, count] = [reader.i32(), reader.u32(), reader.u32(), reader.u32()];
  reader.u32(); // flags
  const number = reader.u32();
  const time = reader.f64();
  return { frame, substep, substeps, time, number, positions: unshuffle(reader.take(12 * count), 3 * count) };
}

// How contact stands at each point at one moment of a frame, a byte each: see RUNGS in colours.js.
export function readContacts(data) {
  const reader = new Reader(data);
  reader.take(12); // frame, substep, substeps
  const count = reader.u32();
  reader.take(16); // zero, time
  return reader.take(count).slice();
}

// Four planes of bytes, lowest byte of every float first, back to floats.
function unshuffle(planes, count) {
  const bits = new Uint32Array(count);
  const [second, third, fourth] = [count, 2 * count, 3 * count];
  for (let k = 0; k < count; k += 1) {
    bits[k] = planes[k] | (planes[second + k] << 8) | (planes[third + k] << 16) | (planes[fourth + k] << 24);
  }
  return new Float32Array(bits.buffer);
}

// Messages do not begin at multiples of four, so the words are copied out.
function words(reader, count, Type) {
  return new Type(reader.take(4 * count).slice().buffer);
}
