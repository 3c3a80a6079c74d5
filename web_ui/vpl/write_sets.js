// Writes a VPL program in format 1, the format of all VPL since 2014, and extended programs in an element of their own.

import { kindOf } from "./blocks.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./program.js").Program} Program */

/** Element of a program that VPL of Aseba can read, and of an extended one, which it must not meet. */
export const ROOT = "vplroot";
export const EXTENDED_ROOT = "ThymioSimVpl";
/** Attribute with the format, of these elements. @type {Record<string, string>} */
export const FORMAT = { [ROOT]: "xml-format-version", [EXTENDED_ROOT]: "format" };

/** The name of the element of a program. @param {Program} program */
export function rootName({ mode }) {
  return mode === "extended" ? EXTENDED_ROOT : ROOT;
}

/**
 * The element of a program.
 *
 * @param {Program} program
 * @param {string} [margin]   white space in front of each line but the first
 * @param {string} [newline]
 */
export function writeSets(program, margin = "", newline = "\n") {
  const name = rootName(program);
  const sets = program.rows.flatMap(({ event, state, conditions, actions }) => {
    const blocks = [
      ...[event, state].filter((block) => block !== null).map((block) => writeBlock(block, kindOf(block).type)),
      ...conditions.map((block) => writeBlock(block, "condition")),
      ...actions.map((block) => writeBlock(block, "action")),
    ];
    return blocks.length === 0 ? ["  <set/>"] : ["  <set>", ...blocks, "  </set>"];
  });
  const lines = [` <program advanced_mode="${program.mode === "basic" ? 0 : 1}">`, ...sets, " </program>"];
  return [`<${name} ${FORMAT[name]}="1">`, ...lines, `</${name}>`].join(`${newline}${margin}`);
}

/** @param {Block} block @param {string} type */
function writeBlock({ name, values }, type) {
  const attributes = values.map((value, index) => ` value${index}="${value}"`);
  return `   <block type="${type}" name="${name}"${attributes.join("")}/>`;
}
