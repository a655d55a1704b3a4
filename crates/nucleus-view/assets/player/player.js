// One open cache at a time: what is shown of it, and how.

import { Cache } from "./cache.js";
import { Camera } from "./camera.js";
import { Curve } from "./curve.js";
import { byId, countPoints, showFigures, showLegend, showRungs, showMoment, showNotice, showObjects, showState } from "./panel.js";
import { Scene, boxOf } from "./scene.js";
import { Timeline } from "./timeline.js";

const COLOURINGS = ["strain", "speed", "contacts", "difference"];
const NOWHERE = { low: [-1, -1, -1], high: [1, 1, 1] };

export class Player {
  constructor(canvas) {
    this.redraw = () => (this.isStale = true);
    this.isStale = true; // whether the picture has to be drawn anew
    this.scene = new Scene(canvas);
    this.camera = new Camera(canvas, this.redraw);
    this.timeline = null; // of the open cache
    this.everyRefresh();
  }

  // Opens a source; resolves when its first picture is there. False if it is no cache.
  async open(source, other = null) {
    this.timeline?.pause();
    this.timeline = null;
    showNotice("");
    showState("loading", `Opening ${source.name}`);
    const tell = (share) => showState("loading", `Searching ${source.name}`, `${Math.round(share * 100)} %`);
    try {
      const cache = await Cache.open(source, tell);
      this.other = other && (await Cache.open(other, tell));
      await this.present(cache, source.name);
      showState("ready");
      return true;
    } catch (error) {
      complain(error);
      return false;
    }
  }

  async present(cache, name) {
    const { scene, camera } = this;
    const last = cache.frames.length - 1;
    scene.setObjects(cache.objects, this.other?.objects);
    ["difference", "twin"].forEach((id) => (byId(id).hidden = !this.other));
    byId("contacts").hidden = !cache.objects.some((object) => object.contacts !== undefined);
    await this.survey(cache, [...new Set([last, last >> 1, 0])]);
    document.title = `${name} – Nucleus`;
    byId("name").textContent = cache.run.scene || name;
    byId("name").title = `${name}, written by Nucleus ${cache.run.version}`;
    byId("frames").max = last;
    showObjects(scene, this.redraw);
    showLoss(cache);
    byId("camera").hidden = cache.run.cameras.length === 0;
    camera.track = cache.run.cameras[0] ?? null;
    this.timeline = new Timeline(cache, (index, moment) => this.show(cache, index, moment));
    await this.timeline.go(0);
    this.curve = new Curve(byId("curve"), cache);
    this.curve.fill();
  }

  // Looks at a few frames to find the room that the run takes up.
  async survey(cache, frames) {
    const { scene, camera } = this;
    const [moving, all] = [[], []];
    for (const frame of frames) {
      const state = await cache.state(frame).catch(() => null);
      if (state) {
        scene.update(state);
        moving.push(scene.bounds());
        all.push(...scene.things.map(({ mesh }) => mesh.bounds));
      }
    }
    const stage = boxOf(moving.filter(Boolean)) ?? NOWHERE;
    // A collider may be a landscape, which reaches far below what one looks at.
    const extent = Math.max(...stage.high.map((x, axis) => x - stage.low[axis]));
    const floor = cache.run.floor ?? Math.max(boxOf(all)?.low[1] ?? 0, stage.low[1] - extent * 1.5);
    scene.setStage({ low: [stage.low[0], Math.min(stage.low[1], floor), stage.low[2]], high: stage.high }, floor);
    camera.frame(stage, scene.aspect);
  }

  async show(cache, index, moment) {
    const { scene } = this;
    try {
      const state = await cache.state(index, moment);
      const twin = await this.twinOf(cache, state);
      await this.findSpeed(cache, state);
      scene.things.forEach((thing, k) => (thing.contacts = state.contacts[k]));
      if (cache !== this.timeline?.cache) {
        return; // another file was opened meanwhile
      }
      this.timeline.moments = state.moments;
      this.camera.frames = state.frame - cache.run.start - (state.substep > 0 ? 1 - state.substep / state.substeps : 0);
      scene.update(state, twin);
      this.curve?.mark(index);
      showMoment(cache, state);
      countPoints(scene);
      showFigures(state.report, scene.lostPoints);
      showRungs(scene, state.contacts);
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
    const { moments } = await this.other.state(index);
    // The same share of the frame, however finely each was recorded.
    const moment = substep === 0 ? 0 : Math.max(0, Math.round((substep / substeps) * moments) - 1);
    return this.other.state(index, moment);
  }

  // Where everything was a frame ago, for its speed.
  async findSpeed(cache, state) {
    const before = this.scene.look.colour === "speed" && state.index > 0 ? await cache.state(state.index - 1) : null;
    this.scene.things.forEach((thing, k) => {
      const isSame = before?.meshes[k].number === state.meshes[k].number;
      const seconds = isSame && state.time - before.time;
      thing.before = seconds > 0 ? { positions: before.positions[k], seconds } : null;
      thing.mesh.coloured = null;
    });
  }

  toggleWireframe() {
    const { look } = this.scene;
    look.wireframe = !look.wireframe;
    byId("wireframe").setAttribute("aria-pressed", look.wireframe);
    this.redraw();
  }

  // Lets colours tell something; asked a second time, they tell objects apart again.
  colourBy(what) {
    const { look } = this.scene;
    if (byId(what).hidden) {
      return; // nothing is known of it
    }
    look.colour = look.colour === what ? "object" : what;
    COLOURINGS.forEach((id) => byId(id).setAttribute("aria-pressed", look.colour === id));
    showLegend(look);
    this.timeline.go(this.timeline.index, this.timeline.moment); // speeds are found when they are wanted
    this.redraw();
  }

  // The value that has the full colour.
  setFullScale(what, value) {
    if (value > 0 && what in this.scene.look.scales) {
      this.scene.look.scales[what] = Math.min(1e6, Math.max(1e-7, value));
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
      this.frameAll(); // else the other run stands outside the picture
    }
    this.redraw();
  }

  nextTwin() {
    if (this.other) {
      const places = ["over", "beside", "off"];
      this.placeTwin(places[(places.indexOf(this.scene.look.twin) + 1) % places.length]);
    }
  }

  // The cameras of the scene one after the other, then one's own.
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
    // Asked for first, so that a picture that cannot be drawn is not the last.
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

function showLoss(cache) {
  const [first, last] = [0, cache.frames.length - 1].map((index) => cache.frameNumber(index));
  if (cache.complete) {
    return;
  }
  showNotice(last === cache.run.end
    ? "The file was never closed, or its index is damaged; its frames are shown all the same."
    : `The run was cut short: frames ${first} to ${last} are shown.`);
}

export function complain(error) {
  console.error(error);
  const { message, hint } = error.hint === undefined
    ? { message: "The file could not be shown.", hint: `It seems to be damaged (${error.message}).` }
    : error;
  showState("error", message, hint);
}
