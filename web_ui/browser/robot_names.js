// The names that a class gives to its robots. They stay in this browser; the simulator keeps its own.

import { localStore, trySetItem } from "./local_storage.js";

/** @typedef {import("./local_storage.js").KeyValueStore} KeyValueStore */

const KEY = "robot.names";

export class RobotNames {
  /** @param {KeyValueStore} storage */
  constructor(storage) {
    this.storage = storage;
    /** @type {Record<string, string>} */ this.names = readNames(storage.getItem(KEY));
  }

  /** The given name of a robot; empty: none. @param {string} robot */
  of(robot) {
    return Object.hasOwn(this.names, robot) ? this.names[robot] : "";
  }

  /** The name to show: the given one, else its own. @param {string} robot */
  title(robot) {
    return this.of(robot) || robot;
  }

  /** @param {string} robot @param {string} name  empty: none */
  set(robot, name) {
    const { [robot]: _, ...others } = this.names;
    const given = name.trim();
    this.names = given === "" ? others : { ...others, [robot]: given };
    trySetItem(this.storage, KEY, JSON.stringify(this.names));
  }
}

/** @param {string | null} kept @returns {Record<string, string>} */
function readNames(kept) {
  try {
    const names = JSON.parse(kept ?? "{}");
    return Object.fromEntries(Object.entries(names).filter(([, name]) => typeof name === "string"));
  } catch {
    return {};
  }
}

export const robotNames = new RobotNames(localStore);
