// The modes: what a change to a smaller one removes, and the change itself.

import { BUTTONS, buttonBlock, kindOf, makeBlock, modeOf } from "./blocks.js";
import { BLOCKS, includes } from "./kinds.js";
import { blocksOf, makeProgram, makeRow } from "./program.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./kinds.js").Mode} Mode */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Program} Program */

/** State "between" of a sensor, and the one it becomes in basic mode. */
const BETWEEN = 3;
const FAR = 2;

/**
 * The program in a mode. Whether it loses something is the question to ask first: `lostIn`.
 *
 * @param {Program} program
 * @param {Mode} mode
 */
export function withMode(program, mode) {
  if (program.mode === mode) return program;
  const rows = program.rows.map(({ event, state, conditions, actions }) =>
    makeRow({
      event: fitted(event, mode),
      state: fitted(state, mode),
      conditions: mode === "extended" ? conditions : [],
      actions: actions.map((action) => fitted(action, mode)).filter((each) => each !== null),
    }),
  );
  return makeProgram(mode, rows);
}

/**
 * What the program loses in a mode, one finding for each block; empty if nothing needs to be asked.
 *
 * @param {Program} program
 * @param {Mode} mode
 * @returns {(Finding & { row: number })[]}
 */
export function lostIn({ rows }, mode) {
  return rows.flatMap((found, row) =>
    blocksOf(found)
      .filter((block) => !includes(mode, found.conditions.includes(block) ? "extended" : modeOf(block)))
      .map((block) => ({ key: lossOf(block, found.conditions.includes(block), mode), values: { row: row + 1 }, row })),
  );
}

/** @param {Block} block @param {boolean} isCondition @param {Mode} mode */
function lossOf(block, isCondition, mode) {
  const { type, mode: first } = kindOf(block);
  if (isCondition) return "mode.condition";
  if (type === "state") return "mode.state";
  return includes(mode, first) ? `mode.reset.${block.name}` : `mode.removed.${block.name}`;
}

/** The block as a mode has it, null if it has none. @param {Block | null} block @param {Mode} mode */
function fitted(block, mode) {
  if (block === null || !includes(mode, kindOf(block).mode)) return null;
  if (includes(mode, modeOf(block))) return block;
  if (block.name === "button") return buttonBlock(BUTTONS);
  if (block.name === "acc") return makeBlock("acc");
  const { parameters } = kindOf(block);
  const values = block.values.map((value, index) => {
    if (parameters[index].kind === "threshold") return parameters[index].initial;
    return value === BETWEEN ? FAR : value;
  });
  return makeBlock(block.name, values);
}

/**
 * The blocks that a mode offers, in the order of the palettes.
 *
 * @param {import("./kinds.js").BlockType} type
 * @param {Mode} mode
 */
export function palette(type, mode) {
  return [...BLOCKS.values()].filter((kind) => kind.type === type && includes(mode, kind.mode)).map(({ name }) => name);
}
