// Whether the stored program of a file is the one that its blocks stand for.

import { generate } from "./generator.js";

/** @typedef {import("./file.js").BlocklyFile} BlocklyFile */

/** The lines of a program without indentation, comments and empty lines. @param {string} code */
function essence(code) {
  const lines = code.split(/\r\n|\r|\n/).map((line) => line.replace(/#.*$/, "").replace(/\s+/g, " ").trim());
  // blanks around signs do not matter
  return lines.filter((line) => line !== "").map((line) => line.replace(/ ?([^\w.\s]) ?/g, "$1"));
}

/**
 * The first line in which the stored program differs from the generated one, or null if both are the same. A difference
 * means that the text was edited or comes from another generator: it runs until the pupil decides.
 *
 * @param {BlocklyFile} file
 * @returns {{ line: number, stored: string, generated: string } | null}  line from 1, counted without empty lines
 */
export function difference({ state, code }) {
  const stored = essence(code ?? "");
  const generated = essence(generate(state).code);
  const line = Array.from({ length: Math.max(stored.length, generated.length) }, (_, index) => index).find(
    (index) => stored[index] !== generated[index],
  );
  return line === undefined ? null : { line: line + 1, stored: stored[line] ?? "", generated: generated[line] ?? "" };
}
