// The timeline: which frame is shown and when the next one is due, and the curve of the reports of all frames.

export class Timeline {
  // `show(index, timeIndex)` shows a recorded time and resolves when it is drawn.
  constructor(cache, show) {
    this.cache = cache;
    this.show = show;
    this.index = 0;
    this.timeIndex = Infinity; // within the frame
    this.times = 1; // recorded in the frame
    this.isPlaying = false;
    this.isLooping = true;
    this.next = null; // shown after the current one
    this.isBusy = false;
  }

  get last() {
    return this.cache.frames.length - 1;
  }

  // Goes to a frame, by default to its end. While one is being shown, only the newest request is kept.
  async go(index, timeIndex = Infinity) {
    this.index = Math.min(this.last, Math.max(0, Math.round(index)));
    this.timeIndex = timeIndex;
    this.next = [this.index, timeIndex];
    if (this.isBusy) {
      return;
    }
    this.isBusy = true;
    try {
      while (this.next) {
        const request = this.next;
        this.next = null;
        await this.show(...request);
      }
    } finally {
      this.isBusy = false;
    }
  }

  step(frames) {
    this.pause();
    return this.go(this.index + frames);
  }

  // Before the first and after the last substep of a frame comes the adjacent frame.
  async stepSubstep(by) {
    this.pause();
    const timeIndex = Math.min(this.timeIndex, this.times - 1) + by;
    if (timeIndex >= 0 && timeIndex < this.times) {
      return this.go(this.index, timeIndex);
    }
    if (this.index + by < 0 || this.index + by > this.last) {
      return undefined;
    }
    return this.go(this.index + by, by > 0 ? 0 : Infinity);
  }

  toggle() {
    this.isPlaying ? this.pause() : this.play();
  }

  play() {
    const from = this.index >= this.last ? 0 : this.index;
    this.isPlaying = true;
    this.began = { clock: performance.now() / 1000, time: this.cache.time(from) };
    this.go(from);
  }

  pause() {
    this.isPlaying = false;
  }

  // Called at each screen refresh: shows the frame that is due. Late frames are skipped.
  tick() {
    if (!this.isPlaying || this.isBusy) {
      return;
    }
    const [first, end] = [this.cache.time(0), this.cache.time(this.last)];
    const length = end - first + 1 / this.cache.run.fps;
    const now = this.began.time - first + performance.now() / 1000 - this.began.clock;
    if (now >= length && !this.isLooping) {
      this.pause();
      this.go(this.last);
      return;
    }
    const due = this.frameAt(first + (now % length));
    if (due !== this.index) {
      this.go(due);
    }
  }

  // The last frame that ends at or before a time.
  frameAt(time) {
    let [low, high] = [0, this.last];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.cache.time(middle) <= time + 1e-6) {
        low = middle;
      } else {
        high = middle - 1;
      }
    }
    return low;
  }
}

// The curve reads at most this many reports, because each frame must be unpacked.
const MAX_REPORTS = 240;

// Contact problems, drawn as bars behind the lines.
const PROBLEMS = [
  { key: "compressed", name: "points compressed", colour: "#e6761c60" },
  { key: "pairs_reverted", name: "pairs reverted", colour: "#c9a22750" },
  { key: "depenetrating", name: "points depenetrating", colour: "#b455c870" },
  { key: "intersections", name: "intersections", colour: "#ff6a5a80" },
  { key: "pairs_unresolved", name: "pairs unresolved", colour: "#ff2020c0" },
];
const LINES = [
  ["max_strain", (x) => `strain ${(100 * x).toPrecision(3)} %`],
  ["min_gap", (x) => `gap ${x.toPrecision(3)}`],
  ["min_cloth_gap", (x) => `cloth-cloth gap ${x.toPrecision(3)}`],
  ["contacts", (x) => `${x} contacts`],
  ["touching", (x) => `${x} points touching`],
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

  // Reads the reports one by one, with pauses in which the page is drawn.
  async fill() {
    const { frames } = this.cache;
    const step = Math.max(1, Math.ceil(frames.length / MAX_REPORTS));
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

  // Marks the current frame.
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
    PROBLEMS.forEach(({ key, colour }) => this.bars(pen, values(key), colour));
    this.line(pen, values("max_strain"), "#e0574a");
    // At a gap ratio of 1 surfaces touch; larger ones are clamped to keep the scale.
    const gap = (key) => values(key).map(([index, gap]) => [index, Math.min(gap, 1.2)]);
    this.line(pen, gap("min_gap"), "#6fa8dc");
    this.line(pen, gap("min_cloth_gap"), "#7fc6a4");
    pen.fillStyle = "#ffffff90";
    pen.fillRect(this.place(this.at, width), 0, Math.max(1, ratio), height);
  }

  // A description of the report of a frame.
  describe(index) {
    const report = this.known.get(index);
    const found = LINES.filter(([key]) => Number.isFinite(report?.[key])).map(([key, write]) => write(report[key]));
    const problems = PROBLEMS.filter(({ key }) => report?.[key] > 0).map(({ key, name }) => `${report[key]} ${name}`);
    return [`Frame ${this.cache.frameNumber(index)}`, ...found, ...problems].join(", ");
  }

  // The height is logarithmic, so that one point is visible beside a thousand.
  bars(pen, points, colour) {
    const { width, height } = this.canvas;
    const barWidth = Math.max(2, width / Math.max(1, this.cache.frames.length - 1));
    pen.fillStyle = colour;
    for (const [index, value] of points.filter(([, value]) => value > 0)) {
      const barHeight = height * Math.min(1, 0.22 + 0.2 * Math.log10(value));
      pen.fillRect(this.place(index, width) - barWidth / 2, height - barHeight, barWidth, barHeight);
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
