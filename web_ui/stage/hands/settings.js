// What the hands have set on each robot: no topic reports it.

import { targets } from "../../state/index.js";

/**
 * @template {Record<string, any>} Values
 */
export class HandSettings {
  /** @type {Map<string, Values>} */ #byRobot = new Map();

  /** @param {import("../../state/store.js").Store} store @param {Values} start */
  constructor(store, start) {
    this.store = store;
    this.start = start;
  }

  /** The settings of the robot whose values are shown. @returns {Values} */
  get now() {
    return this.#byRobot.get(this.store.state.selected) ?? this.start;
  }

  /** Change settings of the addressed robots. @param {Partial<Values>} changes */
  change(changes) {
    const next = { ...this.now, ...changes };
    for (const robot of targets(this.store.state)) this.#byRobot.set(robot, next);
  }
}
