// One open cache at a time: what is shown of it, and how.

import { Cache } from "./cache.js";
import { Camera } from "./camera.js";
import { byId, showFigures, showLegend, showMoment, showNotice, showObjects, showState } from "./panel.js";
import { Scene, boxOf } from "./scene.js";
import { Timeline } from "./timeline.js";

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
  async open(source) {
    this.timeline?.pause();
    this.timeline = null;
    showNotice("");
    showState("loading", `Opening ${source.name}`);
    const tell = (share) => showState("loading", `Searching ${source.name}`, `${Math.round(share * 100)} %`);
    try {
      const cache = await Cache.open(source, tell);
      await this.present(cache, source.name);
      showState("ready");
      return true;
    } catch (error) {
      complain(error);
      return false;
    }
  }

  async present(cache, name) {
    const { scene } = this;
    const last = cache.frames.length - 1;
    scene.setObjects(cache.objects);
    await this.survey(cache, [...new Set([last, last >> 1, 0])]);
    document.title = `${name} – Nucleus`;
    byId("name").textContent = cache.run.scene || name;
    byId("name").title = `${name}, written by Nucleus ${cache.run.version}`;
    byId("frames").max = last;
    showObjects(scene, this.redraw);
    showLoss(cache);
    this.timeline = new Timeline(cache, (index, moment) => this.show(cache, index, moment));
    await this.timeline.go(0);
  }

  // Looks at a few frames to find the room that the run takes up.
  async survey(cache, frames) {
    const { scene, camera } = this;
    const [moving, all] = [[], []];
    for (const frame of frames) {
      const { positions } = await cache.state(frame).catch(() => ({ positions: null }));
      if (positions) {
        scene.update(positions);
        moving.push(scene.bounds());
        all.push(...scene.things.map(({ mesh }) => mesh.bounds));
      }
    }
    const stage = boxOf(moving.filter(Boolean)) ?? NOWHERE;
    // A collider may be a landscape, which reaches far below what one looks at.
    const extent = Math.max(...stage.high.map((x, axis) => x - stage.low[axis]));
    const floor = Math.max(boxOf(all)?.low[1] ?? 0, stage.low[1] - extent * 1.5);
    scene.setStage({ low: [stage.low[0], Math.min(stage.low[1], floor), stage.low[2]], high: stage.high }, floor);
    camera.frame(stage, scene.aspect);
  }

  async show(cache, index, moment) {
    try {
      const state = await cache.state(index, moment);
      if (cache !== this.timeline?.cache) {
        return; // another file was opened meanwhile
      }
      this.timeline.moments = state.moments;
      this.scene.update(state.positions);
      showMoment(cache, state);
      showFigures(state.report, this.scene.lostPoints);
      this.redraw();
      cache.prefetch(index);
    } catch (error) {
      showNotice(`Frame ${cache.frameNumber(index)}: ${error.message} ${error.hint ?? ""}`);
    }
  }

  toggle(look) {
    this.scene.look[look] = !this.scene.look[look];
    byId(look).setAttribute("aria-pressed", this.scene.look[look]);
    showLegend(this.scene.look);
    this.redraw();
  }

  // The strain that has the full colour.
  setFullScale(strain) {
    this.scene.look.fullScale = Math.min(10, Math.max(1e-4, strain));
    showLegend(this.scene.look);
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
    this.timeline?.tick();
    byId("play").setAttribute("aria-pressed", this.timeline?.isPlaying ?? false);
    if (this.isStale && this.timeline) {
      this.isStale = false;
      this.scene.draw(this.camera);
    }
    requestAnimationFrame(() => this.everyRefresh());
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
