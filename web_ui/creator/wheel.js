// How far a wheel turns what is in hand: one step for each notch of a mouse, whatever a browser reports for one; the
// small distances of a touchpad add up. Pure.

/** Browsers report 100 to 120 pixels for a notch, fewer on a page that is zoomed; touchpads send much less at a time. */
const NOTCH_PX = 120;
const LEAST_NOTCH_PX = 50;
const PIXELS = 0; // WheelEvent.deltaMode; the others are lines and pages, which only wheels with notches send
const LINES_PER_NOTCH = 3;

export class WheelSteps {
  constructor() {
    /** Pixels of a touchpad that are no step yet. */
    this.rest = 0;
  }

  /** Whole steps that an event makes; positive: towards a person. @param {{ deltaY: number, deltaMode: number }} event */
  take({ deltaY, deltaMode }) {
    const far = Math.abs(deltaY);
    if (deltaMode !== PIXELS) return Math.sign(deltaY) * Math.max(1, Math.round(far / LINES_PER_NOTCH));
    if (far >= LEAST_NOTCH_PX) return Math.sign(deltaY) * Math.max(1, Math.round(far / NOTCH_PX));
    if (this.rest * deltaY < 0) this.rest = 0; // the other way
    this.rest += deltaY;
    const steps = Math.trunc(this.rest / NOTCH_PX);
    this.rest -= steps * NOTCH_PX;
    return steps;
  }
}
