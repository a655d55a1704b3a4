// The timeline: which frame is shown, when the next one is due, at which speed, and between which marks.

// Highest speed of the shuttle keys, as a multiple of the speed of the run.
const MAX_SHUTTLE = 8;

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
    this.speed = 1; // of `play`; 1 is that of the run
    this.rate = 1; // the present one; negative plays backwards
    this.marks = [null, null]; // the in and the out point, where set
    this.next = null; // shown after the current one
    this.isBusy = false;
  }

  get last() {
    return this.cache.frames.length - 1;
  }

  // The first and the last frame to play.
  get range() {
    return [this.marks[0] ?? 0, Math.min(this.last, this.marks[1] ?? this.last)];
  }

  // Sets the in point (0) or the out point (1) to the shown frame; removes it if it is there already.
  mark(which) {
    const at = this.marks[which] === this.index ? null : this.index;
    this.marks[which] = at;
    const [first, end] = this.marks;
    if (first !== null && end !== null && first > end) {
      this.marks[1 - which] = null;
    }
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

  // Plays at a rate, by default forwards at the chosen speed.
  play(rate = this.speed) {
    const [first, last] = this.range;
    const isOutside = this.index < first || this.index > last || (rate > 0 ? this.index >= last : this.index <= first);
    const from = isOutside ? (rate > 0 ? first : last) : this.index;
    this.rate = rate;
    this.isPlaying = true;
    const head = rate < 0 ? 0.999 / this.cache.run.fps : 0; // a frame is shown for its whole time
    this.began = { clock: performance.now() / 1000, time: this.cache.time(from) + head };
    this.go(from);
  }

  pause() {
    this.isPlaying = false;
  }

  // Plays in a direction; each further call doubles the rate.
  shuttle(direction) {
    const isSame = this.isPlaying && Math.sign(this.rate) === direction;
    this.play(isSame ? direction * Math.min(MAX_SHUTTLE, Math.abs(this.rate) * 2) : direction * this.speed);
  }

  setSpeed(speed) {
    this.speed = speed;
    if (this.isPlaying) {
      this.play(Math.sign(this.rate) * speed);
    }
  }

  // Called at each screen refresh: shows the frame that is due. Late frames are skipped.
  tick() {
    if (!this.isPlaying || this.isBusy) {
      return;
    }
    const [first, last] = this.range;
    const begin = this.cache.time(first);
    const length = this.cache.time(last) - begin + 1 / this.cache.run.fps;
    const passed = this.began.time - begin + (performance.now() / 1000 - this.began.clock) * this.rate;
    if ((this.rate > 0 ? passed >= length : passed < 0) && !this.isLooping) {
      this.pause();
      this.go(this.rate > 0 ? last : first);
      return;
    }
    const due = Math.max(first, this.frameAt(begin + (((passed % length) + length) % length)));
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
