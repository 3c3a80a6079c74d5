// When frames are drawn: one at a time, only when something has changed, not too many, and one more in full resolution
// when everything has come to rest.

/** @typedef {import("./quality.js").Quality} Quality */

/** Nothing has moved for this long: the view rests. */
const REST_MS = 200;

export class FrameLoop {
  /**
   * @param {object} options
   * @param {Quality} options.quality
   * @param {(nowMs: number) => boolean} options.draw   with the settings of the quality; returns whether something still
   *   moves
   */
  constructor({ quality, draw }) {
    this.quality = quality;
    this.draw = draw;
    this.isRequested = false;
    /** @type {number | null} while nothing moves and it is not yet called rest */ this.restTimer = null;
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
    const moving = this.draw(nowMs);
    const isLess = this.quality.note(nowMs, moving);
    if (moving || isLess) this.invalidate();
    this.#rest(!moving);
  }

  /** Resolution is less only while something moves. Messages that move nothing do not put rest off. @param {boolean} isStill */
  #rest(isStill) {
    if (!isStill) {
      if (this.restTimer !== null) window.clearTimeout(this.restTimer);
      this.restTimer = null;
      if (this.quality.rest(false)) this.invalidate();
    } else if (this.restTimer === null && this.quality.isReduced && !this.quality.isResting) {
      this.restTimer = window.setTimeout(() => {
        this.restTimer = null;
        if (this.quality.rest(true)) this.invalidate();
      }, REST_MS);
    }
  }
}
