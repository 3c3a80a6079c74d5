// Reads a VPL program of format 1: `<program advanced_mode="…">` with one `<set>` for each row.

import { BLOCKS, kindOf, makeBlock } from "./blocks.js";
import { placeOf, wholeNumber } from "./elements.js";
import { makeProgram, makeRow } from "./program.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./elements.js").Element} Element */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Program} Program */
/** @typedef {import("./program.js").Row} Row */
/** @typedef {(key: string, element: Element, values?: Record<string, string | number>) => void} Warn */

/**
 * @param {Element} root  the element `vplroot`
 * @param {string} text   the file, for the places of warnings
 * @returns {{ program: Program, warnings: Finding[] }}
 */
export function readSets(root, text) {
  /** @type {Finding[]} */ const warnings = [];
  /** @type {Warn} */
  const warn = (key, element, values = {}) =>
    warnings.push({ key, values: { ...placeOf(text, element.from), ...values } });
  const program = root.children.find(({ name }) => name === "program");
  if (program === undefined) {
    warn("load.program", root);
    return { program: makeProgram(false), warnings };
  }
  const stored = Number.parseInt(program.attributes.advanced_mode ?? "0", 10) || 0;
  const sets = program.children.filter(({ name }) => name === "set");
  const needed = sets.find((set) => set.children.some(isOfAdvancedMode));
  const advanced = stored !== 0 || needed !== undefined;
  if (stored === 0 && needed !== undefined) warn("load.advanced", needed);
  return {
    program: makeProgram(
      advanced,
      sets.map((set) => readSet(set, advanced, warn)),
    ),
    warnings,
  };
}

/** Whether a block does something only in advanced mode. @param {Element} element */
function isOfAdvancedMode({ name, attributes }) {
  const kind = BLOCKS.get(attributes.name);
  if (name !== "block" || kind === undefined || !kind.advanced) return false;
  return (
    kind.type !== "state" ||
    kind.parameters.some((_each, index) => (wholeNumber(attributes[`value${index}`] ?? "0") ?? 0) > 0)
  );
}

/**
 * One row. Reading ends at the first block that is unknown or has no place in it.
 *
 * @param {Element} set
 * @param {boolean} advanced
 * @param {Warn} warn
 * @returns {Readonly<Row>}
 */
function readSet(set, advanced, warn) {
  /** @type {Block | null} */ let event = null;
  let state = advanced ? makeBlock("statefilter") : null;
  /** @type {Block[]} */ const actions = [];
  for (const element of set.children) {
    const { name = "", type = "" } = element.attributes;
    const kind = BLOCKS.get(name);
    if (element.name !== "block" || kind === undefined || kind.type !== type) {
      warn("load.unknown", element, {
        found: element.name === "block" ? `${type} ${name}`.trim() : `<${element.name}>`,
      });
      break;
    }
    const block = readBlock(element, name, advanced, warn);
    if (type === "event") event = block;
    else if (type === "state") state = advanced ? block : null;
    else if (actions.some((each) => each.name === name)) warn("load.twice", element, { found: name });
    else actions.push(block);
  }
  return makeRow(event, state, actions);
}

/**
 * @param {Element} element
 * @param {string} name
 * @param {boolean} advanced
 * @param {Warn} warn
 */
function readBlock(element, name, advanced, warn) {
  const { parameters } = kindOf(name);
  const found = parameters.map((_each, index) => element.attributes[`value${index}`]);
  const values = found.map((text) => (text === undefined ? undefined : (wholeNumber(text) ?? Number.NaN)));
  // Basic mode has the robot's buttons only; files of that mode may name a remote control, which counts as none.
  if (name === "button" && !advanced) values.fill(0, 5);
  const block = makeBlock(name, values);
  const changed = values.findIndex((value, index) => value !== undefined && value !== block.values[index]);
  if (changed >= 0) warn("load.value", element, { name, found: found[changed] ?? "", used: block.values[changed] });
  return block;
}
