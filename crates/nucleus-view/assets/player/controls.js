// Keys, buttons, dropped files, and wishes in the address.

import { byId } from "./panel.js";
import { FileSource } from "./source.js";

// What a key does, once a cache is open.
const KEYS = {
  " ": ({ timeline }) => timeline.toggle(),
  ArrowLeft: ({ timeline }, { shiftKey }) => timeline.step(shiftKey ? -10 : -1),
  ArrowRight: ({ timeline }, { shiftKey }) => timeline.step(shiftKey ? 10 : 1),
  ",": ({ timeline }) => timeline.stepMoment(-1),
  ".": ({ timeline }) => timeline.stepMoment(1),
  Home: ({ timeline }) => timeline.step(-Infinity),
  End: ({ timeline }) => timeline.step(Infinity),
  l: (player) => player.toggleLoop(),
  f: (player) => player.frameAll(),
  w: (player) => player.toggle("wireframe"),
  s: (player) => player.toggle("strain"),
  "[": (player) => player.setFullScale(player.scene.look.fullScale / 2),
  "]": (player) => player.setFullScale(player.scene.look.fullScale * 2),
  "?": () => byId("help").toggleAttribute("open"),
};
const BUTTONS = { play: " ", loop: "l", wireframe: "w", strain: "s", all: "f" };

export function listen(player) {
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
      byId(id).blur(); // else the space bar would press it again
      KEYS[key](player, event);
    });
  }
  listenToTracks(player);
  listenToFiles(player);
  window.addEventListener("resize", player.redraw);
  window.addEventListener("hashchange", () => player.timeline && applyAddress(player));
}

function listenToTracks(player) {
  byId("frames").addEventListener("input", ({ target }) => {
    player.timeline.pause();
    player.timeline.go(Number(target.value));
  });
  byId("moments").addEventListener("input", ({ target }) => {
    player.timeline.pause();
    player.timeline.go(player.timeline.index, Number(target.value));
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

// `#frame=12&strain=0.1&wireframe&play` behind the address shows that frame in that way.
export async function applyAddress(player) {
  const wish = new URLSearchParams(location.hash.slice(1));
  const { timeline, scene } = player;
  if (wish.has("frame")) {
    await timeline.go(timeline.indexOf(Number(wish.get("frame"))));
  }
  if (Number(wish.get("strain")) > 0) {
    player.setFullScale(Number(wish.get("strain")));
  }
  ["wireframe", "strain"].filter((look) => wish.has(look) && !scene.look[look]).forEach((look) => player.toggle(look));
  if (wish.has("play")) {
    timeline.play();
  }
}
