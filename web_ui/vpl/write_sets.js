// Writes a VPL program in format 1, the format of all VPL since 2014.

import { kindOf } from "./blocks.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./program.js").Program} Program */

/**
 * The element `vplroot` of a program.
 *
 * @param {Program} program
 * @param {string} [margin]   white space in front of each line but the first
 * @param {string} [newline]
 */
export function writeSets({ advanced, rows }, margin = "", newline = "\n") {
  const sets = rows.flatMap(({ event, state, actions }) => {
    const blocks = [event, state, ...actions]
      .filter((block) => block !== null)
      .map((block) => `   ${writeBlock(block)}`);
    return blocks.length === 0 ? ["  <set/>"] : ["  <set>", ...blocks, "  </set>"];
  });
  const program = [` <program advanced_mode="${advanced ? 1 : 0}">`, ...sets, " </program>"];
  return ['<vplroot xml-format-version="1">', ...program, "</vplroot>"].join(`${newline}${margin}`);
}

/** @param {Block} block */
function writeBlock({ name, values }) {
  const attributes = values.map((value, index) => ` value${index}="${value}"`);
  return `<block type="${kindOf(name).type}" name="${name}"${attributes.join("")}/>`;
}
