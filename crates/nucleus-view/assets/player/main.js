// Starts the player: keys, buttons, dropped files, options in the address, and the cache of the server.

import { byId, showState } from "./panel.js";
import { Player, showError } from "./player.js";
import { FileSource, UrlSource } from "./source.js";

// The actions of the keys, once a cache is open.
const KEYS = {
  " ": ({ timeline }) => timeline.toggle(),
  ArrowLeft: ({ timeline }, { shiftKey }) => timeline.step(shiftKey ? -10 : -1),
  ArrowRight: ({ timeline }, { shiftKey }) => timeline.step(shiftKey ? 10 : 1),
  ",": ({ timeline }) => timeline.stepSubstep(-1),
  ".": ({ timeline }) => timeline.stepSubstep(1),
  Home: ({ timeline }) => timeline.step(-Infinity),
  End: ({ timeline }) => timeline.step(Infinity),
  t: (player) => player.nextCamera(),
  l: (player) => player.toggleLoop(),
  f: (player) => player.frameAll(),
  w: (player) => player.toggleWireframe(),
  s: (player) => player.colourBy("strain"),
  v: (player) => player.colourBy("speed"),
  x: (player) => player.colourBy("contacts"),
  d: (player) => player.colourBy("difference"),
  b: (player) => player.nextTwin(),
  c: () => byId("curve").toggleAttribute("hidden"),
  "[": (player) => player.scaleColours(0.5),
  "]": (player) => player.scaleColours(2),
  "?": () => byId("help").toggleAttribute("open"),
};
const BUTTONS = { play: " ", loop: "l", wireframe: "w", strain: "s", speed: "v", contacts: "x", difference: "d", twin: "b", camera: "t", all: "f" };

function listen(player) {
  document.addEventListener("keydown", (event) => {
    const act = KEYS[event.key];
    const isForFocus = event.key === " " && event.target.matches?.("button, summary, input[type=checkbox]");
    if (act && player.timeline && !isForFocus && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      act(player, event);
    }
  });
  for (const [id, key] of Object.entries(BUTTONS)) {
    byId(id).addEventListener("click", (event) => {
      byId(id).blur(); // else the space bar would press the button again
      KEYS[key](player, event);
    });
  }
  listenToTracks(player);
  listenToCurve(player);
  listenToFiles(player);
  window.addEventListener("resize", player.redraw);
  window.addEventListener("hashchange", () => player.timeline && applyAddress(player));
}

function listenToTracks(player) {
  byId("frames").addEventListener("input", ({ target }) => {
    player.timeline.pause();
    player.timeline.go(Number(target.value));
  });
  byId("substeps").addEventListener("input", ({ target }) => {
    player.timeline.pause();
    player.timeline.go(player.timeline.index, Number(target.value));
  });
}

// A click on the curve goes to a frame, a drag scrubs.
function listenToCurve(player) {
  const curve = byId("curve");
  const indexAt = (event) => {
    const share = (event.clientX - curve.getBoundingClientRect().left) / Math.max(1, curve.clientWidth);
    return Math.round(Math.min(1, Math.max(0, share)) * player.timeline.last);
  };
  const go = (event) => {
    player.timeline.pause();
    player.timeline.go(indexAt(event));
  };
  curve.addEventListener("pointerdown", (event) => {
    curve.setPointerCapture(event.pointerId);
    go(event);
  });
  curve.addEventListener("pointermove", (event) => {
    curve.title = `${player.curve?.describe(indexAt(event)) ?? ""}: click to go there`;
    if (event.buttons & 1) {
      go(event);
    }
  });
}

function listenToFiles(player) {
  const open = (file) => file && player.open(new FileSource(file));
  byId("file").addEventListener("change", ({ target }) => open(target.files[0]));
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    open(event.dataTransfer.files[0]);
  });
}

// Applies the options in the address, such as `#frame=12&strain=0.1&wireframe&play`.
async function applyAddress(player) {
  const options = new URLSearchParams(location.hash.slice(1));
  const { timeline, scene } = player;
  if (options.has("frame")) {
    await timeline.go(timeline.cache.indexOf(Number(options.get("frame"))));
  }
  for (const colour of ["strain", "speed", "contacts", "difference"].filter((name) => options.has(name))) {
    player.setFullScale(colour, Number(options.get(colour)));
    if (scene.look.colour !== colour) {
      player.colourBy(colour);
    }
  }
  if (options.has("wireframe") && !scene.look.wireframe) {
    player.toggleWireframe();
  }
  if (options.has("camera")) {
    player.lookThrough(options.get("camera"));
  }
  if (["over", "beside", "off"].includes(options.get("twin"))) {
    player.placeTwin(options.get("twin"));
  }
  if (options.has("play")) {
    timeline.play();
  }
}

async function start() {
  const player = new Player(byId("canvas"));
  globalThis.nucleusPlayer = player; // for the console, and for `cargo xtask book --only caches`
  listen(player);
  const served = await UrlSource.find("/cache.mcap");
  if (!served) {
    showState("empty", "Drop a cache here", "or choose a file");
  } else if (await player.open(served, await UrlSource.find("/other.mcap"))) {
    await applyAddress(player);
  }
}

start().catch(showError);
