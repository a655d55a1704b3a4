// An eye that goes round a target: drag to orbit, shift or right button to pan, wheel to zoom. Or a camera of the scene,
// until one of these is done.

import { tangentOf, viewAt } from "./track.js";
import { add, cross, dot, normalise, perspective, scale, subtract, view } from "./matrix.js";

const TANGENT = Math.tan((30 * Math.PI) / 360);
const FILLED = 0.78; // the share of the picture that a framed box may fill; panels lie over the rest
const STEEPEST = 1.55;

export class Camera {
  constructor(canvas, onChange) {
    this.target = [0, 0, 0];
    this.distance = 5;
    this.yaw = 0.57;
    this.pitch = 0.44;
    this.size = 1; // of what was framed; limits how near and far one may go
    this.track = null; // the camera of the scene that is looked through
    this.frames = 0; // since the start of the run
    this.canvas = canvas;
    this.onChange = onChange;
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
    return this.track ? this.matricesOfTrack(aspect) : this.ownMatrices(aspect);
  }

  matricesOfTrack(aspect) {
    const seen = viewAt(this.track, this.frames);
    const toward = normalise(scale(seen.forward, -1));
    const right = normalise(cross(seen.up, toward));
    const far = Math.hypot(...subtract(this.target, seen.eye)) + this.size * 40;
    return {
      view: view(seen.eye, right, cross(toward, right), toward),
      projection: perspective(tangentOf(seen, this.track.fit, aspect), aspect, this.size * 5e-3, far),
    };
  }

  // Leaves the camera of the scene and stays where it was, level.
  leave() {
    if (!this.track) {
      return;
    }
    const { eye, forward, interest } = viewAt(this.track, this.frames);
    const ahead = dot(subtract(this.target, eye), forward);
    this.distance = ahead > 0 ? ahead : interest;
    this.target = add(eye, scale(forward, this.distance));
    this.yaw = Math.atan2(-forward[0], -forward[2]);
    this.pitch = Math.min(STEEPEST, Math.max(-STEEPEST, Math.asin(Math.min(1, Math.max(-1, -forward[1])))));
    this.track = null;
    this.onChange();
  }

  ownMatrices(aspect) {
    const up = cross(this.toward, this.right);
    const near = Math.max(this.distance * 0.02, this.size * 1e-3);
    return {
      view: view(this.eye, this.right, up, this.toward),
      projection: perspective(TANGENT, aspect, near, this.distance + this.size * 40),
    };
  }

  // Moves back or near until the box fills the picture.
  frame({ low, high }, aspect) {
    this.track = null;
    this.target = scale(add(low, high), 0.5);
    this.size = Math.max(Math.hypot(...subtract(high, low)), 1e-6);
    const [right, up, toward] = [this.right, normalise(cross(this.toward, this.right)), this.toward];
    this.distance = this.size * 0.05;
    for (let corner = 0; corner < 8; corner += 1) {
      const at = [0, 1, 2].map((axis) => ((corner >> axis) & 1 ? high : low)[axis]);
      const offset = subtract(at, this.target);
      const sides = [Math.abs(dot(offset, right)) / aspect, Math.abs(dot(offset, up))];
      this.distance = Math.max(this.distance, Math.max(...sides) / (TANGENT * FILLED) + dot(offset, toward));
    }
    this.onChange();
  }

  orbit(dx, dy) {
    this.yaw -= dx * 0.008;
    this.pitch = Math.min(STEEPEST, Math.max(-STEEPEST, this.pitch + dy * 0.008));
  }

  pan(dx, dy) {
    const perPixel = (2 * TANGENT * this.distance) / this.canvas.clientHeight;
    const up = cross(this.toward, this.right);
    this.target = add(this.target, add(scale(this.right, -dx * perPixel), scale(up, dy * perPixel)));
  }

  zoom(steps) {
    const distance = this.distance * Math.exp(steps * 0.0012);
    this.distance = Math.min(this.size * 50, Math.max(this.size * 0.01, distance));
  }

  listen() {
    const { canvas } = this;
    const fingers = new Map();
    const lift = (event) => fingers.delete(event.pointerId);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (before) {
        this.leave();
        this.drag(fingers, before, event);
        fingers.set(event.pointerId, event);
        this.onChange();
      }
    });
    canvas.addEventListener("pointerup", lift);
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
