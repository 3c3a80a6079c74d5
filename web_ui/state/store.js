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

  /** @param {() => void} listener */
  subscribe(listener) {
    this.listeners.push(listener);
  }
}
