// Chooses the drawing quality: lowers it by one level when frames are too slow, and never raises it by itself
// (constant changes of sharpness are worse than a plain image). Pure.

/** @typedef {{ pixelRatio: number }} Level */

/** From fine to simple; the pixel ratio costs most (docs/performance.md, "The page"). */
export const LEVELS = /** @type {readonly Level[]} */ ([
  { pixelRatio: 2 },
  { pixelRatio: 1 },
  { pixelRatio: 0.7 },
  { pixelRatio: 0.5 },
]);

/** Choices of the user: automatic, or a fixed level. */
export const QUALITIES = /** @type {Readonly<Record<string, number | null>>} */ ({ auto: null, fine: 0, medium: 1, simple: 3 });

/** Minimum width of a saved image, and the maximum side that every graphics card supports. */
const PICTURE_WIDTH = 1920;
const LONGEST_PICTURE = 4096;

/**
 * Pixels per CSS pixel of a saved image, independent of the current quality.
 *
 * @param {{ width: number, height: number }} size  of the view in CSS pixels
 * @param {number} devicePixelRatio
 */
export function pictureRatio({ width, height }, devicePixelRatio) {
  const wanted = Math.max(devicePixelRatio, PICTURE_WIDTH / width);
  return Math.min(wanted, LONGEST_PICTURE / Math.max(width, height));
}

const SLOWEST_FPS = 15;
const WINDOW = 24;
/** A longer gap means that there was nothing to draw. */
const IDLE_MS = 1500;

export class Quality {
  /** @param {number} level initial index in `LEVELS` */
  constructor(level) {
    this.first = level;
    this.level = level;
    this.choice = "auto";
    /** @type {number[]} */ this.intervals = [];
    /** @type {number | null} */ this.lastMs = null;
    /** Whether the first measuring window is over, which is ignored because it includes the start of the page. */
    this.isWarm = false;
  }

  /** @param {string} choice  one of `QUALITIES` */
  choose(choice) {
    const level = QUALITIES[choice];
    if (level === undefined) return;
    this.choice = choice;
    this.level = level ?? this.first;
    this.intervals = [];
  }

  /** Ignore the next frame for the measurement. */
  forget() {
    this.lastMs = null;
  }

  /** The settings of the level. */
  get settings() {
    return LEVELS[this.level];
  }

  /**
   * Record a drawn frame; returns whether the level has just changed. `ongoing`: another frame follows immediately.
   *
   * @param {number} nowMs
   * @param {boolean} ongoing
   */
  note(nowMs, ongoing) {
    if (this.lastMs !== null && nowMs - this.lastMs < IDLE_MS) this.intervals.push(nowMs - this.lastMs);
    this.lastMs = ongoing ? nowMs : null;
    if (this.intervals.length < WINDOW) return false;
    const mean = this.intervals.reduce((sum, value) => sum + value, 0) / this.intervals.length;
    this.intervals = [];
    if (!this.isWarm) {
      this.isWarm = true;
      return false;
    }
    if (this.choice !== "auto") return false;
    if (mean <= 1000 / SLOWEST_FPS || this.level === LEVELS.length - 1) return false;
    this.level += 1;
    return true;
  }
}
