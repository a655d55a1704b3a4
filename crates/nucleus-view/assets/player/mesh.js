// A mesh at a moment: positions, normals and strain of its vertices, ready for the graphics card.
// The loops are plain, because they run over every vertex in every frame.

import { apart, edgesOf, fans, smoothGroups, soundFaces } from "./topology.js";

// Numbers beyond this are as lost as those that are not finite.
const FARTHEST = 1e9;

export class Mesh {
  constructor(topology) {
    this.kind = topology.kind;
    this.radius = topology.radius ?? null; // of particles, where it is known
    const faces = soundFaces(topology);
    // A cloth has a vertex for each point; a collider one for each corner, as sharp edges have two normals.
    const isSharp = this.kind === "collider";
    const own = isSharp ? apart(faces) : faces;
    this.vertexPoint = isSharp
      ? Uint32Array.from(faces.flat())
      : Uint32Array.from({ length: topology.points }, (_, point) => point);
    this.groups = isSharp ? smoothGroups(faces, topology.rest) : null;
    this.faces = own;
    this.triangles = fans(own);
    this.edges = edgesOf(own);
    this.count = this.vertexPoint.length;
    this.positions = new Float32Array(3 * this.count);
    this.normals = new Float32Array(3 * this.count);
    this.strain = new Float32Array(this.count);
    this.isLost = new Uint8Array(this.count);
    this.shift = [0, 0, 0]; // added to all positions: where the twin of another run stands
    this.take(topology.rest);
    this.restLengths = Float32Array.from({ length: this.edges.length / 2 }, (_, e) => this.length(e));
    this.shown = null; // the positions last taken
  }

  // Takes the positions of a moment. Says whether they are news.
  update(points) {
    if (points === this.shown) {
      return false;
    }
    this.shown = points;
    this.take(points);
    this.lost = this.isLost.reduce((sum, lost) => sum + lost, 0);
    this.drawnTriangles = this.lost ? this.withoutLost(this.triangles, 3) : this.triangles;
    this.drawnEdges = this.lost ? this.withoutLost(this.edges, 2) : this.edges;
    this.updateNormals();
    this.coloured = null;
    return true;
  }

  // Copies positions to vertices, and the box round them. A lost point becomes the origin: it is not drawn.
  take(points) {
    const { positions, vertexPoint, isLost, shift } = this;
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let v = 0; v < this.count; v += 1) {
      const at = 3 * vertexPoint[v];
      let isFound = true;
      for (let axis = 0; axis < 3; axis += 1) {
        isFound = isFound && Math.abs(points[at + axis]) <= FARTHEST; // false for NaN
      }
      isLost[v] = isFound ? 0 : 1;
      for (let axis = 0; axis < 3; axis += 1) {
        const x = isFound ? points[at + axis] + shift[axis] : 0;
        positions[3 * v + axis] = x;
        low[axis] = isFound && x < low[axis] ? x : low[axis];
        high[axis] = isFound && x > high[axis] ? x : high[axis];
      }
    }
    this.bounds = { low, high };
  }

  // Of each vertex, the strain of largest size among its edges.
  updateStrain() {
    const { strain, edges, restLengths, isLost } = this;
    strain.fill(0);
    for (let e = 0; e < restLengths.length; e += 1) {
      const a = edges[2 * e];
      const b = edges[2 * e + 1];
      if (restLengths[e] > 0 && !isLost[a] && !isLost[b]) {
        const x = this.length(e) / restLengths[e] - 1;
        strain[a] = Math.abs(x) > Math.abs(strain[a]) ? x : strain[a];
        strain[b] = Math.abs(x) > Math.abs(strain[b]) ? x : strain[b];
      }
    }
  }

  // Of each vertex, how far its point is from where it is in `others`, times a factor; 0 without others.
  updateDistance(others, factor) {
    const { strain, vertexPoint, isLost, shown } = this;
    strain.fill(0);
    for (let v = 0; others && v < this.count; v += 1) {
      const at = 3 * vertexPoint[v];
      const [x, y, z] = [shown[at] - others[at], shown[at + 1] - others[at + 1], shown[at + 2] - others[at + 2]];
      strain[v] = isLost[v] ? 0 : Math.sqrt(x * x + y * y + z * z) * factor || 0;
    }
  }

  // Of each vertex, the rung of its point.
  updateRungs(contacts) {
    for (let v = 0; v < this.count; v += 1) {
      this.strain[v] = contacts?.[this.vertexPoint[v]] ?? 0;
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
      this.addSharpNormals();
    } else {
      this.addTriangleNormals(this.drawnTriangles, (k) => this.drawnTriangles[k], this.normals);
    }
    normaliseAll(this.normals);
  }

  // Adds the area vector of each triangle to three places of `sums`: those of its corners by default.
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

  // A corner takes the normals of the faces that are smooth with its own.
  addSharpNormals() {
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

  withoutLost(list, size) {
    const kept = [];
    for (let k = 0; k < list.length; k += size) {
      let isWhole = true;
      for (let j = k; j < k + size; j += 1) {
        isWhole = isWhole && !this.isLost[list[j]];
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
