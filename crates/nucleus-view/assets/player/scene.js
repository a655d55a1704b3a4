// The scene: the objects of a run in their current state, drawn with WebGL2.

import { cross, multiply, normalise, orthographic, view } from "./camera.js";
import { VertexArray, context, depthTarget, program } from "./gl.js";
import { roundUp } from "./figures.js";
import { boxOfAll } from "./framing.js";
import { Mesh } from "./mesh.js";
import { Particles, VALUE as PARTICLE_VALUE } from "./particles.js";
import { Picks } from "./pick.js";
import { axesOf, foot } from "./plane.js";
import {
  CONTACT_STATE_COLOURS, DEPTH, DOTS, FLOOR, LINES, PARTICLES, PICK_COLOUR, SELECTION_COLOURS, STRAIN, SURFACE, objectColours,
} from "./shading.js";

const BACKGROUND = [0.0075, 0.0085, 0.0105];
const TWIN = [0.09, 0.27, 0.42];
const [TRIANGLES, EDGES] = [0, 1];
const [POSITION, NORMAL, VALUE] = [0, 1, 2];

export class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = context(canvas);
    const make = ({ vertex, fragment }) => program(this.gl, vertex, fragment);
    this.programs = {
      surface: make(SURFACE), lines: make(LINES), particles: make(PARTICLES), floor: make(FLOOR), depth: make(DEPTH),
      dots: make(DOTS),
    };
    this.shadow = depthTarget(this.gl, 2048);
    this.empty = this.gl.createVertexArray();
    this.objects = [];
    this.twins = [];
    this.areTwinsKnown = true; // false at a frame that the other run does not have
    this.selections = [];
    this.picks = new Picks();
    this.pickVertices = new VertexArray(this.gl, [3]);
    // Colour by "object", "strain", "speed", "difference" or "contacts"; a scalar has a value of full saturation.
    this.look = { wireframe: false, surface: false, colour: "object", twin: "over", scales: { strain: 0.05, speed: 1, difference: 0.01 } };
  }

  // Replaces the objects. `twins` are the objects of the other run, if one is compared.
  setObjects(objects, twins = []) {
    this.objects.concat(this.twins).forEach(({ vertices, particles }) => [vertices, particles].forEach((one) => one.delete()));
    const colours = objectColours(objects);
    const drawable = ({ name, topology }, colour) => ({
      name, topology, mesh: new Mesh(topology), colour, isShown: true,
      vertices: new VertexArray(this.gl, [3, 3, 1]), particles: new Particles(this.gl),
    });
    this.objects = objects.map((object, k) => drawable(object, colours[k]));
    this.twins = twins.map((object) => drawable(object, TWIN));
    for (const one of this.objects) {
      one.twin = this.twins.find(({ name }) => name === one.name);
    }
  }

  // Replaces the selections: points of objects that constraints name. They are hidden until they are chosen.
  setSelections(selections) {
    const wasShown = new Set(this.selections.filter(({ isShown }) => isShown).map(({ owner, object }) => `${owner}/${object}`));
    this.selections.forEach(({ vertices }) => vertices.delete());
    const isKnown = ({ object }) => this.objects.some(({ name }) => name === object);
    this.selections = selections.filter(isKnown).map((selection, k) => ({
      ...selection, colour: SELECTION_COLOURS[k % SELECTION_COLOURS.length], vertices: new VertexArray(this.gl, [3]),
      isShown: wasShown.has(`${selection.owner}/${selection.object}`),
    }));
  }

  // Shows the twins over the objects or beside them, or hides them.
  placeTwins(where) {
    this.look.twin = where;
    const width = this.stage.high[0] - this.stage.low[0];
    for (const twin of this.twins) {
      const { points } = twin.mesh;
      twin.mesh.shift = [where === "beside" ? width * 1.15 : 0, 0, 0];
      twin.mesh.points = null; // so that the same points count as changed
      this.setPoints([twin], [points], [twin.looks]);
    }
    this.isShadowStale = true;
  }

  // The visible twins. A twin is hidden with its object, until its positions are known, and where its run has no frame.
  get drawnTwins() {
    const isShown = ({ name }) => this.objects.find((object) => object.name === name)?.isShown ?? true;
    const isKnown = ({ mesh }) => Boolean(mesh.points);
    return this.look.twin === "off" || !this.areTwinsKnown ? [] : this.twins.filter((twin) => isKnown(twin) && isShown(twin));
  }

  // `stage` is the bounding box of the simulated objects over the run; `floor` is the plane of the floor.
  setStage({ low, high }, floor) {
    // Shadows reach the floor below the objects.
    const height = foot(floor, low.map((x, axis) => (x + high[axis]) / 2))[1];
    this.stage = { low: [low[0], Math.min(low[1], height), low[2]], high };
    this.floor = floor;
    this.isShadowStale = true;
  }

  // Moves the floor to a plane; null leaves it.
  moveFloor(plane) {
    this.floor = plane ?? this.floor;
  }

  // Sets the state: the positions of each object, their mesh, and the looks of particles.
  update({ positions, meshes, looks }, twins = null) {
    this.objects.forEach((object, k) => setMesh(object, meshes[k]));
    this.setPoints(this.objects, positions, looks);
    if (twins) {
      this.twins.forEach((twin, k) => setMesh(twin, twins.meshes[k]));
      this.setPoints(this.twins, twins.positions, twins.looks);
    }
  }

  setPoints(objects, positions, looks) {
    objects.forEach((object, k) => {
      const { mesh, vertices } = object;
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
        this.isShadowStale = true;
      }
      if (mesh.kind === "particles") {
        object.looks = looks[k];
        object.particles.set(mesh, looks[k]);
      }
    });
  }

  // Shows or hides an object.
  setShown(object, isShown) {
    object.isShown = isShown;
    this.isShadowStale = true;
  }

  // The box of all visible objects, and of the other run where it is shown beside them; null if none is visible.
  bounds() {
    const shown = this.objects.filter(({ isShown }) => isShown).concat(this.look.twin === "beside" ? this.drawnTwins : []);
    return boxOfAll(shown.map(({ mesh }) => mesh).filter(({ points }) => points));
  }

  get invalidPoints() {
    return this.objects.reduce((sum, { mesh }) => sum + (mesh.invalid ?? 0), 0);
  }

  get aspect() {
    return this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
  }

  draw(camera) {
    const { gl } = this;
    const light = this.light();
    if (this.isShadowStale) {
      this.drawShadow(light);
      this.isShadowStale = false;
    }
    this.fit();
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...BACKGROUND.map(Math.sqrt), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const eye = { ...camera.matrices(this.aspect), eye: camera.eye, ...light };
    this.drawFloor(eye);
    gl.enable(gl.DEPTH_TEST);
    // Transparent particles do not hide what is behind them, so they come last.
    const isTransparent = ({ mesh, particles }) => mesh.kind === "particles" && particles.isTransparent;
    // An object that has just been replaced has no state yet.
    const shown = this.objects.filter(({ isShown, mesh }) => isShown && mesh.points);
    shown.filter((object) => !isTransparent(object)).forEach((object) => this.drawObject(object, eye));
    this.drawnTwins.forEach((twin) => this.look.twin === "over" ? this.drawEdges(twin, eye) : this.drawObject(twin, eye));
    shown.filter(isTransparent).forEach((object) => this.drawObject(object, eye));
    this.selections.filter(({ isShown }) => isShown).forEach((selection) => this.drawDots(selection, eye, 7));
    this.picks.objects.forEach((picked) => (
      this.drawDots({ ...picked, colour: PICK_COLOUR, vertices: this.pickVertices }, eye, 9)
    ));
    gl.bindVertexArray(null);
    gl.finish(); // so that frames do not queue up on slow graphics
  }

  fit() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((side) => Math.round(side * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [Math.max(1, width), Math.max(1, height)];
    }
  }

  // The key light is fixed relative to the stage, so that shadows do not flicker.
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
    // The offset prevents surfaces from shading themselves.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2.5, 8);
    this.use(programs.depth, light);
    for (const { mesh, vertices, isShown } of this.objects.concat(this.look.twin === "beside" ? this.drawnTwins : [])) {
      if (isShown && mesh.points && mesh.kind !== "particles") {
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
    const [across, along] = axesOf(this.floor);
    const plane = { centre: foot(this.floor, eye.centre), across, along, upright: this.floor.normal };
    const look = { reach: eye.reach * 9, spacing: roundUp(eye.reach / 4), background: BACKGROUND };
    this.use(this.programs.floor, { ...eye, ...plane, ...look });
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.BLEND);
  }

  // Whether an object has the quantity that colours; an object without it keeps its own colour.
  hasQuantity({ mesh, topology, speeds, before, twin, contacts }) {
    switch (this.look.colour) {
      case "strain": return mesh.kind === "cloth";
      case "speed": return speeds?.length === mesh.count || before !== undefined;
      case "contacts": return mesh.kind !== "collider" && contacts !== undefined;
      // Points correspond only if both runs have the same number.
      case "difference": return this.areTwinsKnown && Boolean(twin?.mesh.points) && twin.topology.points === topology.points;
      default: return false;
    }
  }

  // Computes the scalar that colours an object, if it is not current, and stores it in a column of vertices. Returns the
  // uniforms of the colours.
  colouring(object, vertices, column) {
    const { mesh, speeds, before, twin, contacts } = object;
    const { colour, scales } = this.look;
    const isColoured = this.hasQuantity(object);
    if (isColoured && mesh.coloured !== colour) {
      mesh.coloured = colour;
      if (colour === "strain") {
        mesh.updateStrain();
      } else if (colour === "speed" && speeds) {
        mesh.values.set(speeds);
      } else if (colour === "speed") {
        mesh.updateDistance(before?.positions, before ? 1 / before.seconds : 0);
      } else if (colour === "contacts") {
        mesh.updateContactStates(contacts);
      } else {
        mesh.updateDistance(twin.mesh.points, 1);
      }
      vertices.set(column, mesh.values);
    } else if (!mesh.hasValues) {
      vertices.set(column, mesh.values); // zeros, because an attribute needs data
    }
    mesh.hasValues = true;
    const isCategorical = isColoured && colour === "contacts";
    return {
      "ramp[0]": (isCategorical ? CONTACT_STATE_COLOURS : STRAIN).flat(),
      fullScale: (isColoured && scales[colour]) || 0,
      isCategorical: isCategorical ? 1 : 0,
    };
  }

  // Draws the edges of the other run over this one.
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

  // Draws points of an object where it is now, as dots of this many pixels.
  drawDots({ object, points, colour, vertices }, eye, size) {
    const { gl } = this;
    const own = this.objects.find(({ name }) => name === object);
    if (!own?.isShown || !own.mesh.points) {
      return;
    }
    const all = own.recorded ?? own.mesh.points; // a surface has other points than its particles
    const known = points.filter((point) => 3 * point + 2 < all.length);
    vertices.set(POSITION, Float32Array.from(known.flatMap((point) => [...all.slice(3 * point, 3 * point + 3)])));
    this.use(this.programs.dots, { ...eye, colour, size: size * Math.min(window.devicePixelRatio || 1, 2) });
    gl.bindVertexArray(vertices.array);
    if (own.mesh.kind === "surface") {
      gl.disable(gl.DEPTH_TEST); // particles lie inside their surface
    }
    gl.drawArrays(gl.POINTS, 0, known.length);
    gl.enable(gl.DEPTH_TEST);
  }

  drawObject(object, eye) {
    const { mesh, vertices, particles, colour } = object;
    const { gl, programs, look } = this;
    if (mesh.kind === "particles") {
      const pixels = this.canvas.height;
      const radius = mesh.radius ?? eye.reach * 0.008;
      const colours = this.colouring(object, particles.vertices, PARTICLE_VALUE);
      this.use(programs.particles, { ...eye, colour, radius, pixels, ...colours });
      particles.draw(eye.view);
      return;
    }
    this.use(programs.surface, { ...eye, colour, ...this.colouring(object, vertices, VALUE) });
    vertices.draw(gl.TRIANGLES, TRIANGLES);
    if (look.wireframe) {
      gl.enable(gl.BLEND);
      this.use(programs.lines, { ...eye, ink: [0, 0, 0, 0.5] });
      vertices.draw(gl.LINES, EDGES);
      gl.disable(gl.BLEND);
    }
  }

  // Makes a program current and sets its uniforms from the values of the same names.
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

// Replaces the mesh of an object if its topology has changed.
function setMesh(object, topology) {
  if (object.topology !== topology) {
    const { shift } = object.mesh;
    Object.assign(object, { topology, mesh: Object.assign(new Mesh(topology), { shift }) });
  }
}
