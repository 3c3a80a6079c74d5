// Chooses how finely to draw: goes one level down when frames come too slowly, never up by itself
// (a picture that keeps changing its sharpness is worse than a plain one). Pure.

/** @typedef {{ pixelRatio: number }} Level */

/** From fine to simple; the pixel ratio costs most (docs/performance.md, "The page"). */
export const LEVELS = /** @type {readonly Level[]} */ ([
  { pixelRatio: 2 },
  { pixelRatio: 1 },
  { pixelRatio: 0.7 },
  { pixelRatio: 0.5 },
]);

/** What a person may choose: by itself, or a level and no other. */
export const QUALITIES = /** @type {Readonly<Record<string, number | null>>} */ ({ auto: null, fine: 0, medium: 1, simple: 3 });

/** A saved picture is at least so wide, and on neither side longer than what every graphics card draws. */
const PICTURE_WIDTH = 1920;
const LONGEST_PICTURE = 4096;

/**
 * Pixels per CSS pixel of a saved picture, whatever the view is drawn with.
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
/** A longer gap means that nothing had to be drawn. */
const IDLE_MS = 1500;

export class Quality {
  /** @param {number} level index in `LEVELS` to begin with */
  constructor(level) {
    this.first = level;
    this.level = level;
    this.choice = "auto";
    /** @type {number[]} */ this.intervals = [];
    /** @type {number | null} */ this.lastMs = null;
    /** The first window is the page's own start, and no measure. */
    this.settled = false;
  }

  /** @param {string} choice  one of `QUALITIES` */
  choose(choice) {
    const level = QUALITIES[choice];
    if (level === undefined) return;
    this.choice = choice;
    this.level = level ?? this.first;
    this.intervals = [];
  }

  /** What is drawn next is no measure. */
  forget() {
    this.lastMs = null;
  }

  /** The level's settings. */
  get settings() {
    return LEVELS[this.level];
  }

  /**
   * Note a drawn frame; true when the level has just changed. `ongoing`: another frame follows at once.
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
    if (!this.settled) {
      this.settled = true;
      return false;
    }
    if (this.choice !== "auto") return false;
    if (mean <= 1000 / SLOWEST_FPS || this.level === LEVELS.length - 1) return false;
    this.level += 1;
    return true;
  }
}
