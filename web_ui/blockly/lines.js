// Lines of a program, each with the block that it comes from.

/** @typedef {import("./blocks/spec.js").Line} Line */

/** A line that comes from no block. @param {string} text @returns {Line} */
export const plain = (text) => ({ text, id: null });

/** @param {Line[]} lines */
export const indented = (lines) => lines.map((line) => (line.text === "" ? line : { ...line, text: `\t${line.text}` }));

/**
 * Groups of lines with empty lines between them.
 *
 * @param {Line[][]} groups
 * @param {number} gap  number of empty lines
 * @returns {Line[]}
 */
export function joined(groups, gap) {
  const filled = groups.filter((group) => group.length > 0);
  const between = Array.from({ length: gap }, () => plain(""));
  return filled.flatMap((group, index) => (index === 0 ? group : [...between, ...group]));
}
