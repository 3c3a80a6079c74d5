// What a teacher's file (editor/toolbox_file.js) leaves of VPL. Blocks that a program has stay in it.

import { BLOCKS, MODES } from "./kinds.js";
import { palette } from "./mode.js";

/** @typedef {import("./kinds.js").Mode} Mode */
/** @typedef {import("../editor/toolbox_file.js").Toolbox} Toolbox */

/** What a file can name. */
export const NAMES = [...BLOCKS.keys(), ...MODES];

/** The modes that can be chosen; all of them if the file names none of VPL. @param {Toolbox} toolbox @returns {readonly Mode[]} */
export function offeredModes({ modes }) {
  const named = MODES.filter((mode) => modes?.includes(mode));
  return named.length > 0 ? named : MODES;
}

/**
 * The blocks that a palette offers.
 *
 * @param {Toolbox} toolbox
 * @param {import("./kinds.js").BlockType} type
 * @param {Mode} mode
 */
export function offered({ hide }, type, mode) {
  return palette(type, mode).filter((name) => !hide.includes(name));
}
