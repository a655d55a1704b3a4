// What the page tells in words and numbers: objects, figures of the frame, legend, messages.

import { RUNGS, RUNG_COLOURS, STRAIN, css } from "./colours.js";

const percent = (x) => `${(x * 100).toFixed(Math.abs(x) < 0.0995 ? 2 : 1)} %`;
const plain = (x) => (Number.isInteger(x) ? x.toLocaleString("en") : x.toPrecision(4));

// Figures of a report: what to call them, how to write them, and when they are bad news.
const FIGURES = {
  max_strain: ["Largest strain", percent],
  strain_99: ["Strain, 99 %", percent],
  min_gap: ["Smallest gap / thickness", (x) => x.toFixed(3), (x) => x < 0],
  min_cloth_gap: ["Smallest gap among cloths", (x) => x.toFixed(3), (x) => x < 0],
  contacts: ["Contacts", plain],
  candidate_pairs: ["Candidate pairs", plain],
  touching: ["Points that touch", plain],
  pinched: ["Pinched", plain, (x) => x > 0],
  pairs_reverted: ["Pairs reverted", plain, (x) => x > 0],
  pairs_unresolved: ["Pairs unresolved", plain, (x) => x > 0],
  depenetrating: ["Points in colliders", plain, (x) => x > 0],
  intersections: ["Intersections", plain, (x) => x > 0],
  kinetic_energy: ["Kinetic energy, J", plain],
};
// Told elsewhere, or of interest to the solver's makers only.
const UNTOLD = ["frame", "broad_phases", "sanitized"];

export const byId = (id) => document.getElementById(id);

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// A line per object, to switch it on and off.
export function showObjects(scene, onChange) {
  byId("objects").replaceChildren(...scene.things.map((thing) => {
    const box = element("input", { type: "checkbox", checked: thing.isShown });
    box.addEventListener("change", () => {
      scene.setShown(thing, box.checked);
      box.blur(); // else the space bar would switch it again
      onChange();
    });
    const swatch = element("i", { className: "swatch" });
    swatch.style.background = css(thing.colour.map((x) => x * 1.3));
    thing.count = element("small", {});
    return element("label", {}, box, swatch, element("span", { textContent: thing.name }), thing.count);
  }));
  countPoints(scene);
}

// Says how many points each object has in its present mesh.
export function countPoints(scene) {
  for (const { count, mesh, topology } of scene.things) {
    count.textContent = `${mesh.kind} · ${plain(topology.points)} points`;
  }
}

// The report of a frame, and how many points are not finite.
export function showFigures(report, lostPoints) {
  const keys = [...new Set([...Object.keys(FIGURES), ...Object.keys(report ?? {})])];
  const rows = keys
    .map((key) => [key, report?.[key]])
    .filter(([key, value]) => typeof value === "number" && !UNTOLD.includes(key))
    .map(([key, value]) => {
      const [label, write, isBad] = FIGURES[key] ?? [key.replaceAll("_", " "), plain];
      return [label, write(value), isBad?.(value)];
    });
  if (lostPoints > 0) {
    rows.push(["Points that are not finite", plain(lostPoints), true]);
  }
  byId("figures").replaceChildren(...rows.flatMap(([label, value, isBad]) => [
    element("dt", { textContent: label }),
    element("dd", { textContent: value, className: isBad ? "bad" : "" }),
  ]));
  byId("figures").hidden = rows.length === 0;
}

// Strain goes both ways from the middle of the legend; a speed or a distance goes up from its left end.
export function showLegend({ colour, scales }) {
  byId("legend").hidden = colour === "object";
  const tellsKinds = colour === "contacts";
  byId("rungs").hidden = !tellsKinds;
  ["ramp", "shorter", "middle", "longer"].forEach((id) => (byId(id).hidden = tellsKinds));
  const isStrain = colour === "strain";
  const colours = isStrain ? STRAIN : STRAIN.slice(2);
  byId("told").textContent = {
    strain: "strain", speed: "speed, units a second", difference: "distance, units", contacts: "contact, points of cloth",
  }[colour] ?? "";
  byId("ramp").style.background = `linear-gradient(to right, ${colours.map(css).join(", ")})`;
  const full = scales[colour] ?? 0;
  const write = (x) => (isStrain ? `${Number((x * 100).toPrecision(3))} %` : `${Number(x.toPrecision(3))}`);
  byId("shorter").textContent = isStrain ? `−${write(full)}` : "0";
  byId("middle").textContent = isStrain ? "0" : write(full / 2);
  byId("longer").textContent = isStrain ? `+${write(full)}` : write(full);
}

// How many points of the shown objects are at each kind of contact.
export function showRungs(scene, contacts) {
  const counts = RUNGS.map(() => 0);
  scene.things.forEach((thing, k) => {
    for (const rung of (thing.isShown && contacts[k]) || []) {
      counts[rung] += 1;
    }
  });
  byId("rungs").replaceChildren(...RUNGS.flatMap((name, k) => {
    const swatch = element("i", { className: "swatch" });
    swatch.style.background = css(RUNG_COLOURS[k]);
    return [element("dt", {}, swatch, ` ${name}`), element("dd", { textContent: plain(counts[k]) })];
  }));
}

export function showMoment(cache, { index, frame, substep, substeps, moment, moments, time }) {
  const share = moments > 1 ? ` · substep ${substep} of ${substeps}` : "";
  byId("now").textContent = `frame ${frame}`;
  byId("of").textContent = `of ${cache.frameNumber(cache.frames.length - 1)}${share} · ${time.toFixed(3)} s`;
  byId("frames").value = index;
  byId("moments").hidden = moments < 2;
  Object.assign(byId("moments"), { max: moments - 1, value: moment });
  Object.assign(document.body.dataset, { frame, substep });
}

// What one may do now: "empty", "loading", "ready" or "error".
export function showState(state, message = "", hint = "") {
  document.body.dataset.state = state;
  byId("message").textContent = message;
  byId("hint").textContent = hint;
}

// A line at the top that does not stop the show; empty takes it away.
export function showNotice(text) {
  byId("notice").textContent = text;
  byId("notice").hidden = text === "";
}
