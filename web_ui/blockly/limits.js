// A teacher's file limits the toolbox: {"format": 1, "hide": ["thymio_led_rgb", "category:loops"]}.

import { offered } from "./toolbox.js";

/** @typedef {{ key: string, values: Record<string, string | number> }} LimitProblem  `limits.<key>` in the texts */
/** @typedef {{ hidden: Set<string>, problems: LimitProblem[] }} Limits */

const FORMAT = 1;

/**
 * Read a teacher's file. What it does not say correctly is a problem, and hides nothing.
 *
 * @param {string} text
 * @returns {Limits}
 */
export function readLimits(text) {
  /** @type {any} */ let file;
  try {
    file = JSON.parse(text);
  } catch (error) {
    return {
      hidden: new Set(),
      problems: [{ key: "notJson", values: { message: String(/** @type {Error} */ (error).message) } }],
    };
  }
  if (file?.format !== FORMAT || !Array.isArray(file.hide)) {
    return {
      hidden: new Set(),
      problems: [{ key: "format", values: { found: JSON.stringify(file?.format ?? null) } }],
    };
  }
  const known = new Set([...offered("blockly"), ...offered("scratch")]);
  const names = file.hide.map(String);
  const unknown = names.filter((/** @type {string} */ name) => !known.has(name));
  return {
    hidden: new Set(names.filter((/** @type {string} */ name) => known.has(name))),
    problems: unknown.map((/** @type {string} */ found) => ({ key: "unknown", values: { found } })),
  };
}
