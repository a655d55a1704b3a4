// Largest strain, smallest gap and what went wrong with contact over the frames, drawn as they become known.

// A run of more frames is looked at in this many places: each must be unpacked.
const MOST = 240;

// What stands behind the lines as bars: the rungs on which contact needed more than a push.
const TROUBLES = [
  { key: "pinched", name: "pinched", colour: "#e6761c60" },
  { key: "pairs_reverted", name: "pairs reverted", colour: "#c9a22750" },
  { key: "depenetrating", name: "depenetrating", colour: "#b455c870" },
  { key: "intersections", name: "intersections", colour: "#ff6a5a80" },
  { key: "pairs_unresolved", name: "pairs unresolved", colour: "#ff2020c0" },
];
const LINES = [
  ["max_strain", (x) => `strain ${(100 * x).toPrecision(3)} %`],
  ["min_gap", (x) => `gap ${x.toPrecision(3)}`],
  ["min_cloth_gap", (x) => `gap among cloths ${x.toPrecision(3)}`],
  ["contacts", (x) => `${x} contacts`],
  ["touching", (x) => `${x} points touch`],
];

export class Curve {
  constructor(canvas, cache) {
    this.canvas = canvas;
    this.cache = cache;
    this.known = new Map(); // index of a frame to its report
    this.at = 0;
    this.isStale = false;
    window.addEventListener("resize", () => this.draw());
  }

  // Looks at the reports one by one, with pauses in which the picture is drawn.
  async fill() {
    const { frames } = this.cache;
    const step = Math.max(1, Math.ceil(frames.length / MOST));
    for (let index = 0; index < frames.length; index += step) {
      const report = await this.cache.report(index).catch(() => null);
      if (report) {
        this.known.set(index, report);
      }
      if (index % (8 * step) === 0) {
        this.draw();
      }
      await new Promise((resolve) => setTimeout(resolve));
    }
    this.draw();
    this.canvas.dataset.known = this.known.size;
  }

  // The frame that is shown.
  mark(index) {
    this.at = index;
    this.draw();
  }

  draw() {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
    Object.assign(canvas, { width, height });
    const pen = canvas.getContext("2d");
    pen.lineWidth = ratio;
    const values = (key) => [...this.known].map(([index, report]) => [index, report[key]]).filter(([, x]) => Number.isFinite(x));
    TROUBLES.forEach(({ key, colour }) => this.bars(pen, values(key), colour));
    this.line(pen, values("max_strain"), "#e0574a");
    // A gap of one is a touch: of more, nothing is to be seen.
    const gap = (key) => values(key).map(([index, gap]) => [index, Math.min(gap, 1.2)]);
    this.line(pen, gap("min_gap"), "#6fa8dc");
    this.line(pen, gap("min_cloth_gap"), "#7fc6a4");
    pen.fillStyle = "#ffffff90";
    pen.fillRect(this.place(this.at, width), 0, Math.max(1, ratio), height);
  }

  // What is known of the frame nearest to a place along the curve, in words.
  tell(index) {
    const report = this.known.get(index);
    const found = LINES.filter(([key]) => Number.isFinite(report?.[key])).map(([key, write]) => write(report[key]));
    const troubles = TROUBLES.filter(({ key }) => report?.[key] > 0).map(({ key, name }) => `${report[key]} ${name}`);
    return [`Frame ${this.cache.frameNumber(index)}`, ...found, ...troubles].join(", ");
  }

  // Rises with the logarithm: a single point must be seen beside a thousand.
  bars(pen, points, colour) {
    const { width, height } = this.canvas;
    const wide = Math.max(2, width / Math.max(1, this.cache.frames.length - 1));
    pen.fillStyle = colour;
    for (const [index, value] of points.filter(([, value]) => value > 0)) {
      const tall = height * Math.min(1, 0.22 + 0.2 * Math.log10(value));
      pen.fillRect(this.place(index, width) - wide / 2, height - tall, wide, tall);
    }
  }

  line(pen, points, colour) {
    const { width, height } = this.canvas;
    const top = Math.max(1e-9, ...points.map(([, value]) => value));
    pen.strokeStyle = colour;
    pen.beginPath();
    for (const [index, value] of points) {
      pen.lineTo(this.place(index, width), height - 1.5 - (value / top) * (height - 3));
    }
    pen.stroke();
  }

  place(index, width) {
    return (index / Math.max(1, this.cache.frames.length - 1)) * (width - 1);
  }
}
