// Largest strain and smallest gap over the frames, drawn as they become known.

// A run of more frames is looked at in this many places: each must be unpacked.
const MOST = 240;

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
    this.line(pen, values("max_strain"), 0, "#e0574a");
    // A gap of one is a touch: of more, nothing is to be seen.
    this.line(pen, values("min_gap").map(([index, gap]) => [index, Math.min(gap, 1.2)]), 0, "#6fa8dc");
    pen.fillStyle = "#ffffff90";
    pen.fillRect(this.place(this.at, width), 0, Math.max(1, ratio), height);
  }

  line(pen, points, from, colour) {
    const { width, height } = this.canvas;
    const top = Math.max(1e-9, ...points.map(([, value]) => value));
    pen.strokeStyle = colour;
    pen.beginPath();
    for (const [index, value] of points) {
      pen.lineTo(this.place(index, width), height - 1.5 - ((value - from) / (top - from)) * (height - 3));
    }
    pen.stroke();
  }

  place(index, width) {
    return (index / Math.max(1, this.cache.frames.length - 1)) * (width - 1);
  }
}
