// When frames are drawn: one at a time, only when something has changed, not too many, and one more in full resolution
// when everything has come to rest.

/** @typedef {import("./quality.js").Quality} Quality */

/** Nothing has moved for this long: the view rests. */
const REST_MS = 200;

export class FrameLoop {
  /**
   * @param {object} options
   * @param {Quality} options.quality
   * @param {(nowMs: number) => boolean} options.draw   returns whether something still moves
   * @param {() => void} options.resize                the resolution has changed
   */
  constructor({ quality, draw, resize }) {
    this.quality = quality;
    this.draw = draw;
    this.resize = resize;
    this.isRequested = false;
    this.restTimer = 0;
  }

  /** Request one frame; several calls before it have the effect of one. */
  invalidate() {
    if (this.isRequested) return;
    this.isRequested = true;
    requestAnimationFrame((nowMs) => this.#frame(nowMs));
  }

  /** @param {number} nowMs */
  #frame(nowMs) {
    this.isRequested = false;
    if (this.quality.isEarly(nowMs)) {
      this.invalidate();
      return;
    }
    window.clearTimeout(this.restTimer);
    const moving = this.draw(nowMs);
    if (moving) this.invalidate();
    if (this.quality.note(nowMs, moving)) this.resize();
    if (this.quality.isReduced) this.#sharpenLater(moving);
  }

  /** @param {boolean} moving */
  #sharpenLater(moving) {
    if (moving && this.quality.rest(false)) this.resize();
    if (moving || this.quality.isResting) return;
    this.restTimer = window.setTimeout(() => {
      if (this.quality.rest(true)) this.resize();
    }, REST_MS);
  }
}
