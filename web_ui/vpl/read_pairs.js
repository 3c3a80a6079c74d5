// Reads a VPL program of format 0 (Aseba 1.3): `<settings …/>`, then one `<buttonset …/>` for each event with
// one action.

import { makeBlock } from "./blocks.js";
import { placeOf, wholeNumber } from "./elements.js";
import { BLOCKS } from "./kinds.js";
import { makeProgram, makeRow, sameEvent } from "./program.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./elements.js").Element} Element */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Program} Program */
/** @typedef {import("./program.js").Row} Row */
/** @typedef {import("./read_sets.js").Warn} Warn */

/** Names of format 0 and of today. */
const EVENT_NAMES = /** @type {Record<string, string>} */ ({ tap: "acc" });
const ACTION_NAMES = /** @type {Record<string, string>} */ ({ statefilter: "setstate" });
const STATES = 4;

/**
 * The program, and its rows as they are stored: with one action each.
 *
 * @param {Element} root  the element `vplroot`
 * @param {string} text   the file, for the places of warnings
 * @returns {{ program: Program, pairs: Program, warnings: Finding[] }}
 */
export function readPairs(root, text) {
  /** @type {Finding[]} */ const warnings = [];
  /** @type {Warn} */
  const warn = (key, element, values = {}) =>
    warnings.push({ key, values: { ...placeOf(text, element.from), ...values } });
  const sets = root.children.filter(({ name }) => name === "buttonset");
  const stored = root.children.find(({ name }) => name === "settings")?.attributes["advanced-mode"];
  const mode = stored === "true" || sets.some(({ attributes }) => stateOf(attributes) >= 0) ? "advanced" : "basic";
  const rows = sets.map((set) => readPair(set, mode === "advanced", warn));
  return { program: makeProgram(mode, merged(rows)), pairs: makeProgram(mode, rows), warnings };
}

/** The bits of the state filter, -1 if there is none. @param {Record<string, string>} attributes */
function stateOf({ state }) {
  return wholeNumber(state ?? "-1") ?? -1;
}

/**
 * @param {Element} set
 * @param {boolean} advanced
 * @param {Warn} warn
 * @returns {Readonly<Row>}
 */
function readPair(set, advanced, warn) {
  const { attributes } = set;
  const [eventName = "", actionName = ""] = [attributes["event-name"], attributes["action-name"]];
  const event = readBlock(set, eventName, EVENT_NAMES[eventName] ?? eventName, "event", warn);
  const action = readBlock(set, actionName, ACTION_NAMES[actionName] ?? actionName, "action", warn);
  const bits = Math.max(0, stateOf(attributes));
  const states = Array.from({ length: STATES }, (_each, index) => (bits >> (2 * index)) & 3);
  const state = advanced ? makeBlock("statefilter", states) : null;
  return makeRow({ event, state, actions: action === null ? [] : [action] });
}

/**
 * @param {Element} set
 * @param {string} found  name in the file
 * @param {string} name   name today
 * @param {"event" | "action"} type
 * @param {Warn} warn
 */
function readBlock(set, found, name, type, warn) {
  if (found === "") return null;
  const kind = BLOCKS.get(name);
  if (kind?.type !== type || kind.mode === "extended") {
    warn("load.unknown", set, { found });
    return null;
  }
  const prefix = type === "event" ? "eb" : "ab";
  const exchanges = name === "prox" || name === "proxground";
  const texts = kind.parameters.map((parameter, index) =>
    parameter.kind === "threshold" ? undefined : set.attributes[`${prefix}${index}`],
  );
  const values = texts.map((text) => {
    if (text === undefined) return undefined;
    const value = wholeNumber(text) ?? Number.NaN;
    return exchanges ? exchanged(value) : value;
  });
  const block = makeBlock(name, values);
  const changed = values.findIndex((value, index) => value !== undefined && value !== block.values[index]);
  if (changed >= 0) warn("load.value", set, { name: found, found: texts[changed] ?? "", used: block.values[changed] });
  return block;
}

/** Format 0 has 1 for far or black and 2 for near or white. @param {number} value */
function exchanged(value) {
  if (value === 1) return 2;
  return value === 2 ? 1 : value;
}

/**
 * Rows with the same event and state are one row with several actions. A second action of one kind keeps its
 * row, so that nothing is lost; the check then reports it.
 *
 * @param {Readonly<Row>[]} rows
 */
function merged(rows) {
  /** @type {Readonly<Row>[]} */ const result = [];
  for (const row of rows) {
    const at = row.event === null ? -1 : result.findIndex((each) => sameEvent(each, row));
    const added = row.actions.filter(({ name }) => !result[at]?.actions.some((each) => each.name === name));
    if (at < 0 || added.length < row.actions.length) result.push(row);
    else result[at] = makeRow({ actions: [...result[at].actions, ...added] }, result[at]);
  }
  return result;
}
