// Whether the stored program of a file is the one that its blocks stand for.

import { generate } from "./generator.js";

/** @typedef {import("./file.js").BlocklyFile} BlocklyFile */

/** @typedef {import("./generator.js").Generated} Generated */
/** @typedef {{ text: string, row: number }} Row  a line that does something, and where it is, from 0 */

/** The lines of a program without indentation, comments and empty lines. @param {string} code @returns {Row[]} */
function essence(code) {
  const lines = code.split(/\r\n|\r|\n/).map((line) => line.replace(/#.*$/, "").replace(/\s+/g, " ").trim());
  const filled = lines.map((text, row) => ({ text, row })).filter(({ text }) => text !== "");
  // blanks around signs do not matter
  return filled.map(({ text, row }) => ({ text: text.replace(/ ?([^\w.\s]) ?/g, "$1"), row }));
}

/**
 * The first line in which the stored program differs from the generated one, or null if both are the same. A difference
 * means that the text was edited or comes from another generator: it runs until the pupil decides.
 *
 * @param {BlocklyFile} file
 * @param {readonly string[]} [reserved]  names that the program cannot use
 * @returns {{ line: number, stored: string, generated: string } | null}  line from 1, counted without empty lines
 */
export function difference({ state, code }, reserved = []) {
  const stored = essence(code ?? "").map(({ text }) => text);
  const generated = essence(generate(state, { reserved }).code).map(({ text }) => text);
  const line = Array.from({ length: Math.max(stored.length, generated.length) }, (_, index) => index).find(
    (index) => stored[index] !== generated[index],
  );
  return line === undefined ? null : { line: line + 1, stored: stored[line] ?? "", generated: generated[line] ?? "" };
}

/**
 * The block of each line of a program that is the generated one apart from blanks and comments; none of another one.
 *
 * @param {string} code
 * @param {Generated} generated
 * @returns {(string | null)[]}
 */
export function blocksOf(code, generated) {
  if (code === generated.code) return generated.blocks;
  const stored = essence(code);
  const made = essence(generated.code);
  if (stored.length !== made.length || stored.some(({ text }, index) => text !== made[index].text)) return [];
  const blocks = code.split(/\r\n|\r|\n/).map(() => /** @type {string | null} */ (null));
  stored.forEach(({ row }, index) => (blocks[row] = generated.blocks[made[index].row]));
  return blocks;
}
