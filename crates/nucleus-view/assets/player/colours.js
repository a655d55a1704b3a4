// Colours of objects and of strain, linear, the same as in still pictures.

const CLOTHS = [
  [0.5, 0.085, 0.07], [0.065, 0.21, 0.38], [0.66, 0.37, 0.07],
  [0.07, 0.3, 0.22], [0.4, 0.18, 0.42], [0.3, 0.42, 0.12],
];
const COLLIDERS = [[0.3, 0.3, 0.295], [0.25, 0.27, 0.29], [0.33, 0.3, 0.26]];

// From -1, shorter, over 0 to +1, longer.
export const STRAIN = [
  [0.02, 0.12, 0.42], [0.18, 0.46, 0.66], [0.72, 0.71, 0.67], [0.86, 0.42, 0.13], [0.52, 0.02, 0.05],
];

// How contact stands at a point, by the byte that the cache has for it.
export const RUNGS = ["free", "touching", "pinched", "trapped", "tangled"];
export const RUNG_COLOURS = [
  [0.45, 0.45, 0.43], [0.07, 0.3, 0.62], [0.9, 0.42, 0.03], [0.5, 0.03, 0.5], [0.7, 0.01, 0.02],
];

// Gives each object its colour: cloths by their order among cloths, colliders likewise.
export function objectColours(objects) {
  const counts = { cloth: 0, collider: 0 };
  return objects.map(({ topology }) => {
    const group = topology.kind === "collider" ? "collider" : "cloth";
    const colours = group === "collider" ? COLLIDERS : CLOTHS;
    counts[group] += 1;
    return colours[(counts[group] - 1) % colours.length];
  });
}

// A linear colour as the page's style sheet takes it.
export function css(colour) {
  return `rgb(${colour.map((x) => Math.round(255 * Math.sqrt(Math.min(1, x)))).join(" ")})`;
}
