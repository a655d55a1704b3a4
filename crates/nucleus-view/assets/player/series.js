// The time series of a figure over all frames, of this run and of the other: labelled, zoomable, with the frames that had
// a contact problem behind it.

import { figure, figuresOf } from "./figures.js";

// Reports that are read at most in one view, because each frame must be unpacked.
const MAX_REPORTS = 240;
// Frames that a view shows at least.
const MIN_FRAMES = 4;

// Contact problems, drawn as bars behind the lines.
const PROBLEMS = [
  { key: "compressed", name: "points compressed", colour: "#e6761c60" },
  { key: "pairs_reverted", name: "pairs reverted", colour: "#c9a22750" },
  { key: "depenetrating", name: "points depenetrating", colour: "#b455c870" },
  { key: "intersections", name: "intersections", colour: "#ff6a5a80" },
  { key: "pairs_unresolved", name: "pairs unresolved", colour: "#ff2020c0" },
];
const OWN = "#e0574a";
const OTHER = "#6fa8dc";
const FAINT = "#949baa";

export class Series {
  // `onFigures` is called with the figures that the reports hold, when they become known; `onNow` with the values of both
  // runs at the shown frame, as texts.
  constructor(canvas, onFigures, onNow) {
    this.canvas = canvas;
    Object.assign(this, { onFigures, onNow });
    this.chosen = null; // the key of a figure, once one is chosen
    this.cache = null;
    this.marks = [null, null];
    window.addEventListener("resize", () => this.draw());
  }

  // Shows other runs. The figure stays, and so does the view if the run only grew.
  open(cache, other = null) {
    const isSame = this.cache?.run.scene === cache.run.scene && this.other === other;
    this.view = isSame && this.isZoomed ? this.view : null;
    [this.cache, this.other] = [cache, other];
    this.known = new Map(); // index of a frame to its report
    this.knownOther = new Map(); // the same for the other run, by the index of this one
    this.at = 0;
    this.fill();
  }

  // The key of the figure that is shown unless another is chosen. Particles alone have no strain.
  get usual() {
    const hasCloth = this.cache?.objects.some(({ topology }) => topology.kind === "cloth") ?? true;
    return hasCloth ? "max_strain" : "kinetic_energy";
  }

  get key() {
    return this.chosen ?? this.usual;
  }

  get last() {
    return Math.max(1, this.cache.frames.length - 1);
  }

  get isZoomed() {
    return Boolean(this.view);
  }

  // First and last frame of the view, by their indices; may be fractions.
  get range() {
    return this.view ?? [0, this.last];
  }

  choose(key) {
    this.chosen = key;
    this.draw();
  }

  // Zooms by a factor about a share of the width.
  zoom(factor, share) {
    const [from, to] = this.range;
    const width = Math.min(this.last, Math.max(MIN_FRAMES, (to - from) * factor));
    const middle = from + (to - from) * share;
    this.show(middle - width * share, width);
  }

  // Moves the view by a share of its width.
  pan(share) {
    const [from, to] = this.range;
    this.show(from + (to - from) * share, to - from);
  }

  show(from, width) {
    const begin = Math.min(this.last - width, Math.max(0, from));
    this.view = width >= this.last ? null : [begin, begin + width];
    this.fill();
  }

  // Reads the missing reports of the view one by one, with pauses in which the page is drawn. A later call takes over.
  async fill() {
    const turn = (this.turn = Symbol("fill"));
    const [from, to] = this.range.map(Math.round);
    const step = Math.max(1, Math.ceil((to - from + 1) / MAX_REPORTS));
    this.draw();
    for (let index = from; index <= Math.min(to, this.cache.frames.length - 1); index += step) {
      if (!this.known.has(index)) {
        await this.read(index);
        await new Promise((resolve) => setTimeout(resolve));
      }
      if (turn !== this.turn) {
        return;
      }
      if ((index - from) % (8 * step) === 0) {
        this.draw();
      }
    }
    this.onFigures(figuresOf([...this.known.values(), ...this.knownOther.values()]));
    this.draw();
    this.canvas.dataset.known = [...this.known.values()].filter(Boolean).length;
  }

  async read(index) {
    this.known.set(index, await this.cache.report(index).catch(() => null));
    if (this.other) {
      const twin = this.other.indexAt(this.cache.frameNumber(index));
      this.knownOther.set(index, twin === null ? null : await this.other.report(twin).catch(() => null));
    }
  }

  // Marks the shown frame, and the in and out points.
  mark(index, marks) {
    [this.at, this.marks] = [index, marks];
    this.draw();
  }

  // The index of the frame at a share of the width.
  indexAt(share) {
    const [from, to] = this.range;
    return Math.min(this.cache.frames.length - 1, Math.max(0, Math.round(from + (to - from) * share)));
  }

  // A description of the report of a frame.
  describe(index) {
    const { label, write } = figure(this.key);
    const said = (report, name) => Number.isFinite(report?.[this.key]) ? [`${name}${write(report[this.key])}`] : [];
    const found = [...said(this.known.get(index), `${label} `), ...said(this.knownOther.get(index), "other run ")];
    const problems = PROBLEMS.filter(({ key }) => this.known.get(index)?.[key] > 0);
    const counts = problems.map(({ key, name }) => `${this.known.get(index)[key]} ${name}`);
    return [`Frame ${this.cache.frameNumber(index)}`, ...found, ...counts].join(", ");
  }

  draw() {
    const { canvas } = this;
    if (!this.cache || canvas.clientHeight === 0) {
      return;
    }
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
    Object.assign(canvas, { width, height });
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    const area = { left: 0, width: canvas.clientWidth, top: 4, bottom: canvas.clientHeight - 15 };
    const values = (known, key) => [...known].map(([index, report]) => [index, report?.[key]])
      .filter(([, x]) => Number.isFinite(x)).sort(([a], [b]) => a - b);
    PROBLEMS.forEach(({ key, colour }) => this.bars(pen, area, values(this.known, key), colour));
    const lines = [[values(this.knownOther, this.key), OTHER], [values(this.known, this.key), OWN]];
    const [low, high] = this.scaleOf(lines.flatMap(([points]) => points));
    this.marksAndCursor(pen, area);
    lines.forEach(([points, colour]) => this.line(pen, area, points, colour, [low, high]));
    this.labels(pen, area, [low, high]);
  }

  // The lowest and the highest value in view; zero is in it, unless the values are far from it.
  scaleOf(points) {
    const [from, to] = this.range;
    const shown = points.filter(([index]) => index >= from - 1 && index <= to + 1).map(([, value]) => value);
    if (shown.length === 0) {
      return [0, 1];
    }
    const [low, high] = [Math.min(...shown), Math.max(...shown)];
    const begin = low > 0 && high < 4 * (high - low || high) ? 0 : low;
    return high > begin ? [begin, high] : [Math.min(0, low), Math.max(low, 0) || 1];
  }

  labels(pen, { left, width, top, bottom }, [low, high]) {
    const { write } = figure(this.key);
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "alphabetic";
    const text = (words, x, y, align) => {
      pen.textAlign = align;
      pen.lineWidth = 3;
      pen.strokeStyle = "#14171dd9";
      pen.strokeText(words, x, y);
      pen.fillStyle = FAINT;
      pen.fillText(words, x, y);
    };
    text(write(high), left + 2, top + 9, "left");
    text(write(low), left + 2, bottom - 2, "left");
    const [first, last] = this.range.map((index) => Math.round(index));
    const number = (index) => this.cache.frameNumber(Math.min(index, this.cache.frames.length - 1));
    for (const index of ticks(first, last, Math.max(2, Math.floor(width / 90)))) {
      const x = this.place(index, width);
      const align = x < 20 ? "left" : x > width - 20 ? "right" : "center";
      text(`${number(index)}`, x, bottom + 12, align);
      pen.fillStyle = "#ffffff20";
      pen.fillRect(x, top, 1, bottom - top);
    }
    this.onNow([this.known, this.knownOther].map((known) => {
      const value = known.get(this.at)?.[this.key];
      return Number.isFinite(value) ? write(value) : "";
    }));
  }

  // The height is logarithmic, so that one point is visible beside a thousand.
  bars(pen, { width, top, bottom }, points, colour) {
    const [from, to] = this.range;
    const barWidth = Math.max(2, width / Math.max(1, to - from));
    pen.fillStyle = colour;
    for (const [index, value] of points.filter(([, value]) => value > 0)) {
      const barHeight = (bottom - top) * Math.min(1, 0.22 + 0.2 * Math.log10(value));
      pen.fillRect(this.place(index, width) - barWidth / 2, bottom - barHeight, barWidth, barHeight);
    }
  }

  line(pen, { width, top, bottom }, points, colour, [low, high]) {
    pen.strokeStyle = colour;
    pen.lineWidth = 1.5;
    pen.beginPath();
    for (const [index, value] of points) {
      pen.lineTo(this.place(index, width), bottom - 1 - ((value - low) / (high - low)) * (bottom - top - 12));
    }
    pen.stroke();
  }

  marksAndCursor(pen, { width, top, bottom }) {
    const [first, end] = this.marks;
    pen.fillStyle = "#00000060";
    if (first !== null) {
      pen.fillRect(0, top, this.place(first, width), bottom - top);
    }
    if (end !== null) {
      pen.fillRect(this.place(end, width), top, width, bottom - top);
    }
    pen.fillStyle = "#ffffff90";
    pen.fillRect(this.place(this.at, width), top, 1, bottom - top);
  }

  place(index, width) {
    const [from, to] = this.range;
    return ((index - from) / Math.max(1e-9, to - from)) * (width - 1);
  }
}

// At most `most` round numbers from `first` to `last`, with both ends.
function ticks(first, last, most) {
  const rough = Math.max(1, (last - first) / most);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((step) => step >= rough) ?? rough;
  const inner = [];
  for (let at = Math.ceil((first + step * 0.5) / step) * step; at <= last - step * 0.5; at += step) {
    inner.push(Math.round(at));
  }
  return [first, ...inner, last];
}
