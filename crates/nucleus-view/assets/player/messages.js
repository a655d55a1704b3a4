// The messages and metadata of a Nucleus cache: meshes, positions, contact states, cameras.

import { Reader } from "./records.js";

export const KINDS = ["cloth", "collider", "particles"];

// A mesh: kind, number of points, faces as `starts` into `corners`, positions at rest, and its number among the meshes of
// the object, from 0.
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

// Positions at one recorded time of a frame, the number of their mesh, and velocities where they are recorded.
export function readPoints(data) {
  const reader = new Reader(data);
  const [frame, substep, substeps, count] = [reader.i32(), reader.u32(), reader.u32(), reader.u32()];
  const flags = reader.u32();
  const number = reader.u32();
  const time = reader.f64();
  const vectors = () => unshuffle(reader.take(12 * count), 3 * count);
  const positions = vectors();
  return { frame, substep, substeps, time, number, positions, velocities: flags & 1 ? vectors() : null };
}

// The contact state of each point at one recorded time, as a byte: see CONTACT_STATES in shading.js.
export function readContacts(data) {
  const reader = new Reader(data);
  reader.take(12); // frame, substep, substeps
  const count = reader.u32();
  reader.take(16); // zero, time
  return reader.take(count).slice();
}

// The looks of particles at one recorded time, as eight numbers per particle: factor on the radius, opacity, red, green and
// blue (red below 0: no colour of its own), and red, green and blue of its light.
export function readLooks(data) {
  const reader = new Reader(data);
  reader.take(12); // frame, substep, substeps
  const count = reader.u32();
  reader.take(16); // zeros, time
  return unshuffle(reader.take(32 * count), 8 * count);
}

// The numbers of particles at one recorded time, by which a particle is known from frame to frame.
export function readParticleNumbers(data) {
  const reader = new Reader(data);
  reader.take(12); // frame, substep, substeps
  const count = reader.u32();
  reader.take(16); // zeros, time
  const words = new Uint32Array(unshuffle(reader.take(20 * count), 5 * count).buffer);
  return Float64Array.from({ length: count }, (_, p) => words[5 * p] + 2 ** 32 * words[5 * p + 1]);
}

// Reverses the byte shuffle: four planes, the lowest byte of every float first.
function unshuffle(planes, count) {
  const bits = new Uint32Array(count);
  const [second, third, fourth] = [count, 2 * count, 3 * count];
  for (let k = 0; k < count; k += 1) {
    bits[k] = planes[k] | (planes[second + k] << 8) | (planes[third + k] << 16) | (planes[fourth + k] << 24);
  }
  return new Float32Array(bits.buffer);
}

// Copies the words, because messages are not aligned to four bytes.
function words(reader, count, Type) {
  return new Type(reader.take(4 * count).slice().buffer);
}

// The cameras, as { name, fit, views }. A view is 13 numbers: see camera.rs of the cache crate.
export function readCameras(keys) {
  const cameras = [...(keys ?? new Map())].filter(([key]) => key.startsWith("camera ")).map(([key, text]) => {
    const [fit, ...lines] = text.split("\n");
    return { name: key.slice("camera ".length), fit, views: lines.map((line) => line.split(" ").map(Number)) };
  });
  return cameras.filter(({ views }) => views.length > 0 && views.every((view) => view.length === 13 && view.every(Number.isFinite)));
}
