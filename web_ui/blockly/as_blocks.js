// A program of VPL as a program of blocks that does the same.

import { REPORTS } from "../editor/aesl.js";
import { newFile } from "./file.js";
import { blocksOfText } from "./from_text.js";
import { generate } from "./generator.js";

/** @typedef {import("./from_text.js").Unknown} Unknown */

/**
 * A file with blocks for each statement of the text of a program of VPL, or the first line that no block stands for. The
 * blocks do not report which row has run: only VPL shows that.
 *
 * @param {string} code
 * @returns {{ text: string, unknown: null } | { text: null, unknown: Unknown }}
 */
export function asBlocks(code) {
  const { state, unknown } = blocksOfText(code, { skipped: REPORTS });
  if (state === null) return { text: null, unknown };
  return { text: newFile(state, generate(state).code), unknown: null };
}
