// Starts the player: keys, buttons, dropped files, and the cache of the server.

import { applyAddress, linkTo } from "./link.js";
import { follow } from "./live.js";
import { byId, showNotice, showState } from "./panel.js";
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
  j: ({ timeline }) => timeline.shuttle(-1),
  k: ({ timeline }) => timeline.pause(),
  l: ({ timeline }) => timeline.shuttle(1),
  i: (player) => player.mark(0),
  o: (player) => player.mark(1),
  r: (player) => player.toggleLoop(),
  t: (player) => player.nextCamera(),
  f: (player) => player.frameAll(),
  w: (player) => player.toggleWireframe(),
  u: (player) => player.toggleSurface(),
  s: (player) => player.colourBy("strain"),
  v: (player) => player.colourBy("speed"),
  x: (player) => player.colourBy("contacts"),
  d: (player) => player.colourBy("difference"),
  b: (player) => player.nextTwin(),
  c: (player) => {
    byId("series").toggleAttribute("hidden");
    player.series.draw();
  },
  y: copyLink,
  "[": (player) => player.scaleColours(0.5),
  "]": (player) => player.scaleColours(2),
  Escape: (player) => byId("help").hidden ? player.pickAt(null) : toggleHelp(),
  "?": toggleHelp,
};
const BUTTONS = { play: " ", loop: "r", mark: "i", end: "o", link: "y", keys: "?", "close-help": "?", wireframe: "w", surface: "u", strain: "s", speed: "v", contacts: "x", difference: "d", twin: "b", camera: "t", all: "f" };

function toggleHelp() {
  byId("help").toggleAttribute("hidden");
}

function listen(player) {
  document.addEventListener("keydown", (event) => {
    const act = KEYS[event.key];
    const pressable = event.key === " " ? "button, summary, input[type=checkbox], select, textarea" : "select, textarea";
    const isForFocus = event.key !== "Escape" && event.target.matches?.(pressable);
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
  listenToPicks(player);
  listenToTracks(player);
  listenToSeries(player);
  listenToFiles(player);
  window.addEventListener("resize", player.redraw);
  const footer = document.querySelector("footer");
  new ResizeObserver(() => document.body.style.setProperty("--footer", `${footer.offsetHeight}px`)).observe(footer);
  window.addEventListener("hashchange", () => player.timeline && applyAddress(player));
}

function listenToPicks(player) {
  byId("unpick").addEventListener("click", () => player.pickAt(null));
  byId("copy").addEventListener("click", async ({ target }) => {
    target.blur();
    byId("components").select();
    await navigator.clipboard?.writeText(byId("components").value).catch(() => {});
  });
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

// A click on the series goes to a frame, a drag scrubs, the wheel zooms, and with shift it moves the view.
function listenToSeries(player) {
  const curve = byId("curve");
  const shareAt = (event) => {
    const share = (event.clientX - curve.getBoundingClientRect().left) / Math.max(1, curve.clientWidth);
    return Math.min(1, Math.max(0, share));
  };
  const go = (event) => {
    player.timeline.pause();
    player.timeline.go(player.series.indexAt(shareAt(event)));
  };
  curve.addEventListener("pointerdown", (event) => {
    curve.setPointerCapture(event.pointerId);
    go(event);
  });
  curve.addEventListener("pointermove", (event) => {
    curve.title = player.series.describe(player.series.indexAt(shareAt(event)));
    if (event.buttons & 1) {
      go(event);
    }
  });
  curve.addEventListener("wheel", (event) => {
    event.preventDefault();
    const steps = (event.deltaY || event.deltaX) * (event.deltaMode === 0 ? 1 : 16);
    event.shiftKey ? player.series.pan(steps * 0.001) : player.series.zoom(Math.exp(steps * 0.002), shareAt(event));
  }, { passive: false });
  curve.addEventListener("dblclick", () => player.series.zoom(Infinity, 0));
  byId("zoom-in").addEventListener("click", () => player.series.zoom(0.5, 0.5));
  byId("zoom-out").addEventListener("click", () => player.series.zoom(2, 0.5));
  byId("figure").addEventListener("change", ({ target }) => {
    player.series.choose(target.value);
    target.blur();
  });
  byId("pace").addEventListener("change", ({ target }) => {
    player.setSpeed(Number(target.value));
    target.blur();
  });
}

// Puts the address of the present view into the page's address and, where the browser allows it, the clipboard.
async function copyLink(player) {
  const link = linkTo(player);
  history.replaceState(null, "", link);
  const isCopied = await navigator.clipboard?.writeText(link).then(() => true, () => false);
  showNotice("link", isCopied ? "Link to this view copied" : "The address of the page is a link to this view");
  setTimeout(() => showNotice("link", ""), 2500);
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

async function start() {
  const player = new Player(byId("canvas"));
  globalThis.nucleusPlayer = player; // for the console, and for `cargo xtask book --only caches`
  listen(player);
  byId("panel").open = window.innerWidth > 900; // else it covers the picture
  byId("series").hidden = window.innerHeight < 480;
  byId("fit").addEventListener("click", () => player.fitDifference());
  follow(player).catch(showError);
  const served = await UrlSource.find("/cache.mcap");
  if (!served) {
    const { status } = await fetch("/live.json").catch(() => ({ status: 0 }));
    status === 200 || showState("empty", "Drop a cache here", "or choose a file");
  } else if (await player.open(served, await UrlSource.find("/other.mcap"))) {
    await applyAddress(player);
  }
}

start().catch(showError);
