// Draws the objects of a run in the state they were last given.

import { RUNG_COLOURS, STRAIN, objectColours } from "./colours.js";
import { VertexArray, context, depthTarget, program } from "./gl.js";
import { Mesh } from "./mesh.js";
import { cross, multiply, normalise, orthographic, scale, view } from "./matrix.js";
import { DEPTH, FLOOR, LINES, PARTICLES, SURFACE } from "./shaders.js";

const BACKGROUND = [0.0075, 0.0085, 0.0105];
const TWIN = [0.09, 0.27, 0.42];
const [TRIANGLES, EDGES] = [0, 1];
const [POSITION, NORMAL, STRAINED] = [0, 1, 2];

export class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = context(canvas);
    const make = ({ vertex, fragment }) => program(this.gl, vertex, fragment);
    this.programs = {
      surface: make(SURFACE), lines: make(LINES), particles: make(PARTICLES), floor: make(FLOOR), depth: make(DEPTH),
    };
    this.shadow = depthTarget(this.gl, 2048);
    this.empty = this.gl.createVertexArray();
    this.things = [];
    this.twins = [];
    // What colours tell: "object", "strain", "speed", "difference" or "contacts"; all that is measured has a full scale.
    this.look = { wireframe: false, colour: "object", twin: "over", scales: { strain: 0.05, speed: 1, difference: 0.01 } };
  }

  // Replaces the objects; `twins` are those of a run that is compared with, or none.
  setObjects(objects, twins = []) {
    this.things.concat(this.twins).forEach(({ vertices }) => vertices.delete());
    const colours = objectColours(objects);
    const thing = ({ name, topology }, colour) => ({
      name, topology, mesh: new Mesh(topology), colour, isShown: true,
      vertices: new VertexArray(this.gl, [3, 3, 1]),
    });
    this.things = objects.map((object, k) => thing(object, colours[k]));
    this.twins = twins.map((object) => thing(object, TWIN));
    for (const one of this.things) {
      one.twin = this.twins.find(({ name }) => name === one.name);
    }
  }

  // Puts the twins over the objects, beside them or out of sight.
  placeTwins(where) {
    this.look.twin = where;
    const width = this.stage.high[0] - this.stage.low[0];
    for (const twin of this.twins) {
      const points = twin.mesh.shown;
      twin.mesh.shift = [where === "beside" ? width * 1.15 : 0, 0, 0];
      twin.mesh.shown = null; // so that the same points are news
      this.takePoints([twin], [points]);
    }
    this.hasOldShadow = true;
  }

  // Those of the other run that are to be seen, once it is known where they are; an object that is hidden hides its twin.
  get drawnTwins() {
    const isShown = ({ name }) => this.things.find((thing) => thing.name === name)?.isShown ?? true;
    const isKnown = ({ mesh }) => Boolean(mesh.shown);
    return this.look.twin === "off" ? [] : this.twins.filter((twin) => isKnown(twin) && isShown(twin));
  }

  // `stage` is the box of all that moves, over the run; the floor lies under it.
  setStage(stage, floor) {
    this.stage = stage;
    this.floor = floor;
    this.hasOldShadow = true;
  }

  // Takes a moment: of each object the positions, and the mesh that they are of.
  update({ positions, meshes }, twins = null) {
    this.things.forEach((thing, k) => takeMesh(thing, meshes[k]));
    this.takePoints(this.things, positions);
    if (twins) {
      this.twins.forEach((twin, k) => takeMesh(twin, twins.meshes[k]));
      this.takePoints(this.twins, twins.positions);
    }
  }

  takePoints(things, positions) {
    things.forEach(({ mesh, vertices }, k) => {
      if (!positions[k]) {
        return;
      }
      const before = mesh.drawnTriangles;
      if (mesh.update(positions[k])) {
        vertices.set(POSITION, mesh.positions);
        vertices.set(NORMAL, mesh.normals);
        if (mesh.drawnTriangles !== before) {
          vertices.setIndices([mesh.drawnTriangles, mesh.drawnEdges]);
        }
        this.hasOldShadow = true;
      }
    });
  }

  // Shows or hides an object.
  setShown(thing, isShown) {
    thing.isShown = isShown;
    this.hasOldShadow = true;
  }

  // The box round all shown objects that move, or round all shown ones; null if nothing is shown.
  bounds() {
    const shown = this.things.filter(({ isShown }) => isShown).concat(this.look.twin === "beside" ? this.twins : []);
    const moving = shown.filter(({ mesh }) => mesh.kind !== "collider");
    return boxOf((moving.length > 0 ? moving : shown).map(({ mesh }) => mesh.bounds));
  }

  get lostPoints() {
    return this.things.reduce((sum, { mesh }) => sum + (mesh.lost ?? 0), 0);
  }

  get aspect() {
    return this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
  }

  draw(camera) {
    const { gl } = this;
    const light = this.light();
    if (this.hasOldShadow) {
      this.drawShadow(light);
      this.hasOldShadow = false;
    }
    this.fit();
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...BACKGROUND.map(Math.sqrt), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const eye = { ...camera.matrices(this.aspect), eye: camera.eye, ...light };
    this.drawFloor(eye);
    gl.enable(gl.DEPTH_TEST);
    this.things.filter(({ isShown }) => isShown).forEach((thing) => this.drawThing(thing, eye));
    this.drawnTwins.forEach((twin) => this.look.twin === "over" ? this.drawEdges(twin, eye) : this.drawThing(twin, eye));
    gl.bindVertexArray(null);
    gl.finish(); // so that pictures never queue up behind the page, however slow the graphics are
  }

  fit() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((side) => Math.round(side * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [Math.max(1, width), Math.max(1, height)];
    }
  }

  // The key light stands still over the stage, so that shadows do not swim.
  light() {
    const { low, high } = this.stage;
    const centre = low.map((x, axis) => (x + high[axis]) / 2);
    const reach = Math.max(1e-6, Math.hypot(...low.map((x, axis) => high[axis] - x)) * 0.8);
    const toKey = normalise([-0.35, 1, 0.65]);
    const right = normalise(cross([0, 1, 0], toKey));
    const matrix = multiply(orthographic(reach), view(centre, right, cross(toKey, right), toKey));
    return { light: matrix, toKey, cell: (2 * reach) / this.shadow.side, centre, reach };
  }

  drawShadow(light) {
    const { gl, programs, shadow } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, shadow.frame);
    gl.viewport(0, 0, shadow.side, shadow.side);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    // Surfaces are pushed away from the light, or their own cells would stripe them.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2.5, 8);
    this.use(programs.depth, light);
    for (const { mesh, vertices, isShown } of this.things.concat(this.look.twin === "beside" ? this.drawnTwins : [])) {
      if (isShown && mesh.kind !== "particles") {
        vertices.draw(gl.TRIANGLES, TRIANGLES);
      }
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, shadow.texture);
  }

  drawFloor(eye) {
    const { gl } = this;
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    const centre = [eye.centre[0], this.floor, eye.centre[2]];
    const floor = { centre, reach: eye.reach * 9, spacing: roundLength(eye.reach / 4), background: BACKGROUND };
    this.use(this.programs.floor, { ...eye, ...floor });
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.BLEND);
  }

  // Finds what the colours of a mesh tell, if that is not known yet.
  colourMesh({ mesh, vertices, topology, before, twin, contacts }, isColoured) {
    const { colour } = this.look;
    if (isColoured && mesh.coloured !== colour) {
      mesh.coloured = colour;
      if (colour === "strain") {
        mesh.updateStrain();
      } else if (colour === "speed") {
        mesh.updateDistance(before?.positions, before ? 1 / before.seconds : 0);
      } else if (colour === "contacts") {
        mesh.updateRungs(contacts);
      } else {
        // Points can be told apart only where both runs have as many.
        mesh.updateDistance(twin?.topology.points === topology.points ? twin.mesh.shown : null, 1);
      }
      vertices.set(STRAINED, mesh.strain);
    } else if (!mesh.hasStrain) {
      vertices.set(STRAINED, mesh.strain); // zeros: an attribute without data cannot be drawn
    }
    mesh.hasStrain = true;
  }

  // The other run as a net over this one.
  drawEdges({ mesh, vertices }, eye) {
    if (mesh.kind === "particles") {
      return;
    }
    const { gl } = this;
    gl.enable(gl.BLEND);
    this.use(this.programs.lines, { ...eye, ink: [0.35, 0.75, 1, 0.8] });
    vertices.draw(gl.LINES, EDGES);
    gl.disable(gl.BLEND);
  }

  drawThing(thing, eye) {
    const { mesh, vertices, colour } = thing;
    const { gl, programs, look } = this;
    if (mesh.kind === "particles") {
      const pixels = this.canvas.height;
      const radius = mesh.radius ?? eye.reach * 0.008;
      this.use(programs.particles, { ...eye, colour, radius, pixels });
      gl.bindVertexArray(vertices.array);
      gl.drawArrays(gl.POINTS, 0, mesh.count);
      return;
    }
    const isOfCloth = ["strain", "contacts"].includes(look.colour);
    const isColoured = look.colour !== "object" && (!isOfCloth || mesh.kind === "cloth");
    this.colourMesh(thing, isColoured);
    const tellsKinds = isColoured && look.colour === "contacts";
    const ramp = (tellsKinds ? RUNG_COLOURS : STRAIN).flat();
    const fullScale = (isColoured && look.scales[look.colour]) || 0;
    this.use(programs.surface, { ...eye, colour, "ramp[0]": ramp, fullScale, kinds: tellsKinds ? 1 : 0 });
    vertices.draw(gl.TRIANGLES, TRIANGLES);
    if (look.wireframe) {
      gl.enable(gl.BLEND);
      this.use(programs.lines, { ...eye, ink: [0, 0, 0, 0.5] });
      vertices.draw(gl.LINES, EDGES);
      gl.disable(gl.BLEND);
    }
  }

  // Makes a program current and gives it those of the values that it asks for.
  use({ made, uniforms }, values) {
    const { gl } = this;
    gl.useProgram(made);
    for (const [name, place] of Object.entries(uniforms)) {
      const value = values[name];
      if (typeof value === "number") {
        gl.uniform1f(place, value);
      } else if (value?.length === 16) {
        gl.uniformMatrix4fv(place, false, value);
      } else if (value?.length === 4) {
        gl.uniform4fv(place, value);
      } else if (value) {
        gl.uniform3fv(place, value);
      }
    }
  }
}

// Gives an object another mesh, if it has one now.
function takeMesh(thing, topology) {
  if (thing.topology !== topology) {
    const { shift } = thing.mesh;
    Object.assign(thing, { topology, mesh: Object.assign(new Mesh(topology), { shift }) });
  }
}

// The box round boxes; null round none. Empty boxes are infinite the wrong way round and add nothing.
export function boxOf(boxes) {
  const low = [0, 1, 2].map((axis) => Math.min(...boxes.map((box) => box.low[axis])));
  const high = [0, 1, 2].map((axis) => Math.max(...boxes.map((box) => box.high[axis])));
  return low.every((x, axis) => x <= high[axis]) ? { low, high } : null;
}

// The nearest of 1, 2, 5, 10 ... that is not below a length.
function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= length * 0.999) ?? length;
}
