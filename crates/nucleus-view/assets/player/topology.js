// What a mesh keeps for good: its triangles, its edges, and which faces shape which normal.

// Faces of a collider that meet at a wider angle than 50 degrees keep a sharp edge.
const COS_SHARPEST = 0.643;

// The faces as lists of points, without those that name points that do not exist.
export function soundFaces({ starts, corners, points }) {
  const faces = [];
  for (let f = 0; f + 1 < starts.length; f += 1) {
    const face = Array.from(corners.subarray(starts[f], starts[f + 1]));
    if (face.length >= 3 && face.every((point) => point < points)) {
      faces.push(face);
    }
  }
  return faces;
}

// The same faces with a number of its own for each corner.
export function apart(faces) {
  let next = 0;
  return faces.map((face) => face.map(() => next++));
}

// Three vertices for each triangle: a fan round each face.
export function fans(faces) {
  const triangles = new Uint32Array(3 * faces.reduce((sum, face) => sum + face.length - 2, 0));
  let at = 0;
  for (const face of faces) {
    for (let k = 2; k < face.length; k += 1) {
      triangles.set([face[0], face[k - 1], face[k]], at);
      at += 3;
    }
  }
  return triangles;
}

// Two vertices for each edge, each edge once.
export function edgesOf(faces) {
  const seen = new Set();
  const edges = [];
  for (const face of faces) {
    for (let k = 0; k < face.length; k += 1) {
      const [a, b] = [face[k], face[(k + 1) % face.length]];
      const key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
      if (!seen.has(key)) {
        seen.add(key);
        edges.push(a, b);
      }
    }
  }
  return Uint32Array.from(edges);
}

// For each corner, the faces round its point that are nearly level with its own: `starts` into `faces`.
// Told from the shape at rest, so that it does not flicker.
export function smoothGroups(faces, rest) {
  const normals = faces.map((face) => unit(newell(face, rest)));
  const around = new Map();
  faces.forEach((face, f) => face.forEach((point) => {
    around.has(point) ? around.get(point).push(f) : around.set(point, [f]);
  }));
  const groups = [];
  const starts = [0];
  faces.forEach((face, f) => face.forEach((point) => {
    groups.push(...around.get(point).filter((other) => other === f || isLevel(normals[f], normals[other])));
    starts.push(groups.length);
  }));
  return { starts: Uint32Array.from(starts), faces: Uint32Array.from(groups) };
}

const isLevel = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2] >= COS_SHARPEST;

function newell(face, points) {
  const sum = [0, 0, 0];
  face.forEach((a, k) => {
    const b = face[(k + 1) % face.length];
    for (let axis = 0; axis < 3; axis += 1) {
      const [p, q] = [(axis + 1) % 3, (axis + 2) % 3];
      sum[axis] += points[3 * a + p] * points[3 * b + q] - points[3 * a + q] * points[3 * b + p];
    }
  });
  return sum;
}

function unit(vector) {
  const length = Math.hypot(...vector) || 1;
  return vector.map((x) => x / length);
}
