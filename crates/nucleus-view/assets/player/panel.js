// The panels of the page: objects, figures of the frame, legend, messages.

import { CONTACT_STATES, CONTACT_STATE_COLOURS, STRAIN, css } from "./shading.js";

const percent = (x) => `${(x * 100).toFixed(Math.abs(x) < 0.0995 ? 2 : 1)} %`;
const plain = (x) => (Number.isInteger(x) ? x.toLocaleString("en") : x.toPrecision(4));

// Figures of a report: label, format, and the test for a problem.
const FIGURES = {
  max_strain: ["Largest strain", percent],
  strain_99: ["Strain, 99 %", percent],
  min_gap: ["Smallest gap / thickness", (x) => x.toFixed(3), (x) => x < 0],
  min_cloth_gap: ["Smallest cloth-cloth gap / thickness", (x) => x.toFixed(3), (x) => x < 0],
  contacts: ["Contacts", plain],
  candidate_pairs: ["Candidate pairs", plain],
  touching: ["Points touching", plain],
  compressed: ["Points compressed", plain, (x) => x > 0],
  pairs_reverted: ["Pairs reverted", plain, (x) => x > 0],
  pairs_unresolved: ["Pairs unresolved", plain, (x) => x > 0],
  depenetrating: ["Points depenetrating", plain, (x) => x > 0],
  intersections: ["Edges intersecting", plain, (x) => x > 0],
  rest_limited: ["Rest-limited pairs", plain],
  kinetic_energy: ["Kinetic energy, J", plain],
};
// Shown elsewhere, or of interest to developers of the solver only.
const HIDDEN_FIGURES = ["frame", "broad_phases", "sanitized"];

export const byId = (id) => document.getElementById(id);

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// A line per object, with a checkbox to show it.
export function showObjects(scene, onChange) {
  byId("objects").replaceChildren(...scene.objects.map((object) => {
    const box = element("input", { type: "checkbox", checked: object.isShown });
    box.addEventListener("change", () => {
      scene.setShown(object, box.checked);
      box.blur(); // else the space bar would toggle it again
      onChange();
    });
    const swatch = element("i", { className: "swatch" });
    swatch.style.background = css(object.colour.map((x) => x * 1.3));
    object.count = element("small", {});
    return element("label", {}, box, swatch, element("span", { textContent: object.name }), object.count);
  }));
  countPoints(scene);
}

// Shows the number of points of each object in its current mesh.
export function countPoints(scene) {
  for (const { count, mesh, topology } of scene.objects) {
    count.textContent = `${mesh.kind} · ${plain(topology.points)} points`;
  }
}

// Shows the report of a frame, and the number of points that are not finite.
export function showFigures(report, invalidPoints) {
  const keys = [...new Set([...Object.keys(FIGURES), ...Object.keys(report ?? {})])];
  const rows = keys
    .map((key) => [key, report?.[key]])
    .filter(([key, value]) => typeof value === "number" && !HIDDEN_FIGURES.includes(key))
    .map(([key, value]) => {
      const [label, write, isBad] = FIGURES[key] ?? [key.replaceAll("_", " "), plain];
      return [label, write(value), isBad?.(value)];
    });
  if (invalidPoints > 0) {
    rows.push(["Points that are not finite", plain(invalidPoints), true]);
  }
  byId("figures").replaceChildren(...rows.flatMap(([label, value, isBad]) => [
    element("dt", { textContent: label }),
    element("dd", { textContent: value, className: isBad ? "bad" : "" }),
  ]));
  byId("figures").hidden = rows.length === 0;
}

// Strain is signed, with zero in the middle of the legend; speed and distance begin at its left end.
export function showLegend({ colour, scales }) {
  byId("legend").hidden = colour === "object";
  const isCategorical = colour === "contacts";
  byId("states").hidden = !isCategorical;
  ["ramp", "shorter", "middle", "longer"].forEach((id) => (byId(id).hidden = isCategorical));
  const isStrain = colour === "strain";
  const colours = isStrain ? STRAIN : STRAIN.slice(2);
  byId("quantity").textContent = {
    strain: "strain", speed: "speed, units per second", difference: "distance, units", contacts: "contact state, points",
  }[colour] ?? "";
  byId("ramp").style.background = `linear-gradient(to right, ${colours.map(css).join(", ")})`;
  const full = scales[colour] ?? 0;
  const write = (x) => (isStrain ? `${Number((x * 100).toPrecision(3))} %` : `${Number(x.toPrecision(3))}`);
  byId("shorter").textContent = isStrain ? `−${write(full)}` : "0";
  byId("middle").textContent = isStrain ? "0" : write(full / 2);
  byId("longer").textContent = isStrain ? `+${write(full)}` : write(full);
}

// Shows the number of points in each contact state, over the visible objects.
export function showContactStates(scene, contacts) {
  const counts = CONTACT_STATES.map(() => 0);
  scene.objects.forEach((object, k) => {
    for (const state of (object.isShown && contacts[k]) || []) {
      counts[state] += 1;
    }
  });
  byId("states").replaceChildren(...CONTACT_STATES.flatMap((name, k) => {
    const swatch = element("i", { className: "swatch" });
    swatch.style.background = css(CONTACT_STATE_COLOURS[k]);
    return [element("dt", {}, swatch, ` ${name}`), element("dd", { textContent: plain(counts[k]) })];
  }));
}

export function showTime(cache, { index, frame, substep, substeps, timeIndex, times, time }) {
  const share = times > 1 ? ` · substep ${substep} of ${substeps}` : "";
  byId("now").textContent = `frame ${frame}`;
  byId("of").textContent = `of ${cache.frameNumber(cache.frames.length - 1)}${share} · ${time.toFixed(3)} s`;
  byId("frames").value = index;
  byId("substeps").hidden = times < 2;
  Object.assign(byId("substeps"), { max: times - 1, value: timeIndex });
  Object.assign(document.body.dataset, { frame, substep });
}

// Sets the state of the page: "empty", "loading", "ready" or "error".
export function showState(state, message = "", hint = "") {
  document.body.dataset.state = state;
  byId("message").textContent = message;
  byId("hint").textContent = hint;
}

// Shows a line at the top; an empty text removes it.
export function showNotice(text) {
  byId("notice").textContent = text;
  byId("notice").hidden = text === "";
}
