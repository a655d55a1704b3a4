// Particles: discs shaded as balls, each with the radius, the opacity and the colours that the run recorded for it, or
// coloured by a quantity.

import { VertexArray } from "./gl.js";

const [POSITION, SIZE, COLOUR, GLOW] = [0, 1, 2, 3];
// The column of the quantity that colours.
export const VALUE = 4;
// Numbers of a look: see `readLooks`.
export const NUMBERS = 8;

export class Particles {
  constructor(gl) {
    this.gl = gl;
    this.vertices = new VertexArray(gl, [3, 2, 3, 3, 1]);
    this.count = 0;
  }

  // Takes the state of a mesh of particles. Without looks all have the radius and the colour of their object.
  set(mesh, looks) {
    const { count, positions, isInvalid } = mesh;
    const own = looks?.length === NUMBERS * count ? looks : null;
    const [size, colour, glow] = [2, 3, 3].map((numbers) => new Float32Array(numbers * count));
    this.isTransparent = false;
    for (let k = 0; k < count; k += 1) {
      const at = NUMBERS * k;
      size[2 * k] = isInvalid[k] ? 0 : own ? own[at] : 1; // without a size it is not drawn
      size[2 * k + 1] = own ? own[at + 1] : 1;
      this.isTransparent ||= size[2 * k + 1] < 1;
      for (let channel = 0; channel < 3; channel += 1) {
        colour[3 * k + channel] = own ? own[at + 2 + channel] : -1;
        glow[3 * k + channel] = own ? own[at + 5 + channel] : 0;
      }
    }
    Object.assign(this, { count, positions });
    mesh.hasValues = false; // there may be fewer than particles
    [positions, size, colour, glow].forEach((values, column) => this.vertices.set([POSITION, SIZE, COLOUR, GLOW][column], values));
  }

  // Draws the particles with the current program; transparent ones are blended from the farthest to the nearest.
  draw(view) {
    const { gl, vertices, count } = this;
    if (!this.isTransparent) {
      gl.bindVertexArray(vertices.array);
      gl.drawArrays(gl.POINTS, 0, count);
      return;
    }
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    vertices.setIndices([this.order(view)]);
    vertices.draw(gl.POINTS, 0);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  // The particles from the farthest to the nearest; the view looks along -z.
  order(view) {
    const { count, positions } = this;
    const depths = Float32Array.from({ length: count }, (_, k) => (
      view[2] * positions[3 * k] + view[6] * positions[3 * k + 1] + view[10] * positions[3 * k + 2]
    ));
    return Uint32Array.from({ length: count }, (_, k) => k).sort((a, b) => depths[a] - depths[b]);
  }

  delete() {
    this.vertices.delete();
  }
}
