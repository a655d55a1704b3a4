// Opens the player in Chromium and prints, as JSON, how long what took.

import puppeteer from "puppeteer-core";

const [executablePath, url] = process.argv.slice(2);
const args = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await puppeteer.launch({ executablePath, args, defaultViewport: { width: 1280, height: 720 } });
const page = await browser.newPage();
const begin = performance.now();
await page.goto(url, { waitUntil: "commit" }).catch(() => page.goto(url));
await page.waitForFunction(() => document.body?.dataset.state === "ready", { polling: 5, timeout: 120000 });
const opened = performance.now() - begin;
// The reports of the run are read meanwhile; they are not to be waited for with the frames.
await page.waitForFunction(() => document.getElementById("curve").dataset.known, { polling: 100, timeout: 120000 });
const times = await page.evaluate(async () => {
  const { scene, camera, timeline } = globalThis.nucleusPlayer;
  const { cache } = timeline;
  const found = { fetch: [], unpack: [], update: [], draw: [] };
  const pixel = new Uint8Array(4);
  const { gl } = scene;
  // Graphics are done when they can be read: what is asked of them only queues up.
  const settle = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  let bytes = 0;
  const read = cache.source.read.bind(cache.source);
  cache.source.read = async (...range) => {
    const begin = performance.now();
    const answer = await read(...range);
    bytes += performance.now() - begin;
    return answer;
  };
  const timed = async (key, work) => {
    const begin = performance.now();
    const result = await work();
    found[key].push(performance.now() - begin);
    return result;
  };
  for (let k = 1; k <= 300; k += 1) {
    bytes = 0;
    const state = await timed("unpack", () => cache.state((k * 7919) % cache.frames.length));
    found.fetch.push(bytes);
    found.unpack.push(found.unpack.pop() - bytes);
    await timed("update", () => scene.update(state));
    if (k % 10 === 0) {
      settle();
      await timed("draw", () => {
        scene.draw(camera);
        settle();
      });
    }
  }
  const share = (list, part) => list.sort((a, b) => a - b)[Math.floor((list.length - 1) * part)];
  return Object.fromEntries(Object.entries(found).map(([key, list]) => [key, [share(list, 0.5), share(list, 0.99)]]));
});
console.log(JSON.stringify({ opened, browser: await browser.version(), ...times }));
await browser.close();
