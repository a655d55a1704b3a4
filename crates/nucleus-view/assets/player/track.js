// The cameras of the scene, as the cache has them: see camera.rs of the cache crate.

const MILLIMETRES = 25.4;

// Cameras by the order of their names, each { name, fit, views }; a view is 13 numbers.
export function readCameras(keys) {
  const cameras = [...(keys ?? new Map())].filter(([key]) => key.startsWith("camera ")).map(([key, text]) => {
    const [fit, ...lines] = text.split("\n");
    return { name: key.slice("camera ".length), fit, views: lines.map((line) => line.split(" ").map(Number)) };
  });
  return cameras.filter(({ views }) => views.length > 0 && views.every((view) => view.length === 13 && view.every(Number.isFinite)));
}

// What a camera sees so many frames after the start; between frames it goes straight.
export function viewAt({ views }, frames) {
  const place = Math.min(Math.max(0, frames), views.length - 1);
  const [before, after] = [views[Math.floor(place)], views[Math.ceil(place)]];
  const x = before.map((value, k) => value + (after[k] - value) * (place % 1));
  return {
    eye: x.slice(0, 3), forward: x.slice(3, 6), up: x.slice(6, 9),
    focalLength: x[9], film: x.slice(10, 12), interest: x[12],
  };
}

// Tangent of half the angle of view upward, in a picture `aspect` times as wide as it is high.
export function tangentOf({ focalLength, film }, fit, aspect) {
  const [across, upward] = film.map((side) => (0.5 * MILLIMETRES * side) / focalLength);
  const isWider = aspect > across / upward;
  const isByWidth = { horizontal: true, vertical: false, overscan: !isWider }[fit] ?? isWider;
  return isByWidth ? across / aspect : upward;
}
