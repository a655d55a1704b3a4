// Starts the player with the cache that the server has, or waits for a file.

import { applyAddress, listen } from "./controls.js";
import { byId, showState } from "./panel.js";
import { Player, complain } from "./player.js";
import { UrlSource } from "./source.js";

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

start().catch(complain);
