// The address of what is shown: frame, camera, colours and marks, as `#frame=12&view=...&strain=0.1`.

const COLOURINGS = ["strain", "speed", "contacts", "difference"];
const short = (x) => Number(x.toPrecision(5));

// The options that lead back to the present view.
export function optionsOf({ timeline, scene, camera, series }) {
  const options = new URLSearchParams();
  const { cache, marks, speed } = timeline;
  options.set("frame", cache.frameNumber(timeline.index));
  Number.isFinite(timeline.timeIndex) && options.set("time", timeline.timeIndex);
  if (camera.track) {
    options.set("camera", camera.track.name);
  } else {
    options.set("view", [camera.yaw, camera.pitch, camera.distance, ...camera.target].map(short).join(","));
  }
  const { colour, scales, wireframe, surface, twin } = scene.look;
  if (COLOURINGS.includes(colour)) {
    options.set(colour, colour in scales ? short(scales[colour]) : "");
  }
  new Set(scene.selections.filter(({ isShown }) => isShown).map(({ owner }) => owner)).forEach((owner) => options.append("select", owner));
  scene.picks.components.forEach((component) => options.append("pick", component));
  scene.objects.filter(({ isShown }) => !isShown).forEach(({ name }) => options.append("hide", name));
  wireframe && options.set("wireframe", "");
  surface && options.set("surface", "");
  scene.twins.length > 0 && options.set("twin", twin);
  ["in", "out"].forEach((name, k) => marks[k] !== null && options.set(name, cache.frameNumber(marks[k])));
  speed !== 1 && options.set("speed-of-play", speed);
  series.key !== series.usual && options.set("figure", series.key);
  return options;
}

// The address of the present view.
export function linkTo(player) {
  const address = new URL(location.href);
  address.hash = optionsOf(player).toString().replaceAll("%2C", ",");
  return address.href;
}

// Applies the options in the address.
export async function applyAddress(player) {
  const options = new URLSearchParams(location.hash.slice(1));
  const { timeline, scene } = player;
  applyMarks(player, options);
  if (options.has("frame")) {
    const time = Number.parseInt(options.get("time") ?? "", 10);
    await timeline.go(timeline.cache.indexOf(Number(options.get("frame"))), time >= 0 ? time : Infinity);
  }
  for (const colour of COLOURINGS.filter((name) => options.has(name))) {
    player.setFullScale(colour, Number(options.get(colour)));
    if (scene.look.colour !== colour) {
      player.colourBy(colour, Number(options.get(colour)) > 0);
    }
  }
  if (options.has("wireframe") && !scene.look.wireframe) {
    player.toggleWireframe();
  }
  if (options.has("surface") && !scene.look.surface) {
    player.toggleSurface();
  }
  player.hide(options.getAll("hide"));
  if (options.has("select")) {
    player.select(options.getAll("select"));
  }
  if (options.has("pick")) {
    player.pickComponents(options.getAll("pick"));
  }
  applyCamera(player, options);
  if (["over", "beside", "off"].includes(options.get("twin"))) {
    player.placeTwin(options.get("twin"));
  }
  if (options.has("play")) {
    timeline.play();
  }
}

function applyMarks(player, options) {
  const { timeline } = player;
  const index = (name) => options.has(name) ? timeline.cache.indexOf(Number(options.get(name))) : null;
  timeline.marks = [index("in"), index("out")];
  player.showMarks();
  if (Number(options.get("speed-of-play")) > 0) {
    player.setSpeed(Number(options.get("speed-of-play")));
  }
  if (options.has("figure")) {
    player.chooseFigure(options.get("figure"));
  }
}

function applyCamera(player, options) {
  if (options.has("camera")) {
    player.lookThrough(options.get("camera"));
  }
  const view = (options.get("view") ?? "").split(",").map(Number);
  if (view.length === 6 && view.every(Number.isFinite) && view[2] > 0) {
    const [yaw, pitch, distance, ...target] = view;
    Object.assign(player.camera, { yaw, pitch, distance, target, track: null, framed: null });
    player.redraw();
  }
}
