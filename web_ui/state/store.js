// Holds the state, applies messages, and notifies subscribers.

import { INITIAL, reduce } from "./index.js";

/** @typedef {import("./index.js").State} State */
/** @typedef {import("./index.js").Message} Message */

export class Store {
  constructor() {
    /** @type {State} */ this.state = INITIAL;
    /** @type {(() => void)[]} */ this.listeners = [];
  }

  /** @param {Message} message */
  dispatch(message) {
    const next = reduce(this.state, message);
    if (next === this.state) return;
    this.state = next;
    for (const listener of this.listeners) listener();
  }

  /** Resolve when the state meets a condition. @param {(state: State) => boolean} condition @returns {Promise<void>} */
  until(condition) {
    return new Promise((resolve) => {
      const check = () => condition(this.state) && resolve();
      this.subscribe(check);
      check();
    });
  }

  /** @param {() => void} listener */
  subscribe(listener) {
    this.listeners.push(listener);
  }
}
