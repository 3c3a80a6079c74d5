// Less movement: by the choice on the page, or by that of the system. Style sheets follow `data-calm`.

import { trySetItem } from "./local_storage.js";

const KEY = "calm";

export class MotionSetting {
  /**
   * @param {object} options
   * @param {import("./local_storage.js").KeyValueStore} options.storage
   * @param {Pick<MediaQueryList, "matches" | "addEventListener">} options.systemIsCalm   (prefers-reduced-motion: reduce)
   * @param {Pick<HTMLElement, "toggleAttribute">} options.root
   */
  constructor({ storage, systemIsCalm, root }) {
    this.storage = storage;
    this.systemIsCalm = systemIsCalm;
    this.root = root;
    /** Whether the user wants less movement on this page, whatever the system says. */
    this.wanted = storage.getItem(KEY) === "true";
    /** @type {(() => void)[]} */ this.listeners = [];
    systemIsCalm.addEventListener("change", () => this.#report());
    this.root.toggleAttribute("data-calm", this.wanted);
  }

  /** Whether nothing may move by itself. */
  get isCalm() {
    return this.wanted || this.systemIsCalm.matches;
  }

  /** @param {boolean} calm */
  choose(calm) {
    this.wanted = calm;
    trySetItem(this.storage, KEY, String(calm));
    this.root.toggleAttribute("data-calm", calm);
    this.#report();
  }

  /** @param {() => void} listener  called when `isCalm` may have changed */
  subscribe(listener) {
    this.listeners.push(listener);
  }

  #report() {
    for (const listener of this.listeners) listener();
  }
}
