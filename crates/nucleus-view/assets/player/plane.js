// The ground plane: level or tilted, as a point and a unit normal to the side of the objects.

import { add, cross, dot, normalise, scale, subtract } from "./camera.js";

// A plane from the numbers of a point and a normal; null if there is none.
export function planeOf(text) {
  const numbers = (text ?? "").split(" ").map(Number);
  const [origin, normal] = [numbers.slice(0, 3), numbers.slice(3)];
  const isPlane = numbers.length === 6 && numbers.every(Number.isFinite) && Math.hypot(...normal) > 0;
  return isPlane ? { origin, normal: normalise(normal) } : null;
}

export const levelPlane = (height) => ({ origin: [0, height, 0], normal: [0, 1, 0] });

// The plane at a share of the way from one plane to another; null if either is missing.
export function planeAt(from, to, share) {
  if (!from || !to) {
    return null;
  }
  const mix = (a, b) => add(scale(a, 1 - share), scale(b, share));
  return { origin: mix(from.origin, to.origin), normal: normalise(mix(from.normal, to.normal)) };
}

// The point of the plane that is nearest to a point.
export const foot = ({ origin, normal }, point) => subtract(point, scale(normal, dot(subtract(point, origin), normal)));

// Directions of the grid lines in the plane: X and Z where it is level.
export function axesOf({ normal }) {
  const toward = Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 0, 1];
  const across = normalise(subtract(toward, scale(normal, dot(toward, normal))));
  return [across, cross(across, normal)];
}
