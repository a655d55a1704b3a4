// A mesh at one time: topology, positions, normals and scalar values of its vertices, in buffers for the graphics card.
// The loops are plain, because they run over every vertex in every frame.

// Cosine of 50 degrees: faces of a collider whose normals differ by more meet in a hard edge.
const COS_HARD_EDGE = 0.643;

// The faces as lists of points, without faces of fewer than three points or with points that do not exist.
export function validFaces({ starts, corners, points }) {
  const faces = [];
  for (let f = 0; f + 1 < starts.length; f += 1) {
    const face = Array.from(corners.subarray(starts[f], starts[f + 1]));
    if (face.length >= 3 && face.every((point) => point < points)) {
      faces.push(face);
    }
  }
  return faces;
}

// The same faces with a separate vertex for each corner.
export function separateCorners(faces) {
  let next = 0;
  return faces.map((face) => face.map(() => next++));
}

// Three vertices per triangle: a fan for each face.
export function triangulate(faces) {
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

// Two vertices per edge, each edge once.
export function edgesOf(faces) {
  const known = new Set();
  const edges = [];
  for (const face of faces) {
    for (let k = 0; k < face.length; k += 1) {
      const [a, b] = [face[k], face[(k + 1) % face.length]];
      const key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
      if (!known.has(key)) {
        known.add(key);
        edges.push(a, b);
      }
    }
  }
  return Uint32Array.from(edges);
}

// For each corner, the faces of its point that meet its own face smoothly: `starts` into `faces`. They depend on the
// shape at rest, so that they do not flicker.
export function smoothGroups(faces, rest) {
  const normals = faces.map((face) => unit(newell(face, rest)));
  const around = new Map();
  faces.forEach((face, f) => face.forEach((point) => {
    around.has(point) ? around.get(point).push(f) : around.set(point, [f]);
  }));
  const groups = [];
  const starts = [0];
  faces.forEach((face, f) => face.forEach((point) => {
    groups.push(...around.get(point).filter((other) => other === f || isSmooth(normals[f], normals[other])));
    starts.push(groups.length);
  }));
  return { starts: Uint32Array.from(starts), faces: Uint32Array.from(groups) };
}

const isSmooth = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2] >= COS_HARD_EDGE;

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

// Larger coordinates are treated like those that are not finite.
export const MAX_COORDINATE = 1e9;

export class Mesh {
  constructor(topology) {
    this.kind = topology.kind;
    this.radius = topology.radius ?? null; // of particles, where it is known
    const faces = validFaces(topology);
    // A cloth has a vertex per point; a collider has one per corner, because a hard edge has two normals.
    const hasHardEdges = this.kind === "collider";
    const split = hasHardEdges ? separateCorners(faces) : faces;
    this.vertexPoint = hasHardEdges
      ? Uint32Array.from(faces.flat())
      : Uint32Array.from({ length: topology.points }, (_, point) => point);
    this.groups = hasHardEdges ? smoothGroups(faces, topology.rest) : null;
    this.faces = split;
    this.triangles = triangulate(split);
    this.edges = edgesOf(split);
    this.count = this.vertexPoint.length;
    this.positions = new Float32Array(3 * this.count);
    this.normals = new Float32Array(3 * this.count);
    this.values = new Float32Array(this.count); // strain, distance or contact state
    this.isInvalid = new Uint8Array(this.count);
    this.shift = [0, 0, 0]; // added to all positions, to show the other run beside this one
    this.setPositions(topology.rest);
    this.restLengths = Float32Array.from({ length: this.edges.length / 2 }, (_, e) => this.length(e));
    this.points = null; // the current positions, as recorded
  }

  // Sets the positions. Returns whether they have changed.
  update(points) {
    if (points === this.points) {
      return false;
    }
    this.points = points;
    this.setPositions(points);
    this.invalid = this.isInvalid.reduce((sum, invalid) => sum + invalid, 0);
    this.drawnTriangles = this.invalid ? this.withoutInvalid(this.triangles, 3) : this.triangles;
    this.drawnEdges = this.invalid ? this.withoutInvalid(this.edges, 2) : this.edges;
    this.updateNormals();
    this.coloured = null;
    return true;
  }

  // Copies positions to vertices. An invalid point becomes the origin and is not drawn.
  setPositions(points) {
    const { positions, vertexPoint, isInvalid, shift } = this;
    for (let v = 0; v < this.count; v += 1) {
      const at = 3 * vertexPoint[v];
      let isValid = true;
      for (let axis = 0; axis < 3; axis += 1) {
        isValid = isValid && Math.abs(points[at + axis]) <= MAX_COORDINATE; // false for NaN
      }
      isInvalid[v] = isValid ? 0 : 1;
      for (let axis = 0; axis < 3; axis += 1) {
        positions[3 * v + axis] = isValid ? points[at + axis] + shift[axis] : 0;
      }
    }
  }

  // Per vertex, the strain of largest magnitude among its edges.
  updateStrain() {
    const { values, edges, restLengths, isInvalid } = this;
    values.fill(0);
    for (let e = 0; e < restLengths.length; e += 1) {
      const a = edges[2 * e];
      const b = edges[2 * e + 1];
      if (restLengths[e] > 0 && !isInvalid[a] && !isInvalid[b]) {
        const x = this.length(e) / restLengths[e] - 1;
        values[a] = Math.abs(x) > Math.abs(values[a]) ? x : values[a];
        values[b] = Math.abs(x) > Math.abs(values[b]) ? x : values[b];
      }
    }
  }

  // Per vertex, the distance of its point from the same point in `others`, times a factor; 0 without others.
  updateDistance(others, factor) {
    const { values, vertexPoint, isInvalid, points } = this;
    values.fill(0);
    for (let v = 0; others && v < this.count; v += 1) {
      const at = 3 * vertexPoint[v];
      const [x, y, z] = [points[at] - others[at], points[at + 1] - others[at + 1], points[at + 2] - others[at + 2]];
      values[v] = isInvalid[v] ? 0 : Math.sqrt(x * x + y * y + z * z) * factor || 0;
    }
  }

  // Per vertex, the contact state of its point.
  updateContactStates(contacts) {
    for (let v = 0; v < this.count; v += 1) {
      this.values[v] = contacts?.[this.vertexPoint[v]] ?? 0;
    }
  }

  length(e) {
    const a = 3 * this.edges[2 * e];
    const b = 3 * this.edges[2 * e + 1];
    const p = this.positions;
    return Math.sqrt((p[a] - p[b]) ** 2 + (p[a + 1] - p[b + 1]) ** 2 + (p[a + 2] - p[b + 2]) ** 2);
  }

  updateNormals() {
    this.normals.fill(0);
    if (this.groups) {
      this.addHardEdgeNormals();
    } else {
      this.addTriangleNormals(this.drawnTriangles, (k) => this.drawnTriangles[k], this.normals);
    }
    normaliseAll(this.normals);
  }

  // Adds the area vector of each triangle to three entries of `sums`; `place` gives the entry of a corner.
  addTriangleNormals(triangles, place, sums) {
    const p = this.positions;
    for (let k = 0; k < triangles.length; k += 3) {
      const a = 3 * triangles[k];
      const b = 3 * triangles[k + 1];
      const c = 3 * triangles[k + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (let corner = 0; corner < 3; corner += 1) {
        const at = 3 * place(k + corner);
        sums[at] += x;
        sums[at + 1] += y;
        sums[at + 2] += z;
      }
    }
  }

  // The normal of a corner is the sum over the faces that meet its own face smoothly.
  addHardEdgeNormals() {
    const { starts, faces } = this.groups;
    const areas = new Float32Array(3 * this.faces.length);
    this.faceOfTriangle ??= Uint32Array.from(this.faces.flatMap((face, f) => Array(face.length - 2).fill(f)));
    this.addTriangleNormals(this.triangles, (k) => this.faceOfTriangle[Math.floor(k / 3)], areas);
    for (let v = 0; v < this.count; v += 1) {
      for (let k = starts[v]; k < starts[v + 1]; k += 1) {
        for (let axis = 0; axis < 3; axis += 1) {
          this.normals[3 * v + axis] += areas[3 * faces[k] + axis];
        }
      }
    }
  }

  withoutInvalid(list, size) {
    const kept = [];
    for (let k = 0; k < list.length; k += size) {
      let isWhole = true;
      for (let j = k; j < k + size; j += 1) {
        isWhole = isWhole && !this.isInvalid[list[j]];
      }
      for (let j = k; isWhole && j < k + size; j += 1) {
        kept.push(list[j]);
      }
    }
    return Uint32Array.from(kept);
  }
}

function normaliseAll(vectors) {
  for (let k = 0; k < vectors.length; k += 3) {
    const length = Math.sqrt(vectors[k] ** 2 + vectors[k + 1] ** 2 + vectors[k + 2] ** 2);
    vectors[k] = length > 0 ? vectors[k] / length : 0;
    vectors[k + 1] = length > 0 ? vectors[k + 1] / length : 1;
    vectors[k + 2] = length > 0 ? vectors[k + 2] / length : 0;
  }
}
