// Converts wheel events to turning steps: one per notch of a mouse, whatever the browser reports for it; the small
// distances of a touchpad are accumulated. Pure.

/** Browsers report 100 to 120 pixels per notch, fewer on a zoomed page; touchpads send many smaller events. */
const NOTCH_PX = 120;
const LEAST_NOTCH_PX = 50;
const PIXELS = 0; // WheelEvent.deltaMode; lines and pages are sent only by wheels with notches
const LINES_PER_NOTCH = 3;

export class WheelSteps {
  constructor() {
    /** Accumulated touchpad pixels, less than a step. */
    this.rest = 0;
  }

  /**
   * Add an event; returns the whole steps that it completes. Positive: toward the user.
   *
   * @param {{ deltaY: number, deltaMode: number }} event
   */
  add({ deltaY, deltaMode }) {
    const far = Math.abs(deltaY);
    if (deltaMode !== PIXELS) return Math.sign(deltaY) * Math.max(1, Math.round(far / LINES_PER_NOTCH));
    if (far >= LEAST_NOTCH_PX) return Math.sign(deltaY) * Math.max(1, Math.round(far / NOTCH_PX));
    if (this.rest * deltaY < 0) this.rest = 0; // direction reversed
    this.rest += deltaY;
    const steps = Math.trunc(this.rest / NOTCH_PX);
    this.rest -= steps * NOTCH_PX;
    return steps;
  }
}
