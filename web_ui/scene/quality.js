// Chooses how much is drawn. On a graphics card, everything. In software, what costs least to do without goes first:
// half of the frames, then soft glows, then resolution; resolution is full again as soon as nothing moves. Pure.

/** @typedef {{ pixelRatio: number, framesPerSecond: number, hasGlows: boolean }} Level */

const EVERY = Infinity;

/** From everything to little. */
export const LEVELS = /** @type {readonly Level[]} */ ([
  { pixelRatio: 2, framesPerSecond: EVERY, hasGlows: true },
  { pixelRatio: 1, framesPerSecond: EVERY, hasGlows: true },
  { pixelRatio: 1, framesPerSecond: 30, hasGlows: true },
  { pixelRatio: 1, framesPerSecond: 30, hasGlows: false },
  { pixelRatio: 0.87, framesPerSecond: 30, hasGlows: false },
  { pixelRatio: 0.75, framesPerSecond: 30, hasGlows: false },
]);
const HALF = /** @type {Level} */ ({ pixelRatio: 0.5, framesPerSecond: EVERY, hasGlows: true });

/** Choices of the user: automatic, or a fixed level. */
export const QUALITIES = /** @type {Readonly<Record<string, Level | null>>} */ ({
  auto: null,
  fine: LEVELS[0],
  medium: LEVELS[1],
  simple: HALF,
});

/** Minimum width of a saved image, and the maximum side that every graphics card supports. */
const PICTURE_WIDTH = 1920;
const LONGEST_PICTURE = 4096;

/**
 * Pixels per CSS pixel of a saved image, independent of the current quality.
 *
 * @param {{ width: number, height: number }} size  of the view in CSS pixels
 * @param {number} devicePixelRatio
 * @param {number} [scale]
 */
export function pictureRatio({ width, height }, devicePixelRatio, scale = 1) {
  const wanted = scale * Math.max(devicePixelRatio, PICTURE_WIDTH / width);
  return Math.min(wanted, LONGEST_PICTURE / Math.max(width, height));
}

/** Every frame is drawn as long as there are more than these. */
const SMOOTH_FPS = 36;
/** Above the halved rate there is nothing to gain, below this more is left out. */
const SLOWEST_FPS = 24;
const WINDOW = 24;
/** A longer gap means that there was nothing to draw. */
const IDLE_MS = 1500;
/** A frame may come this much early: frames of the screen are not exactly regular. */
const EARLY_MS = 5;

export class Quality {
  /** @param {{ isSoftware: boolean }} how */
  constructor({ isSoftware }) {
    this.isSoftware = isSoftware;
    this.first = isSoftware ? 1 : 0;
    this.level = this.first;
    this.choice = "auto";
    /** @type {number[]} */ this.intervals = [];
    /** @type {number | null} */ this.lastMs = null;
    /** Whether the first measuring window is over, which is ignored because it includes the start of the page. */
    this.isWarm = false;
    /** Whether nothing moves. */
    this.isResting = false;
  }

  /** @param {string} choice  one of `QUALITIES` */
  choose(choice) {
    if (QUALITIES[choice] === undefined) return;
    this.choice = choice;
    this.level = this.first;
    this.intervals = [];
  }

  /** Ignore the next frame for the measurement. */
  forget() {
    this.lastMs = null;
  }

  /** Whether the resolution is less than it is at rest. */
  get isReduced() {
    return this.choice === "auto" && LEVELS[this.level].pixelRatio < LEVELS[this.first].pixelRatio;
  }

  /** What to draw with now. */
  get settings() {
    const chosen = QUALITIES[this.choice] ?? LEVELS[this.level];
    return this.isResting && this.isReduced ? { ...chosen, pixelRatio: LEVELS[this.first].pixelRatio } : chosen;
  }

  /** Nothing has moved for a moment, or something moves again; returns whether the resolution changes. @param {boolean} isResting */
  rest(isResting) {
    const before = this.settings.pixelRatio;
    this.isResting = isResting;
    return this.settings.pixelRatio !== before;
  }

  /** Whether it is too early for the next frame. @param {number} nowMs */
  isEarly(nowMs) {
    return this.lastMs !== null && nowMs - this.lastMs < 1000 / this.settings.framesPerSecond - EARLY_MS;
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
    const enough = LEVELS[this.level].framesPerSecond === EVERY ? SMOOTH_FPS : SLOWEST_FPS;
    if (this.choice !== "auto" || !this.isSoftware) return false;
    if (mean <= 1000 / enough || this.level === LEVELS.length - 1) return false;
    this.level += 1;
    return true;
  }
}
