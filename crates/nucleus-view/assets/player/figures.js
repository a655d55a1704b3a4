// The figures of a report: label, unit, format, and which values are a problem.

const percent = (x) => `${(x * 100).toFixed(Math.abs(x) < 0.0995 ? 2 : 1)} %`;
export const plain = (x) => (Number.isInteger(x) ? x.toLocaleString("en") : x.toPrecision(4));
// The smallest of 1, 2, 5, 10 ... that is not below a number.
export function roundUp(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= x * 0.999) ?? x;
}

const ratio = (x) => x.toFixed(3);
const some = (x) => x > 0;
const negative = (x) => x < 0;

// Of interest to developers of the solver: shown behind a fold.
const INTERNAL = true;

const FIGURES = {
  max_strain: ["Largest strain", percent],
  strain_99: ["Strain, 99 %", percent],
  min_gap: ["Smallest gap / thickness", ratio, negative],
  min_cloth_gap: ["Smallest cloth-cloth gap / thickness", ratio, negative],
  touching: ["Points touching", plain],
  compressed: ["Points compressed", plain, some],
  pairs_unresolved: ["Pairs unresolved", plain, some],
  depenetrating: ["Points depenetrating", plain, some],
  intersections: ["Edges intersecting", plain, some],
  kinetic_energy: ["Kinetic energy, J", plain],
  particles: ["Particles of emitters", plain],
  births: ["Particles emitted", plain],
  deaths: ["Particles that died", plain],
  births_refused: ["Particles not emitted", plain, some],
  density_error: ["Liquid volume error", percent],
  broken_links: ["Links broken", plain],
  max_weld_gap: ["Largest weld gap, m", plain],
  contacts: ["Contacts", plain, null, INTERNAL],
  candidate_pairs: ["Candidate pairs", plain, null, INTERNAL],
  broad_phases: ["Broad phases", plain, null, INTERNAL],
  pairs_reverted: ["Pairs reverted", plain, some, INTERNAL],
  rest_limited: ["Rest-limited pairs", plain, null, INTERNAL],
  sanitized: ["Input values replaced", plain, some, INTERNAL],
};

// What is not a figure of the simulation.
const HIDDEN = ["frame"];

// The figure of a key; one that this page does not know is an internal.
export function figure(key) {
  const [label, write, isBad, isInternal] = FIGURES[key] ?? [key.replaceAll("_", " "), plain, null, INTERNAL];
  return { key, label, write, isBad: isBad ?? (() => false), isInternal: Boolean(isInternal) };
}

// The figures that some of the reports hold as numbers, in the order of the table above.
export function figuresOf(reports) {
  const held = new Set();
  for (const report of reports) {
    Object.keys(report ?? {}).filter((key) => typeof report[key] === "number").forEach((key) => held.add(key));
  }
  const keys = [...Object.keys(FIGURES), ...held].filter((key, k, all) => held.has(key) && all.indexOf(key) === k);
  return keys.filter((key) => !HIDDEN.includes(key)).map(figure);
}
