// The panels of the page: objects, figures of the frame, legend, messages.

import { figure, figuresOf, plain } from "./figures.js";
import { CONTACT_STATES, CONTACT_STATE_COLOURS, STRAIN, css } from "./shading.js";

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

// A line per selection, with a checkbox to show its points.
export function showSelections(scene, onChange) {
  byId("selections").hidden = scene.selections.length === 0;
  byId("selection-list").replaceChildren(...scene.selections.map((selection) => {
    const box = element("input", { type: "checkbox", checked: selection.isShown });
    box.addEventListener("change", () => {
      selection.isShown = box.checked;
      box.blur();
      onChange();
    });
    const swatch = element("i", { className: "swatch" });
    swatch.style.background = `rgb(${selection.colour.map((x) => Math.round(255 * x)).join(" ")})`;
    const count = element("small", { textContent: `${plain(selection.points.length)} points of ${selection.object}` });
    return element("label", {}, box, swatch, element("span", { textContent: selection.owner }), count);
  }));
}

// Shows the picked points: their number and components, the place of the last, and the distance of the last two.
export function showPicks(picks, scene) {
  const places = picks.places(scene);
  const [last, before] = [places.at(-1), places.at(-2)];
  const rows = [["Picked points", plain(picks.all.length)]];
  if (last) {
    rows.push(["Place of the last", last.map(short).join(", ")]);
  }
  if (before) {
    rows.push(["Distance of the last two", short(Math.hypot(...last.map((x, axis) => x - before[axis])))]);
  }
  byId("pick-figures").replaceChildren(...rows.flatMap(([label, value]) => [
    element("dt", { textContent: label }), element("dd", { textContent: value }),
  ]));
  const components = picks.components.map((component) => `"${component}"`).join(", ");
  byId("components").value = byId("components").textContent = components;
  byId("picked").hidden = picks.all.length === 0;
}

// Shows the number of points of each object in its current mesh.
export function countPoints(scene) {
  for (const { count, mesh, topology } of scene.objects) {
    count.textContent = `${mesh.kind} · ${plain(topology.points)} points`;
  }
}

// Shows the report of a frame, beside that of the other run if there is one, and the number of points that are not finite.
export function showFigures(report, invalidPoints, other = null) {
  const all = figuresOf([report, other]);
  const cell = (held, { key, write, isBad }) => {
    const value = held?.[key];
    const isKnown = typeof value === "number";
    return element("dd", { textContent: isKnown ? write(value) : "–", className: isKnown && isBad(value) ? "bad" : "" });
  };
  const row = (one) => [
    element("dt", { textContent: one.label }), cell(report, one), ...(other ? [cell(other, one)] : []),
  ];
  const rows = all.filter(({ isInternal }) => !isInternal).flatMap(row);
  if (invalidPoints > 0) {
    const count = element("dd", { textContent: plain(invalidPoints), className: "bad" });
    rows.push(element("dt", { textContent: "Points that are not finite" }), count, ...(other ? [element("dd")] : []));
  }
  if (other && rows.length > 0) {
    rows.unshift(element("dt"), element("dd", { textContent: "this", className: "own" }), element("dd", { textContent: "other", className: "other" }));
  }
  const internals = all.filter(({ isInternal }) => isInternal).flatMap(row);
  byId("figures").replaceChildren(...rows);
  byId("internal-figures").replaceChildren(...internals);
  byId("figures").hidden = rows.length === 0;
  byId("internals").hidden = internals.length === 0;
  ["figures", "internal-figures"].forEach((id) => byId(id).classList.toggle("compared", Boolean(other)));
}

// Names both runs, with the median, the 99th percentile and the largest distance between their points; null if they have
// no distance at this frame.
export function showComparison(names, scenes, distances) {
  const run = (name, scene, className) => [
    element("dt", { textContent: className, className }), element("dd", { textContent: name, title: scene }),
  ];
  const [median, p99, largest] = distances?.map(short) ?? ["–", "–", "–"];
  const distance = (label, value) => [element("dt", { textContent: label }), element("dd", { textContent: value })];
  byId("runs").replaceChildren(...run(names[0], scenes[0], "this"), ...run(names[1] ?? "", scenes[1], "other"));
  byId("distances").replaceChildren(
    ...distance("Distance, median", median), ...distance("Distance, 99 %", p99), ...distance("Distance, largest", largest),
  );
  byId("comparison").hidden = false;
}

const short = (x) => `${Number(x.toPrecision(3))}`;

// The figures that the series can show.
export function showSeriesFigures(figures, chosen) {
  const option = ({ key, label }) => element("option", { value: key, textContent: label, selected: key === chosen });
  const known = figures.some(({ key }) => key === chosen) ? figures : [figure(chosen), ...figures];
  byId("figure").replaceChildren(...known.map(option));
}

// Shows the values of both runs at the shown frame, as texts; empty where there is none.
export function showSeriesNow([own, other]) {
  const value = (text, className) => element("span", { textContent: `${text} `, className });
  byId("series-now").replaceChildren(value(own, "this"), value(other, "other"));
}

// Selects a speed, which is added to the list if it is not there.
export function showSpeed(speed) {
  const select = byId("pace");
  if (![...select.options].some(({ value }) => Number(value) === speed)) {
    select.append(element("option", { value: `${speed}`, textContent: `${speed} ×` }));
  }
  select.value = `${speed}`;
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

// Says that the speed of some particles is not known.
export function showLegendNote(isUnknown) {
  byId("unknown").hidden = !isUnknown;
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
  byId("frames").setAttribute("aria-valuetext", `frame ${frame}`);
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

// The notices at the top, by what they are about.
const notices = new Map();

// Shows a notice about the "file", a "frame", the "other" run, the "run" in progress or the "link"; an empty text removes it. Notices about
// other things stay.
export function showNotice(about, text) {
  notices.set(about, text);
  const shown = [...notices.values()].filter(Boolean);
  byId("notice").textContent = shown.join("\n");
  byId("notice").hidden = shown.length === 0;
  // Diagnostics point to a column of their excerpt.
  byId("notice").classList.toggle("diagnostic", shown.some((one) => one.includes("\n")));
}
