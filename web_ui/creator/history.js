// One history for everything: the playgrounds that were, and those that were undone. Pure, unlimited.

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {{ before: Playground, after: Playground, did: Phrase, series: string }} Step */

export class History {
  /** @param {Playground} start */
  constructor(start) {
    this.present = start;
    /** @type {Step[]} */ this.past = [];
    /** @type {Step[]} */ this.future = [];
  }

  /**
   * Go on to another playground. Steps of one series that follow each other are one step.
   *
   * @param {Playground} next
   * @param {Phrase} did      what was done, to be said when it is undone
   * @param {string} [series]
   */
  do(next, did, series = "") {
    if (next === this.present) return;
    const last = this.past.at(-1);
    const goesOn = series !== "" && last?.series === series && last.after === this.present;
    const before = goesOn ? last.before : this.present;
    if (goesOn) this.past.pop();
    this.past.push({ before, after: next, did, series });
    this.future = [];
    this.present = next;
  }

  /** What was undone; null when there is nothing. @returns {Phrase | null} */
  undo() {
    const step = this.past.pop();
    if (step === undefined) return null;
    this.future.push({ ...step, series: "" });
    this.present = step.before;
    return step.did;
  }

  /** What was done again; null when there is nothing. @returns {Phrase | null} */
  redo() {
    const step = this.future.pop();
    if (step === undefined) return null;
    this.past.push(step);
    this.present = step.after;
    return step.did;
  }
}
