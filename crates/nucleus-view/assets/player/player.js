// The player: one open cache, the scene, the camera and the timeline.

import { Cache, floorAt } from "./cache.js";
import { Camera } from "./camera.js";
import { distances, fittedScale, percentile } from "./compare.js";
import { boxOf, boxToFrame, extentOf, unionOf } from "./framing.js";
import {
  byId, countPoints, showComparison, showContactStates, showFigures, showLegend, showLegendNote, showNotice, showObjects, showSelections,
  showPicks, showSeriesFigures, showSeriesNow, showSpeed, showState, showTime,
} from "./panel.js";
import { pointAt } from "./pick.js";
import { levelPlane } from "./plane.js";
import { Scene } from "./scene.js";
import { Series } from "./series.js";
import { ReplacedRun } from "./source.js";
import { fittedSpeed, nearestValues, particleSpeeds } from "./speed.js";
import { hasSurfaces, withSurfaces } from "./surface.js";
import { Timeline } from "./timeline.js";

// The speed of full saturation until it is fitted, in metres per second: that after a fall of 1.3 m.
const FULL_SPEED = 5;
const COLOURINGS = ["strain", "speed", "contacts", "difference"];
const DEFAULT_STAGE = { low: [-1, -1, -1], high: [1, 1, 1] };

export class Player {
  constructor(canvas) {
    this.redraw = () => (this.isStale = true);
    this.isStale = true; // whether the picture must be drawn again
    this.scene = new Scene(canvas);
    this.camera = new Camera(canvas, this.redraw, (place, isMore) => this.timeline && this.pickAt(place, isMore));
    this.timeline = null; // of the open cache
    this.series = new Series(byId("curve"), (figures) => showSeriesFigures(figures, this.series.key), showSeriesNow);
    this.other = null; // the cache of the other run, if one is compared
    this.names = []; // of the files of the two runs
    this.everyRefresh();
  }

  // Opens a source; resolves when its first frame is shown, to false if it is not a cache.
  async open(source, other = null) {
    this.timeline?.pause();
    this.timeline = null;
    ["file", "frame", "other"].forEach((about) => showNotice(about, ""));
    showState("loading", `Opening ${source.name}`);
    const onProgress = (share) => showState("loading", `Scanning ${source.name}`, `${Math.round(share * 100)} %`);
    try {
      const cache = await Cache.open(source, onProgress);
      this.other = other && (await Cache.open(other, onProgress));
      this.names = [source.name, other?.name];
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
    this.fitted = new Set(); // quantities whose scale is fitted to the run
    scene.setObjects(cache.objects, this.other?.objects);
    ["difference", "twin"].forEach((id) => (byId(id).hidden = !this.other));
    const stage = await this.findStage(cache);
    scene.setStage(stage.box, stage.floor);
    camera.frame(stage.framed, scene.aspect);
    scene.look.scales.speed = cache.run.unitsPerMetre * FULL_SPEED;
    showIncomplete(cache);
    this.describe(cache, name);
    camera.track = cache.run.cameras[0] ?? null;
    this.take(cache);
    await this.timeline.go(0);
  }

  // Shows the names and selections of a run, and the buttons of what it holds.
  describe(cache, name) {
    const { scene } = this;
    document.title = `${name} – Nucleus`;
    byId("name").textContent = cache.run.scene.split(/[/\\]/).pop() || name;
    byId("name").title = `${cache.run.scene}\n${name}, written by Nucleus ${cache.run.version}`.trim();
    scene.setSelections(cache.run.selections);
    showObjects(scene, this.redraw);
    showSelections(scene, this.redraw);
    byId("strain").hidden = !cache.objects.some(({ topology }) => topology.kind === "cloth");
    byId("contacts").hidden = !cache.objects.some((object) => object.contacts !== undefined);
    byId("surface").hidden = !hasSurfaces(cache);
    byId("camera").hidden = cache.run.cameras.length === 0;
  }

  // Gives a cache to the timeline and to the series.
  take(cache) {
    byId("frames").max = cache.frames.length - 1;
    this.timeline = new Timeline(cache, (index, timeIndex) => this.show(cache, index, timeIndex));
    this.series.open(cache, this.other);
  }

  // Replaces the cache of a run that has grown, or was solved again. What is shown stays: frame, camera, colours. A run
  // that is watched at its last frame stays at its last frame.
  async replace(cache, name, isNew) {
    const before = this.timeline;
    if (!before || objectNames(before.cache) !== objectNames(cache)) {
      this.names = [name];
      await this.present(cache, name);
      showState("ready");
      return;
    }
    const follows = before.index >= before.last && !isNew;
    const { index, marks, speed, isLooping, isPlaying, rate } = before;
    before.pause();
    const stage = await this.findStage(cache);
    if (isNew) {
      const hidden = this.scene.objects.filter(({ isShown }) => !isShown).map((object) => object.name);
      this.scene.setObjects(cache.objects);
      this.hide(hidden);
      this.describe(cache, name);
    }
    this.followCamera(cache);
    this.scene.setStage(stage.box, stage.floor);
    this.camera.measure(stage.framed);
    this.take(cache);
    Object.assign(this.timeline, { index: Math.min(index, cache.frames.length - 1), marks, speed, isLooping });
    if (isPlaying) {
      this.timeline.play(rate);
    } else {
      await this.timeline.go(follows || index >= cache.frames.length ? Infinity : index);
    }
  }

  // Follows the camera of the same name in a cache that replaces another; if it is gone, the view stays where it was.
  followCamera(cache) {
    const { camera } = this;
    const found = cache.run.cameras.find(({ name }) => name === camera.track?.name);
    if (camera.track && !found) {
      camera.leave();
    }
    camera.track = found ?? null;
  }

  // From a few frames: the bounding box of the run, the box that a camera frames, and the plane of the floor.
  async findStage(cache) {
    const last = cache.frames.length - 1;
    const [simulated, all, framed] = [[], [], []];
    for (const frame of new Set([last, last >> 1, 0])) {
      const { positions = [] } = await cache.state(frame).catch(() => ({}));
      framed.push(boxToFrame(positions.map((points, k) => ({ kind: cache.objects[k].topology.kind, points }))));
      positions.forEach((points, k) => {
        const { kind, radius } = cache.objects[k].topology;
        const box = boxOf(points, kind === "particles" ? radius : 0);
        all.push(box);
        kind !== "collider" && simulated.push(box);
      });
    }
    const box = unionOf(simulated) ?? unionOf(all) ?? DEFAULT_STAGE;
    // A collider may be a landscape that reaches far below the cloth.
    const below = () => levelPlane(Math.max(unionOf(all)?.low[1] ?? 0, box.low[1] - extentOf(box) * 1.5));
    return { box, framed: unionOf(framed.filter(Boolean)) ?? box, floor: cache.run.floor ?? below() };
  }

  async show(cache, index, timeIndex) {
    const { scene } = this;
    try {
      const recorded = await cache.state(index, timeIndex);
      const state = scene.look.surface ? await withSurfaces(cache, recorded) : recorded;
      const twin = await this.twinOf(cache, state);
      await this.findSpeed(cache, recorded, state);
      scene.objects.forEach((object, k) => this.takeRecorded(object, recorded, state, k));
      if (cache !== this.timeline?.cache) {
        return; // another file has been opened in the meantime
      }
      this.timeline.times = state.times;
      this.camera.frames = state.frame - cache.run.start - (state.substep > 0 ? 1 - state.substep / state.substeps : 0);
      scene.moveFloor(floorAt(cache.run, this.camera.frames));
      scene.update(state, twin);
      scene.areTwinsKnown = Boolean(twin);
      this.series.mark(state.index, this.timeline.marks);
      showTime(cache, state);
      countPoints(scene);
      showFigures(state.report, scene.invalidPoints, this.other && (twin?.report ?? {}));
      this.compare(state, twin);
      showContactStates(scene, recorded.contacts);
      showPicks(scene.picks, scene);
      showLegendNote(scene.look.colour === "speed" && scene.objects.some(({ isShown, speeds }) => isShown && speeds === null));
      showNotice("frame", "");
      this.redraw();
      cache.prefetch(index);
    } catch (error) {
      if (error instanceof ReplacedRun) {
        return; // the next one is opened as soon as it has a frame
      }
      showNotice("frame", `Frame ${cache.frameNumber(index)}: ${error.message} ${error.hint ?? ""}`);
    }
  }

  // Hides the objects of these names, and shows all others.
  hide(names) {
    this.scene.objects.forEach((object) => this.scene.setShown(object, !names.includes(object.name)));
    showObjects(this.scene, this.redraw);
    this.redraw();
  }

  // Shows the points of the constraints of these names, and hides those of all others.
  select(owners) {
    this.scene.selections.forEach((selection) => (selection.isShown = owners.includes(selection.owner)));
    showSelections(this.scene, this.redraw);
    byId("selections").open ||= owners.length > 0;
    this.redraw();
  }

  // Picks the point under a place on the canvas, in place of all others or, with `isMore`, beside them.
  pickAt(place, isMore) {
    this.scene.picks.pick(place && pointAt(this.scene, this.camera, place), isMore);
    this.showPicks();
  }

  // Picks the points of components.
  pickComponents(components) {
    this.scene.picks.read(components);
    this.showPicks();
  }

  showPicks() {
    showPicks(this.scene.picks, this.scene);
    this.redraw();
  }

  // The state of the other run at the same time; null if there is no other run, or it has no such frame.
  async twinOf(cache, { frame, substep, substeps }) {
    const index = this.other?.indexAt(frame) ?? null;
    if (index === null) {
      return null;
    }
    const { times } = await this.other.state(index);
    // The same fraction of the frame, because the runs may have recorded different numbers of substeps.
    const timeIndex = substep === 0 ? 0 : Math.max(0, Math.round((substep / substeps) * times) - 1);
    const names = this.other.objects.map(({ name }) => name);
    return { ...(await this.other.state(index, timeIndex)), names };
  }

  // Shows how far the two runs are apart. At a frame that the other run does not have there is no distance.
  compare(state, twin) {
    if (!this.other) {
      return;
    }
    const sorted = twin && distances(this.scene.objects, state, twin);
    this.p99 = sorted ? percentile(sorted, 0.99) : 0;
    const scenes = [this.timeline.cache, this.other].map(({ run }) => run.scene);
    showComparison(this.names, scenes, sorted && [0.5, 0.99, 1].map((share) => percentile(sorted, share)));
    showNotice("other", twin ? "" : this.absence(state.frame));
  }

  // Why the other run has no state at a frame.
  absence(frame) {
    const [first, last] = [0, this.other.frames.length - 1].map((index) => this.other.frameNumber(index));
    if (frame > last) {
      return `The other run ends at frame ${last}.`;
    }
    return frame < first ? `The other run begins at frame ${first}.` : `The other run has no frame ${frame}.`;
  }

  // Fits the scale of a quantity to the run, once.
  fitOnce(quantity) {
    const fit = { speed: () => this.fitSpeed(), difference: () => this.fitDifference() }[quantity];
    if (fit && !this.fitted.has(quantity)) {
      this.fitted.add(quantity);
      fit().catch(() => {}); // of a run that is solved again
    }
  }

  // Sets the scale of the speed to that of the run.
  async fitSpeed() {
    this.setFullScale("speed", await fittedSpeed(this.timeline.cache));
  }

  // Sets the scale of the difference to the 99th percentile of the distances of the shown frame; of the run, where the
  // frame has none.
  async fitDifference() {
    this.setFullScale("difference", this.p99 || (await fittedScale(this)));
  }

  setSpeed(speed) {
    this.timeline.setSpeed(speed);
    showSpeed(speed);
  }

  // Sets the in point (0) or the out point (1) to the shown frame, or removes it.
  mark(which) {
    this.timeline.mark(which);
    this.showMarks();
    this.series.mark(this.timeline.index, this.timeline.marks);
  }

  showMarks() {
    ["mark", "end"].forEach((id, k) => byId(id).setAttribute("aria-pressed", this.timeline.marks[k] !== null));
  }

  chooseFigure(key) {
    this.series.choose(key);
    byId("figure").value = key;
  }

  // What the speed follows from: the positions of the frame before, and the speeds of particles and of their surfaces.
  // `shown` is the recorded state, with surfaces in place of particles if they are shown.
  async findSpeed(cache, recorded, shown) {
    const isSpeed = this.scene.look.colour === "speed";
    const before = isSpeed && recorded.index > 0 ? await cache.state(recorded.index - 1) : null;
    this.scene.objects.forEach((object, k) => {
      object.mesh.coloured = null;
      [object.before, object.speeds] = [undefined, undefined];
      if (isSpeed && recorded.meshes[k].kind === "particles") {
        const speeds = particleSpeeds(cache.objects[k].topology, k, recorded, before);
        const isSurface = shown.meshes[k].kind === "surface";
        object.speeds = speeds && isSurface ? nearestValues(shown.positions[k], recorded.positions[k], speeds) : speeds;
      } else if (isSpeed) {
        const isSame = before?.meshes[k].number === recorded.meshes[k].number;
        const seconds = isSame && recorded.time - before.time;
        object.before = seconds > 0 ? { positions: before.positions[k], seconds } : null;
      }
    });
  }

  // What an object keeps of the recorded state: its points, and the contact states of the points that are shown. `shown` has
  // surfaces in place of particles if they are shown; a point of a surface has the state of the nearest particle.
  takeRecorded(object, recorded, shown, k) {
    object.recorded = recorded.positions[k];
    const contacts = recorded.contacts[k];
    const isSurface = contacts && this.scene.look.colour === "contacts" && shown.meshes[k].kind === "surface";
    object.contacts = isSurface ? nearestValues(shown.positions[k], recorded.positions[k], contacts) : contacts;
  }

  toggleWireframe() {
    const { look } = this.scene;
    look.wireframe = !look.wireframe;
    byId("wireframe").setAttribute("aria-pressed", look.wireframe);
    this.redraw();
  }

  // Draws particles as a surface, or as particles again.
  toggleSurface() {
    const { look } = this.scene;
    if (byId("surface").hidden) {
      return;
    }
    look.surface = !look.surface;
    byId("surface").setAttribute("aria-pressed", look.surface);
    this.timeline.go(this.timeline.index, this.timeline.timeIndex);
  }

  // Colours the objects by a quantity; a second call returns to a colour per object. Without a scale, those of speed and
  // difference are fitted once.
  colourBy(quantity, hasScale = false) {
    const { look } = this.scene;
    if (byId(quantity).hidden) {
      return; // the cache does not hold it
    }
    if (!hasScale) {
      this.fitOnce(quantity);
    }
    look.colour = look.colour === quantity ? "object" : quantity;
    COLOURINGS.forEach((id) => byId(id).setAttribute("aria-pressed", look.colour === id));
    showLegend(look);
    showLegendNote(false);
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
    const { isPlaying = false, rate = 1, speed = 1 } = this.timeline ?? {};
    byId("play").setAttribute("aria-pressed", isPlaying);
    byId("rate").textContent = isPlaying && rate !== speed ? `${rate} ×` : "";
    if (this.isStale && this.timeline) {
      this.isStale = false;
      byId("camera").textContent = this.camera.track?.name ?? "free";
      this.scene.draw(this.camera);
    }
  }
}

const objectNames = (cache) => cache.objects.map(({ name }) => name).join("\n");

function showIncomplete(cache) {
  const [first, last] = [0, cache.frames.length - 1].map((index) => cache.frameNumber(index));
  if (cache.complete) {
    return;
  }
  showNotice("file", last === cache.run.end
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
