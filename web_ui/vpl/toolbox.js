// The teacher's file that hides blocks: a list in JSON. Blocks that a program has stay in it, whatever the list hides.

import { BLOCKS } from "./blocks.js";
import { VplError } from "./errors.js";
import { palette } from "./mode.js";

/** @typedef {"basic" | "advanced" | "both"} Mode */
/** @typedef {{ mode: Mode, hidden: readonly string[] }} Toolbox */

const FORMAT = "vpl-toolbox";
const MODES = /** @type {const} */ (["basic", "advanced", "both"]);
const ENTRIES = [FORMAT, "mode", "hidden"];

/** All blocks in both modes. @type {Toolbox} */
export const WHOLE = { mode: "both", hidden: [] };

/**
 * Read a list such as `{ "vpl-toolbox": 1, "mode": "basic", "hidden": ["sound"] }`. Throws VplError.
 *
 * @param {string} text
 * @returns {Toolbox}
 */
export function readToolbox(text) {
  const data = parsed(text);
  if (data[FORMAT] !== 1) throw new VplError("toolbox.format", { found: shown(data[FORMAT]) });
  const unknown = Object.keys(data).find((key) => !ENTRIES.includes(key));
  if (unknown !== undefined) throw new VplError("toolbox.entry", { found: unknown, known: ENTRIES.join(", ") });
  const { mode = WHOLE.mode, hidden = WHOLE.hidden } = data;
  const known = MODES.find((each) => each === mode);
  if (known === undefined) throw new VplError("toolbox.mode", { found: shown(mode), known: MODES.join(", ") });
  if (!Array.isArray(hidden)) throw blockError(hidden);
  for (const name of hidden) if (!BLOCKS.has(name)) throw blockError(name);
  const toolbox = { mode: known, hidden: [...hidden] };
  for (const advanced of [false, true].filter((each) => allows(toolbox, each))) {
    if (offered(toolbox, "event", advanced).length === 0) throw new VplError("toolbox.noEvent");
    if (offered(toolbox, "action", advanced).length === 0) throw new VplError("toolbox.noAction");
  }
  return toolbox;
}

/** @param {Toolbox} toolbox */
export function writeToolbox({ mode, hidden }) {
  return `${JSON.stringify({ [FORMAT]: 1, mode, hidden }, null, 2)}\n`;
}

/** Whether pupils may use a mode. @param {Toolbox} toolbox @param {boolean} advanced */
export function allows({ mode }, advanced) {
  return mode === "both" || (mode === "advanced") === advanced;
}

/**
 * The blocks that a palette offers.
 *
 * @param {Toolbox} toolbox
 * @param {import("./blocks.js").BlockType} type
 * @param {boolean} advanced
 */
export function offered({ hidden }, type, advanced) {
  return palette(type, advanced).filter((name) => !hidden.includes(name));
}

/** @param {string} text @returns {Record<string, unknown>} */
function parsed(text) {
  /** @type {unknown} */ let data;
  try {
    data = JSON.parse(text);
  } catch (error) {
    throw new VplError("toolbox.json", { what: error instanceof Error ? error.message : String(error) });
  }
  if (typeof data !== "object" || data === null || Array.isArray(data))
    throw new VplError("toolbox.format", { found: "–" });
  return /** @type {Record<string, unknown>} */ (data);
}

/** @param {unknown} found */
function blockError(found) {
  return new VplError("toolbox.block", { found: shown(found), known: [...BLOCKS.keys()].join(", ") });
}

/** @param {unknown} value */
const shown = (value) => (value === undefined ? "–" : JSON.stringify(value));
