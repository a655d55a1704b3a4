// The player: opens a cache and connects timeline, scene and page.

import { Cache } from "./cache.js";
import { Camera } from "./camera.js";
import { byId, showFigures, showLegend, showMoment, showNotice, showObjects, showState } from "./panel.js";
import { Scene, boxOf } from "./scene.js";
import { FileSource, UrlSource } from "./source.js";
import { Timeline } from "./timeline.js";

let scene = null;
let camera = null;
let timeline = null;
let isStale = true; // whether the picture has to be drawn anew

const redraw = () => (isStale = true);

async function open(source) {
  timeline?.pause();
  timeline = null;
  showNotice("");
  showState("loading", `Opening ${source.name}`);
  try {
    const cache = await Cache.open(source, (share) => showState("loading", `Searching ${source.name}`, percent(share)));
    await present(cache, source.name);
    showState("ready");
  } catch (error) {
    complain(error);
  }
}

async function present(cache, name) {
  const last = cache.frames.length - 1;
  cache.objects.forEach((object) => (object.topology.name = object.name));
  scene.setObjects(cache.objects, { low: [-1, -1, -1], high: [1, 1, 1] }, 0);
  const mine = new Timeline(cache, (index, moment) => show(mine, index, moment));
  await survey(cache, [...new Set([last, last >> 1, 0])]);
  document.title = `${name} – Nucleus`;
  byId("name").textContent = cache.run.scene || name;
  byId("name").title = `${name}, written by Nucleus ${cache.run.version}`;
  byId("frames").max = last;
  scene.things.forEach((thing, k) => (thing.points = cache.objects[k].topology.points));
  showObjects(scene.things, redraw);
  if (!cache.complete) {
    showNotice(`The run was cut short: frames ${cache.frameNumber(0)} to ${cache.frameNumber(last)} are shown.`);
  }
  timeline = mine;
  await applyAddress();
}

// Looks at a few frames to find the room that the run takes up.
async function survey(cache, frames) {
  const [moving, all] = [[], []];
  for (const frame of frames) {
    const { positions } = await cache.state(frame).catch(() => ({ positions: null }));
    if (positions) {
      scene.update(positions);
      moving.push(scene.bounds());
      all.push(...scene.things.map(({ mesh }) => mesh.bounds));
    }
  }
  const stage = boxOf(moving.filter(Boolean)) ?? { low: [-1, -1, -1], high: [1, 1, 1] };
  // A collider that is a landscape reaches far below what one looks at.
  const depth = Math.max(...stage.high.map((x, axis) => x - stage.low[axis]));
  scene.floor = Math.max(boxOf(all)?.low[1] ?? 0, stage.low[1] - depth * 1.5);
  scene.stage = { low: [stage.low[0], Math.min(stage.low[1], scene.floor), stage.low[2]], high: stage.high };
  camera.frame(stage, scene.aspect);
}

async function show(mine, index, moment) {
  try {
    const state = await mine.cache.state(index, moment);
    if (mine !== timeline) {
      return; // another file was opened meanwhile
    }
    mine.moments = state.moments;
    scene.update(state.positions);
    showMoment(mine.cache, state);
    showFigures(state.report, scene.lostPoints);
    showState("ready");
    redraw();
    mine.cache.prefetch(index);
  } catch (error) {
    showNotice(`Frame ${mine.cache.frameNumber(index)}: ${error.message} ${error.hint ?? ""}`);
  }
}

function complain(error) {
  console.error(error);
  const { message, hint } = error.hint === undefined
    ? { message: "The file could not be shown.", hint: `It seems to be damaged (${error.message}).` }
    : error;
  showState("error", message, hint);
}

const percent = (share) => `${Math.round(share * 100)} %`;

function toggleLook(name) {
  scene.look[name] = !scene.look[name];
  byId(name).setAttribute("aria-pressed", scene.look[name]);
  showLegend(scene.look);
  redraw();
}

function scaleStrain(by) {
  scene.look.fullScale = Math.min(10, Math.max(1e-4, scene.look.fullScale * by));
  showLegend(scene.look);
  redraw();
}

function frameAll() {
  const bounds = scene.bounds();
  if (bounds) {
    camera.frame(bounds, scene.aspect);
  }
}

function toggleLoop() {
  timeline.isLooping = !timeline.isLooping;
  byId("loop").setAttribute("aria-pressed", timeline.isLooping);
}

const KEYS = {
  " ": () => timeline.toggle(),
  ArrowLeft: ({ shiftKey }) => timeline.step(shiftKey ? -10 : -1),
  ArrowRight: ({ shiftKey }) => timeline.step(shiftKey ? 10 : 1),
  ",": () => timeline.stepMoment(-1),
  ".": () => timeline.stepMoment(1),
  Home: () => timeline.step(-Infinity),
  End: () => timeline.step(Infinity),
  l: toggleLoop,
  f: frameAll,
  w: () => toggleLook("wireframe"),
  s: () => toggleLook("strain"),
  "[": () => scaleStrain(0.5),
  "]": () => scaleStrain(2),
  "?": () => byId("help").toggleAttribute("open"),
};

function listen() {
  const click = (id, act) => byId(id).addEventListener("click", (event) => {
    event.currentTarget.blur(); // else the space bar would press it again
    act(event);
  });
  document.addEventListener("keydown", (event) => {
    const act = KEYS[event.key];
    if (event.key === " " && event.target.matches("button, summary, input[type=checkbox]")) {
      return; // it presses what has the focus
    }
    if (act && timeline && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      act(event);
    }
  });
  click("play", KEYS[" "]);
  click("loop", toggleLoop);
  click("wireframe", KEYS.w);
  click("strain", KEYS.s);
  click("all", frameAll);
  byId("frames").addEventListener("input", ({ target }) => {
    timeline.pause();
    timeline.go(Number(target.value));
  });
  byId("moments").addEventListener("input", ({ target }) => {
    timeline.pause();
    timeline.go(timeline.index, Number(target.value));
  });
  byId("file").addEventListener("change", ({ target }) => target.files[0] && open(new FileSource(target.files[0])));
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer.files[0];
    return file && open(new FileSource(file));
  });
  window.addEventListener("resize", redraw);
}

// `#frame=12&strain=0.1&wireframe&play` behind the address opens the page in that state.
async function applyAddress() {
  const wish = new URLSearchParams(location.hash.slice(1));
  const frame = Number(wish.get("frame") ?? timeline.cache.frameNumber(0));
  const index = timeline.cache.frames.findIndex((_, k) => timeline.cache.frameNumber(k) >= frame);
  await timeline.go(index < 0 ? timeline.last : index);
  if (wish.has("strain")) {
    scene.look.fullScale = Number(wish.get("strain")) || scene.look.fullScale;
  }
  ["wireframe", "strain"].filter((name) => wish.has(name) && !scene.look[name]).forEach(toggleLook);
  if (wish.has("play")) {
    timeline.play();
  }
}

function everyRefresh() {
  timeline?.tick();
  byId("play").setAttribute("aria-pressed", timeline?.isPlaying ?? false);
  if (isStale && timeline) {
    isStale = false;
    scene.draw(camera);
  }
  requestAnimationFrame(everyRefresh);
}

async function start() {
  try {
    scene = new Scene(byId("canvas"));
  } catch (error) {
    complain(error);
    return;
  }
  camera = new Camera(byId("canvas"), redraw);
  listen();
  everyRefresh();
  const served = await UrlSource.find("/cache.mcap");
  if (served) {
    await open(served);
  } else {
    showState("empty", "Drop a cache here", "or choose a file");
  }
}

start();
