// Undo history of playgrounds. Pure, without limit.

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {{ before: Playground, after: Playground, change: Phrase, series: string }} Step */

export class History {
  /** @param {Playground} start */
  constructor(start) {
    this.present = start;
    /** @type {Step[]} */ this.past = [];
    /** @type {Step[]} */ this.future = [];
  }

  /**
   * Record a new playground. Consecutive steps of one series count as one step.
   *
   * @param {Playground} next
   * @param {Phrase} change      description of the step, announced on undo
   * @param {string} [series]
   */
  do(next, change, series = "") {
    if (next === this.present) return;
    const last = this.past.at(-1);
    const goesOn = series !== "" && last?.series === series && last.after === this.present;
    const before = goesOn ? last.before : this.present;
    if (goesOn) this.past.pop();
    this.past.push({ before, after: next, change, series });
    this.future = [];
    this.present = next;
  }

  /** Undo; returns the description of the step, or null if there is none. @returns {Phrase | null} */
  undo() {
    const step = this.past.pop();
    if (step === undefined) return null;
    this.future.push({ ...step, series: "" });
    this.present = step.before;
    return step.change;
  }

  /** Redo; returns the description of the step, or null if there is none. @returns {Phrase | null} */
  redo() {
    const step = this.future.pop();
    if (step === undefined) return null;
    this.past.push(step);
    this.present = step.after;
    return step.change;
  }
}
