// The player: one open cache, the scene, the camera and the timeline.

import { Cache } from "./cache.js";
import { Camera } from "./camera.js";
import { byId, countPoints, showFigures, showLegend, showContactStates, showTime, showNotice, showObjects, showState } from "./panel.js";
import { Scene, unionOf } from "./scene.js";
import { Curve, Timeline } from "./timeline.js";

const COLOURINGS = ["strain", "speed", "contacts", "difference"];
const DEFAULT_STAGE = { low: [-1, -1, -1], high: [1, 1, 1] };

export class Player {
  constructor(canvas) {
    this.redraw = () => (this.isStale = true);
    this.isStale = true; // whether the picture must be drawn again
    this.scene = new Scene(canvas);
    this.camera = new Camera(canvas, this.redraw);
    this.timeline = null; // of the open cache
    this.everyRefresh();
  }

  // Opens a source; resolves when its first frame is shown, to false if it is not a cache.
  async open(source, other = null) {
    this.timeline?.pause();
    this.timeline = null;
    showNotice("");
    showState("loading", `Opening ${source.name}`);
    const onProgress = (share) => showState("loading", `Scanning ${source.name}`, `${Math.round(share * 100)} %`);
    try {
      const cache = await Cache.open(source, onProgress);
      this.other = other && (await Cache.open(other, onProgress));
      await this.present(cache, source.name);
      showState("ready");
      return true;
    } catch (error) {
      showError(error);
      return false;
    }
  }

  async present(cache, name) {
    const { scene, camera } = this;
    const last = cache.frames.length - 1;
    scene.setObjects(cache.objects, this.other?.objects);
    ["difference", "twin"].forEach((id) => (byId(id).hidden = !this.other));
    byId("contacts").hidden = !cache.objects.some((object) => object.contacts !== undefined);
    await this.findStage(cache, [...new Set([last, last >> 1, 0])]);
    document.title = `${name} – Nucleus`;
    byId("name").textContent = cache.run.scene || name;
    byId("name").title = `${name}, written by Nucleus ${cache.run.version}`;
    byId("frames").max = last;
    showObjects(scene, this.redraw);
    showIncomplete(cache);
    byId("camera").hidden = cache.run.cameras.length === 0;
    camera.track = cache.run.cameras[0] ?? null;
    this.timeline = new Timeline(cache, (index, timeIndex) => this.show(cache, index, timeIndex));
    await this.timeline.go(0);
    this.curve = new Curve(byId("curve"), cache);
    this.curve.fill();
  }

  // Finds the bounding box of the run from a few frames, and frames it.
  async findStage(cache, frames) {
    const { scene, camera } = this;
    const [simulated, all] = [[], []];
    for (const frame of frames) {
      const state = await cache.state(frame).catch(() => null);
      if (state) {
        scene.update(state);
        simulated.push(scene.bounds());
        all.push(...scene.objects.map(({ mesh }) => mesh.bounds));
      }
    }
    const stage = unionOf(simulated.filter(Boolean)) ?? DEFAULT_STAGE;
    // A collider may be a landscape that reaches far below the cloth.
    const extent = Math.max(...stage.high.map((x, axis) => x - stage.low[axis]));
    const floor = cache.run.floor ?? Math.max(unionOf(all)?.low[1] ?? 0, stage.low[1] - extent * 1.5);
    scene.setStage({ low: [stage.low[0], Math.min(stage.low[1], floor), stage.low[2]], high: stage.high }, floor);
    camera.frame(stage, scene.aspect);
  }

  async show(cache, index, timeIndex) {
    const { scene } = this;
    try {
      const state = await cache.state(index, timeIndex);
      const twin = await this.twinOf(cache, state);
      await this.findSpeed(cache, state);
      scene.objects.forEach((object, k) => (object.contacts = state.contacts[k]));
      if (cache !== this.timeline?.cache) {
        return; // another file has been opened in the meantime
      }
      this.timeline.times = state.times;
      this.camera.frames = state.frame - cache.run.start - (state.substep > 0 ? 1 - state.substep / state.substeps : 0);
      scene.update(state, twin);
      this.curve?.mark(index);
      showTime(cache, state);
      countPoints(scene);
      showFigures(state.report, scene.invalidPoints);
      showContactStates(scene, state.contacts);
      this.redraw();
      cache.prefetch(index);
    } catch (error) {
      showNotice(`Frame ${cache.frameNumber(index)}: ${error.message} ${error.hint ?? ""}`);
    }
  }

  // The state of the other run at the same time, if there is one.
  async twinOf(cache, { frame, substep, substeps }) {
    if (!this.other) {
      return undefined;
    }
    const index = this.other.indexOf(frame);
    const { times } = await this.other.state(index);
    // The same fraction of the frame, because the runs may have recorded different numbers of substeps.
    const timeIndex = substep === 0 ? 0 : Math.max(0, Math.round((substep / substeps) * times) - 1);
    return this.other.state(index, timeIndex);
  }

  // The positions of the frame before, for the speed.
  async findSpeed(cache, state) {
    const before = this.scene.look.colour === "speed" && state.index > 0 ? await cache.state(state.index - 1) : null;
    this.scene.objects.forEach((object, k) => {
      const isSame = before?.meshes[k].number === state.meshes[k].number;
      const seconds = isSame && state.time - before.time;
      object.before = seconds > 0 ? { positions: before.positions[k], seconds } : null;
      object.mesh.coloured = null;
    });
  }

  toggleWireframe() {
    const { look } = this.scene;
    look.wireframe = !look.wireframe;
    byId("wireframe").setAttribute("aria-pressed", look.wireframe);
    this.redraw();
  }

  // Colours the objects by a quantity; a second call returns to a colour per object.
  colourBy(quantity) {
    const { look } = this.scene;
    if (byId(quantity).hidden) {
      return; // the cache does not hold it
    }
    look.colour = look.colour === quantity ? "object" : quantity;
    COLOURINGS.forEach((id) => byId(id).setAttribute("aria-pressed", look.colour === id));
    showLegend(look);
    this.timeline.go(this.timeline.index, this.timeline.timeIndex); // speeds are computed only when shown
    this.redraw();
  }

  // Sets the value of full saturation.
  setFullScale(quantity, value) {
    if (value > 0 && quantity in this.scene.look.scales) {
      this.scene.look.scales[quantity] = Math.min(1e6, Math.max(1e-7, value));
    }
    showLegend(this.scene.look);
    this.redraw();
  }

  scaleColours(factor) {
    const { colour, scales } = this.scene.look;
    if (colour in scales) {
      this.setFullScale(colour, scales[colour] * factor);
    }
  }

  placeTwin(where) {
    this.scene.placeTwins(where);
    byId("twin").textContent = where;
    if (where === "beside") {
      this.frameAll(); // else the other run lies outside the picture
    }
    this.redraw();
  }

  nextTwin() {
    if (this.other) {
      const places = ["over", "beside", "off"];
      this.placeTwin(places[(places.indexOf(this.scene.look.twin) + 1) % places.length]);
    }
  }

  // Cycles through the cameras of the scene and the free camera.
  nextCamera() {
    const cameras = this.timeline.cache.run.cameras;
    this.camera.track = cameras[cameras.indexOf(this.camera.track) + 1] ?? null;
    this.redraw();
  }

  lookThrough(name) {
    this.camera.track = this.timeline.cache.run.cameras.find((camera) => camera.name === name) ?? null;
    this.redraw();
  }

  toggleLoop() {
    this.timeline.isLooping = !this.timeline.isLooping;
    byId("loop").setAttribute("aria-pressed", this.timeline.isLooping);
  }

  frameAll() {
    const bounds = this.scene.bounds();
    if (bounds) {
      this.camera.frame(bounds, this.scene.aspect);
    }
  }

  everyRefresh() {
    // Requested first, so that an error while drawing does not end the loop.
    requestAnimationFrame(() => this.everyRefresh());
    this.timeline?.tick();
    byId("play").setAttribute("aria-pressed", this.timeline?.isPlaying ?? false);
    if (this.isStale && this.timeline) {
      this.isStale = false;
      byId("camera").textContent = this.camera.track?.name ?? "free";
      this.scene.draw(this.camera);
    }
  }
}

function showIncomplete(cache) {
  const [first, last] = [0, cache.frames.length - 1].map((index) => cache.frameNumber(index));
  if (cache.complete) {
    return;
  }
  showNotice(last === cache.run.end
    ? "The file was never closed, or its index is damaged; its frames can be shown."
    : `The run is incomplete: frames ${first} to ${last} are shown.`);
}

export function showError(error) {
  console.error(error);
  const { message, hint } = error.hint === undefined
    ? { message: "The file cannot be shown.", hint: `It may be damaged (${error.message}).` }
    : error;
  showState("error", message, hint);
}
