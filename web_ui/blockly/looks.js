// The two looks of blocks: that of Blockly, and that of Scratch with the blocks of its Thymio extension. A program has no
// look of its own: what it is made of decides, and the user can choose the other one.

import { allBlocks } from "./state.js";
import { CATEGORIES, offered } from "./toolbox.js";

/** @typedef {import("./toolbox.js").Look} Look */

export const LOOKS = /** @type {readonly Look[]} */ (Object.keys(CATEGORIES));

/** What a teacher's file can name: blocks, categories, and the looks as modes. */
export const NAMES = [...new Set([...LOOKS.flatMap(offered), ...LOOKS])];

/** Blocks that only one look offers. @type {(look: Look) => readonly string[]} */
const ownOf = (look) => {
  const others = LOOKS.filter((each) => each !== look).flatMap(offered);
  return offered(look).filter((type) => !others.includes(type));
};

/**
 * The look to which most blocks of a program belong; null if they are in both, or if there are none.
 *
 * @param {import("./state.js").WorkspaceState} state
 * @returns {Look | null}
 */
export function lookOf(state) {
  const types = [...allBlocks(state)].map(({ type }) => type);
  const counts = LOOKS.map((look) => types.filter((type) => ownOf(look).includes(type)).length);
  const most = Math.max(...counts);
  return most === 0 ? null : LOOKS[counts.indexOf(most)];
}

/**
 * The looks that a teacher's file leaves; all of them if it names none.
 *
 * @param {{ modes: readonly string[] | null }} toolbox
 */
export function offeredLooks({ modes }) {
  const left = LOOKS.filter((look) => modes?.includes(look));
  return left.length === 0 ? LOOKS : left;
}
