// A run in progress: `nucleus play --watch` solves a scene again when its file changes. The page asks for the state and
// opens the cache again when it has grown.

import { Cache } from "./cache.js";
import { showNotice, showState } from "./panel.js";
import { UrlSource } from "./source.js";

// Milliseconds between two questions, and the longest pause where opening takes long.
const INTERVAL = 400;
const MAX_INTERVAL = 5000;

const ask = () => fetch("/live.json").then((answer) => (answer.status === 200 ? answer.json() : null)).catch(() => undefined);

// Follows the runs of the server until the page closes. Resolves to false at once if nothing is watched.
export async function follow(player) {
  let state = await ask();
  if (!state) {
    return false;
  }
  let shown = { run: -1, size: 0, solving: true };
  for (;;) {
    const begun = performance.now();
    if (state === undefined) {
      showNotice("run", "The server no longer responds. Start `nucleus play` again.");
    } else if (state) {
      shown = await update(player, state, shown);
    }
    const cost = performance.now() - begun;
    await new Promise((resolve) => setTimeout(resolve, Math.min(MAX_INTERVAL, INTERVAL + 4 * cost)));
    state = await ask();
  }
}

async function update(player, state, shown) {
  const source = await UrlSource.find(`/cache.mcap?run=${state.run}`);
  const isNew = state.run !== shown.run;
  const isDone = !state.solving && shown.solving;
  // A run that has just begun has written nothing.
  if (source?.size > 0 && (isNew || isDone || source.size !== shown.size)) {
    const cache = await Cache.open(source).catch(() => null); // before its first frame is complete
    if (cache) {
      await player.replace(cache, source.name, isNew);
      showNotice("file", ""); // that it is incomplete is no news
      shown = { run: state.run, size: source.size, solving: state.solving };
    }
  }
  if (!player.timeline) {
    showState(state.message ? "error" : "loading", state.message || "Solving the first frame");
  }
  showNotice("run", state.message || (state.solving ? "Solving" : ""));
  return shown;
}
