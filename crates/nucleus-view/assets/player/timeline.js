// Which moment is shown, and when the next one is due.

export class Timeline {
  // `show(index, moment)` shows a moment and resolves when it is seen.
  constructor(cache, show) {
    this.cache = cache;
    this.show = show;
    this.index = 0;
    this.moment = Infinity;
    this.moments = 1;
    this.isPlaying = false;
    this.isLooping = true;
    this.wanted = null; // what to show when the present one has been shown
    this.isBusy = false;
  }

  get last() {
    return this.cache.frames.length - 1;
  }

  // Goes to a frame; to its end, if no moment is given. While one is on its way only the newest wish counts.
  async go(index, moment = Infinity) {
    this.index = Math.min(this.last, Math.max(0, Math.round(index)));
    this.moment = moment;
    this.wanted = [this.index, moment];
    if (this.isBusy) {
      return;
    }
    this.isBusy = true;
    try {
      while (this.wanted) {
        const wish = this.wanted;
        this.wanted = null;
        await this.show(...wish);
      }
    } finally {
      this.isBusy = false;
    }
  }

  step(frames) {
    this.pause();
    return this.go(this.index + frames);
  }

  // Past the first or last moment of a frame lies the next frame.
  async stepMoment(by) {
    this.pause();
    const moment = Math.min(this.moment, this.moments - 1) + by;
    if (moment >= 0 && moment < this.moments) {
      return this.go(this.index, moment);
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

  // Called at each screen refresh: shows what is due by now. Frames that came too late are skipped.
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
