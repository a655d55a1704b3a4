// Vectors, matrices and the camera: it orbits a target (drag to orbit, shift or right button to pan, wheel to zoom), or
// follows a camera of the scene until it is moved.

// Vectors of three and matrices of four by four, in columns as WebGL reads them.
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const normalise = (a) => scale(a, 1 / (Math.hypot(...a) || 1));

export function multiply(a, b) {
  const product = new Float32Array(16);
  for (let column = 0; column < 4; column += 1) {
    for (let row = 0; row < 4; row += 1) {
      for (let k = 0; k < 4; k += 1) {
        product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
      }
    }
  }
  return product;
}

// The view matrix of an eye with these axes; `toward` points from the target to the eye.
export function view(eye, right, up, toward) {
  const row = (axis) => [...axis, -dot(axis, eye)];
  const [x, y, z] = [row(right), row(up), row(toward)];
  return new Float32Array([0, 1, 2, 3].flatMap((k) => [x[k], y[k], z[k], k === 3 ? 1 : 0]));
}

// `tangent` is the tangent of half the vertical field of view.
export function perspective(tangent, aspect, near, far) {
  const depth = 1 / (near - far);
  return new Float32Array([
    1 / (tangent * aspect), 0, 0, 0,
    0, 1 / tangent, 0, 0,
    0, 0, (near + far) * depth, -1,
    0, 0, 2 * near * far * depth, 0,
  ]);
}

// The orthographic projection of a cube around the origin, with half side `reach`, seen along -z.
export function orthographic(reach) {
  const s = 1 / reach;
  return new Float32Array([s, 0, 0, 0, 0, s, 0, 0, 0, 0, -s, 0, 0, 0, 0, 1]);
}

const MILLIMETRES = 25.4;

// The view of a camera, a number of frames after the start; interpolated linearly between frames.
export function viewAt({ views }, frames) {
  const place = Math.min(Math.max(0, frames), views.length - 1);
  const [before, after] = [views[Math.floor(place)], views[Math.ceil(place)]];
  const x = before.map((value, k) => value + (after[k] - value) * (place % 1));
  return {
    eye: x.slice(0, 3), forward: x.slice(3, 6), up: x.slice(6, 9),
    focalLength: x[9], film: x.slice(10, 12), interest: x[12],
  };
}

// Ratio of width to height of the pictures of `nucleus render`, unless it is given.
const RENDERED = 16 / 9;

// Tangent of half the vertical field of view in a window of any shape, which contains all that `nucleus render` shows.
export function windowTangent(followed, fit, aspect) {
  const rendered = tangentOf(followed, fit, RENDERED);
  return Math.max(rendered, (rendered * RENDERED) / aspect);
}

// Tangent of half the vertical field of view, in a picture of this ratio of width to height.
export function tangentOf({ focalLength, film }, fit, aspect) {
  const [across, upward] = film.map((side) => (0.5 * MILLIMETRES * side) / focalLength);
  const isWider = aspect > across / upward;
  const isByWidth = { horizontal: true, vertical: false, overscan: !isWider }[fit] ?? isWider;
  return isByWidth ? across / aspect : upward;
}

const TANGENT = Math.tan((30 * Math.PI) / 360);
const FILLED = 0.78; // fraction of the picture that a framed box may fill; panels cover the rest
const MAX_PITCH = 1.55; // radians
const CLICK = 4; // pixels that a pointer may move in a click

export class Camera {
  // `onClick` is called with the place of a click on the canvas in pixels, and whether shift was held.
  constructor(canvas, onChange, onClick) {
    this.target = [0, 0, 0];
    this.distance = 5;
    this.yaw = 0.57;
    this.pitch = 0.44;
    this.size = 1; // diagonal of the framed box; limits the zoom
    this.framed = null; // the box that fills the picture of any shape, until the camera is moved
    this.track = null; // the camera of the scene that is followed, if any
    this.frames = 0; // since the start of the run
    this.canvas = canvas;
    Object.assign(this, { onChange, onClick });
    this.listen();
  }

  get toward() {
    const level = Math.cos(this.pitch);
    return [Math.sin(this.yaw) * level, Math.sin(this.pitch), Math.cos(this.yaw) * level];
  }

  get right() {
    return [Math.cos(this.yaw), 0, -Math.sin(this.yaw)];
  }

  get eye() {
    if (this.track) {
      return viewAt(this.track, this.frames).eye;
    }
    return add(this.target, scale(this.toward, this.distance));
  }

  matrices(aspect) {
    return this.track ? this.trackMatrices(aspect) : this.orbitMatrices(aspect);
  }

  trackMatrices(aspect) {
    const followed = viewAt(this.track, this.frames);
    const toward = normalise(scale(followed.forward, -1));
    const right = normalise(cross(followed.up, toward));
    const far = Math.hypot(...subtract(this.target, followed.eye)) + this.size * 40;
    return {
      view: view(followed.eye, right, cross(toward, right), toward),
      projection: perspective(windowTangent(followed, this.track.fit, aspect), aspect, this.size * 5e-3, far),
    };
  }

  // Stops following the camera of the scene, at its position and without roll.
  leave() {
    if (!this.track) {
      return;
    }
    const { eye, forward, interest } = viewAt(this.track, this.frames);
    const distance = dot(subtract(this.target, eye), forward);
    this.distance = distance > 0 ? distance : interest;
    this.target = add(eye, scale(forward, this.distance));
    this.yaw = Math.atan2(-forward[0], -forward[2]);
    this.pitch = Math.min(MAX_PITCH, Math.max(-MAX_PITCH, Math.asin(Math.min(1, Math.max(-1, -forward[1])))));
    this.track = this.framed = null;
    this.onChange();
  }

  orbitMatrices(aspect) {
    if (this.framed && this.framed.aspect !== aspect) {
      this.fit(aspect);
    }
    const up = cross(this.toward, this.right);
    const near = Math.max(this.distance * 0.02, this.size * 1e-3);
    return {
      view: view(this.eye, this.right, up, this.toward),
      projection: perspective(TANGENT, aspect, near, this.distance + this.size * 40),
    };
  }

  // Sets the size of the box that is shown, to which the clipping planes and the zoom are fitted.
  measure({ low, high }) {
    this.size = Math.max(Math.hypot(...subtract(high, low)), 1e-6);
  }

  // Sets target and distance so that the box fills the picture, also when the window changes its shape.
  frame({ low, high }, aspect) {
    this.track = null;
    this.target = scale(add(low, high), 0.5);
    this.measure({ low, high });
    this.framed = { low, high };
    this.fit(aspect);
    this.onChange();
  }

  // Sets the distance at which the framed box fills a picture of this shape.
  fit(aspect) {
    const { low, high } = this.framed;
    const [right, up, toward] = [this.right, normalise(cross(this.toward, this.right)), this.toward];
    this.framed.aspect = aspect;
    this.distance = this.size * 0.05;
    for (let corner = 0; corner < 8; corner += 1) {
      const at = [0, 1, 2].map((axis) => ((corner >> axis) & 1 ? high : low)[axis]);
      const offset = subtract(at, this.target);
      const sides = [Math.abs(dot(offset, right)) / aspect, Math.abs(dot(offset, up))];
      this.distance = Math.max(this.distance, Math.max(...sides) / (TANGENT * FILLED) + dot(offset, toward));
    }
  }

  orbit(dx, dy) {
    this.framed = null;
    this.yaw -= dx * 0.008;
    this.pitch = Math.min(MAX_PITCH, Math.max(-MAX_PITCH, this.pitch + dy * 0.008));
  }

  pan(dx, dy) {
    this.framed = null;
    const perPixel = (2 * TANGENT * this.distance) / this.canvas.clientHeight;
    const up = cross(this.toward, this.right);
    this.target = add(this.target, add(scale(this.right, -dx * perPixel), scale(up, dy * perPixel)));
  }

  zoom(steps) {
    this.framed = null;
    const distance = this.distance * Math.exp(steps * 0.0012);
    this.distance = Math.min(this.size * 50, Math.max(this.size * 0.01, distance));
  }

  listen() {
    const { canvas } = this;
    const fingers = new Map();
    let pressed = null; // the press that may become a click
    const lift = (event) => {
      pressed = null;
      fingers.delete(event.pointerId);
    };
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
      pressed = fingers.size === 1 && event.button === 0 ? event : null;
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      const isClick = pressed && Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) <= CLICK;
      if (before && !isClick) {
        pressed = null;
        this.leave();
        this.drag(fingers, before, event);
        fingers.set(event.pointerId, event);
        this.onChange();
      }
    });
    canvas.addEventListener("pointerup", (event) => {
      const { left, top } = canvas.getBoundingClientRect();
      pressed && this.onClick([event.clientX - left, event.clientY - top], event.shiftKey);
      lift(event);
    });
    canvas.addEventListener("pointercancel", lift);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.leave();
      this.zoom(event.deltaY * (event.deltaMode === 0 ? 1 : 16));
      this.onChange();
    }, { passive: false });
  }

  // Two fingers pan and pinch, one orbits.
  drag(fingers, before, now) {
    const [dx, dy] = [now.clientX - before.clientX, now.clientY - before.clientY];
    const other = [...fingers.values()].find(({ pointerId }) => pointerId !== now.pointerId);
    if (other) {
      const gap = (finger) => Math.hypot(finger.clientX - other.clientX, finger.clientY - other.clientY);
      this.zoom((gap(before) - gap(now)) * 4);
      this.pan(dx / 2, dy / 2);
    } else if (now.shiftKey || now.buttons & 6) {
      this.pan(dx, dy);
    } else {
      this.orbit(dx, dy);
    }
  }
}
