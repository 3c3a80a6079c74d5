// Basic and advanced mode: what leaving advanced mode removes, and the change itself.

import { BLOCKS, BUTTONS, buttonBlock, isAdvanced, kindOf, makeBlock } from "./blocks.js";
import { makeProgram, makeRow } from "./program.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Program} Program */

/** State "between" of a sensor, and the one it becomes in basic mode. */
const BETWEEN = 3;
const FAR = 2;

/**
 * The program in a mode. Whether it loses something is the question to ask first: `lostInBasic`.
 *
 * @param {Program} program
 * @param {boolean} advanced
 */
export function withMode(program, advanced) {
  if (program.advanced === advanced) return program;
  if (advanced) return makeProgram(true, program.rows);
  return makeProgram(
    false,
    program.rows.map(({ event, actions }) =>
      makeRow(
        basic(event),
        null,
        actions.map(basic).filter((each) => each !== null),
      ),
    ),
  );
}

/**
 * What the program loses in basic mode, one finding for each block; empty if nothing needs to be asked.
 *
 * @param {Program} program
 * @returns {(Finding & { row: number })[]}
 */
export function lostInBasic({ rows }) {
  return rows.flatMap(({ event, state, actions }, row) =>
    [event, state, ...actions]
      .filter((block) => block !== null)
      .filter(isAdvanced)
      .map((block) => ({ key: lossOf(block), values: { row: row + 1 }, row })),
  );
}

/** @param {Block} block */
function lossOf(block) {
  if (block.name === "statefilter") return "mode.state";
  return kindOf(block).advanced ? `mode.removed.${block.name}` : `mode.reset.${block.name}`;
}

/** The block as basic mode has it, null if it has none. @param {Block | null} block */
function basic(block) {
  if (block === null || kindOf(block).advanced) return null;
  if (!isAdvanced(block)) return block;
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
 * @param {import("./blocks.js").BlockType} type
 * @param {boolean} advanced
 */
export function palette(type, advanced) {
  return [...BLOCKS.values()]
    .filter((kind) => kind.type === type && (advanced || !kind.advanced))
    .map(({ name }) => name);
}
