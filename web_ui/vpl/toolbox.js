// The teacher's file that hides blocks: a list in JSON. Blocks that a program has stay in it, whatever the list hides.

import { VplError } from "./errors.js";
import { BLOCKS, MODES } from "./kinds.js";
import { palette } from "./mode.js";

/** @typedef {import("./kinds.js").Mode} Mode */
/** @typedef {{ modes: readonly Mode[], hidden: readonly string[] }} Toolbox */

const FORMAT = "vpl-toolbox";
const ENTRIES = [FORMAT, "modes", "hidden"];

/** What pupils see without a list: all of VPL of Aseba. @type {Toolbox} */
export const WHOLE = { modes: ["basic", "advanced"], hidden: [] };

/**
 * Read a list such as `{ "vpl-toolbox": 1, "modes": ["basic"], "hidden": ["sound"] }`. Throws VplError.
 *
 * @param {string} text
 * @returns {Toolbox}
 */
export function readToolbox(text) {
  const data = parsed(text);
  if (data[FORMAT] !== 1) throw new VplError("toolbox.format", { found: shown(data[FORMAT]) });
  const unknown = Object.keys(data).find((key) => !ENTRIES.includes(key));
  if (unknown !== undefined) throw new VplError("toolbox.entry", { found: unknown, known: ENTRIES.join(", ") });
  const modes = listOf(data.modes ?? WHOLE.modes, MODES, "toolbox.mode");
  const hidden = listOf(data.hidden ?? WHOLE.hidden, [...BLOCKS.keys()], "toolbox.block");
  if (modes.length === 0) throw new VplError("toolbox.mode", { found: "[]", known: MODES.join(", ") });
  const toolbox = { modes, hidden };
  for (const mode of modes) {
    if (offered(toolbox, "event", mode).length === 0) throw new VplError("toolbox.noEvent");
    if (offered(toolbox, "action", mode).length === 0) throw new VplError("toolbox.noAction");
  }
  return toolbox;
}

/** @param {Toolbox} toolbox */
export function writeToolbox({ modes, hidden }) {
  return `${JSON.stringify({ [FORMAT]: 1, modes, hidden }, null, 2)}\n`;
}

/**
 * The blocks that a palette offers.
 *
 * @param {Toolbox} toolbox
 * @param {import("./kinds.js").BlockType} type
 * @param {Mode} mode
 */
export function offered({ hidden }, type, mode) {
  return palette(type, mode).filter((name) => !hidden.includes(name));
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

/**
 * A list of known words.
 *
 * @template {string} T
 * @param {unknown} list
 * @param {readonly T[]} known
 * @param {string} key  of the error
 * @returns {T[]}
 */
function listOf(list, known, key) {
  return (Array.isArray(list) ? list : [list]).map((each) => {
    const found = Array.isArray(list) ? known.find((word) => word === each) : undefined;
    if (found === undefined) throw new VplError(key, { found: shown(each), known: known.join(", ") });
    return found;
  });
}

/** @param {unknown} value */
const shown = (value) => (value === undefined ? "–" : JSON.stringify(value));
