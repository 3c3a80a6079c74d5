// Names of variables and subroutines in Aseba: any name of a workspace becomes one that the compiler accepts.

import ROBOT_VARIABLES from "./robot_variables.texts.js";

const KEYWORDS =
  "when emit _emit for in step while do if then else elseif end " +
  "var const call sub callsub onevent abs return or and not";
const ROBOT = "event button buttons prox motor acc temperature rc5 mic timer math sound leds sd";

/** Words that the language or the robot uses. */
export const RESERVED = new Set([...`${KEYWORDS} ${ROBOT}`.split(" "), ...ROBOT_VARIABLES]);

/**
 * The characters that Aseba allows: blanks become underscores, letters of Western Europe and dots stay.
 *
 * @param {string} name
 */
export function allowedName(name) {
  const allowed = name.replace(/[^0-9A-Za-z_.À-ÖØ-öø-ÿ]/g, "_").replace(/^\.+/, "");
  if (allowed === "") return "unnamed";
  return /^[0-9]/.test(allowed) ? `_${allowed}` : allowed;
}

/**
 * Gives each name of a workspace one name in the program; names that differ only in case are the same, as in Blockly.
 */
export class Names {
  /** @param {Iterable<string>} [reserved]  further names that the program cannot use */
  constructor(reserved = []) {
    this.used = new Set([...RESERVED, ...reserved]);
    /** @type {Map<string, string>} */ this.given = new Map();
  }

  /** @param {"variable" | "subroutine"} kind @param {string} name */
  get(kind, name) {
    const key = `${kind} ${name.toLowerCase()}`;
    const known = this.given.get(key);
    if (known !== undefined) return known;
    const fresh = this.fresh(name);
    this.given.set(key, fresh);
    return fresh;
  }

  /** A name that nothing else has: the wanted one, else with a number behind it. @param {string} wanted */
  fresh(wanted) {
    const base = allowedName(wanted);
    let name = base;
    for (let number = 2; this.used.has(name); number++) name = `${base}${number}`;
    this.used.add(name);
    return name;
  }
}
