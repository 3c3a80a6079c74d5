// Reads a VPL program of format 1: `<program advanced_mode="…">` with one `<set>` for each row. Extended programs
// have the same elements, with more blocks.

import { makeBlock } from "./blocks.js";
import { whyNot } from "./edits.js";
import { placeOf, wholeNumber } from "./elements.js";
import { BLOCKS, includes } from "./kinds.js";
import { makeProgram, makeRow } from "./program.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./elements.js").Element} Element */
/** @typedef {import("./kinds.js").Mode} Mode */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Place} Place */
/** @typedef {import("./program.js").Program} Program */
/** @typedef {import("./program.js").Row} Row */
/** @typedef {(key: string, element: Element, values?: Record<string, string | number>) => void} Warn */

/**
 * @param {Element} root  the element that contains `<program>`
 * @param {string} text   the file, for the places of warnings
 * @param {boolean} isExtended  whether the file is of this project's extended mode
 * @returns {{ program: Program, warnings: Finding[] }}
 */
export function readSets(root, text, isExtended = false) {
  /** @type {Finding[]} */ const warnings = [];
  /** @type {Warn} */
  const warn = (key, element, values = {}) =>
    warnings.push({ key, values: { ...placeOf(text, element.from), ...values } });
  const program = root.children.find(({ name }) => name === "program");
  if (program === undefined) {
    warn("load.program", root);
    return { program: makeProgram(isExtended ? "extended" : "basic"), warnings };
  }
  const sets = program.children.filter(({ name }) => name === "set");
  const mode = isExtended ? "extended" : modeOfFile(program, sets, warn);
  return {
    program: makeProgram(
      mode,
      sets.map((set) => readSet(set, mode, warn)),
    ),
    warnings,
  };
}

/**
 * The stored mode, or advanced mode if states need it. Timers work in basic mode, too: only its palettes lack them.
 *
 * @param {Element} program
 * @param {Element[]} sets
 * @param {Warn} warn
 * @returns {Mode}
 */
function modeOfFile(program, sets, warn) {
  if ((wholeNumber(program.attributes.advanced_mode ?? "0") ?? 0) !== 0) return "advanced";
  const needed = sets.find((set) => set.children.some(isOfAdvancedMode));
  if (needed === undefined) return "basic";
  warn("load.advanced", needed);
  return "advanced";
}

/** Blocks that a program of basic mode may have. */
const TIMERS = ["timer", "timeout"];

/** Whether a block does something only in advanced mode. @param {Element} element */
function isOfAdvancedMode({ name, attributes }) {
  const kind = BLOCKS.get(attributes.name);
  if (name !== "block" || kind?.mode !== "advanced" || TIMERS.includes(kind.name)) return false;
  return kind.type !== "state" || kind.parameters.some((_each, index) => Number(attributes[`value${index}`] ?? 0) > 0);
}

/**
 * One row. Reading ends at the first block that is unknown or has no place in it.
 *
 * @param {Element} set
 * @param {Mode} mode
 * @param {Warn} warn
 * @returns {Readonly<Row>}
 */
function readSet(set, mode, warn) {
  let row = makeProgram(mode).rows[0];
  for (const element of set.children) {
    const { name = "", type = "" } = element.attributes;
    const kind = element.name === "block" ? BLOCKS.get(name) : undefined;
    const slot = SLOTS[type];
    if (kind === undefined || slot === undefined || !includes(mode === "extended" ? mode : "advanced", kind.mode)) {
      warn("load.unknown", element, {
        found: element.name === "block" ? `${type} ${name}`.trim() : `<${element.name}>`,
      });
      break;
    }
    if (slot === "state" && mode === "basic") continue; // without effect, else the mode would be advanced
    const block = readBlock(element, name, mode, warn);
    const problem = whyNot({ mode: TIMERS.includes(name) ? "advanced" : mode, rows: [row] }, 0, block, slot);
    if (problem?.key === "edit.twice") warn("load.twice", element, { found: name });
    else if (problem !== null) {
      warn("load.unknown", element, { found: `${type} ${name}` });
      break;
    } else if (slot === "actions" || slot === "conditions") row = makeRow({ [slot]: [...row[slot], block] }, row);
    else row = makeRow({ [slot]: block }, row);
  }
  return row;
}

/** Slots by the types of blocks in files. @type {Record<string, Place["slot"] | undefined>} */
const SLOTS = Object.assign(Object.create(null), {
  event: "event",
  state: "state",
  condition: "conditions",
  action: "actions",
});

/**
 * @param {Element} element
 * @param {string} name
 * @param {Mode} mode
 * @param {Warn} warn
 */
function readBlock(element, name, mode, warn) {
  const parameters = BLOCKS.get(name)?.parameters ?? [];
  const found = parameters.map((_each, index) => element.attributes[`value${index}`]);
  const values = found.map((text) => (text === undefined ? undefined : (wholeNumber(text) ?? Number.NaN)));
  // Basic mode has the robot's buttons only; files of that mode may name a remote control, which counts as none.
  if (name === "button" && mode === "basic") values.fill(0, 5);
  const block = makeBlock(name, values);
  const changed = values.findIndex((value, index) => value !== undefined && value !== block.values[index]);
  if (changed >= 0) warn("load.value", element, { name, found: found[changed] ?? "", used: block.values[changed] });
  return block;
}
