// Helpers of the tests of blocks: golden programs, small workspaces.

import { readFileSync, readdirSync } from "node:fs";

import { readFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { strToU8, zipSync } from "../../web_ui/node_modules/fflate/esm/index.mjs";

/** @typedef {import("../../web_ui/blockly/state.js").BlockState} BlockState */

export const FOLDER = new URL("../data/web/blockly/", import.meta.url);

/** Names of the golden programs: a workspace and the Aseba text that it stands for. */
export const PROGRAMS = readdirSync(FOLDER)
  .filter((name) => name.endsWith(".xml"))
  .map((name) => name.slice(0, -".xml".length));

/** @param {string} name */
export const golden = (name) => readFileSync(new URL(name, FOLDER), "utf8");

/** The state in a text of a file. @param {string} text */
export function stateOf(text) {
  const { state, problems } = readFile(text);
  if (problems.length > 0) throw new Error(JSON.stringify(problems));
  return state;
}

/** @param {BlockState[]} blocks */
export const workspace = (...blocks) => ({ blocks: { languageVersion: 0, blocks }, variables: [] });

/** The program of blocks at the top level. @param {BlockState[]} blocks */
export const program = (...blocks) => generate(workspace(...blocks));

/** Keys of the problems. @param {BlockState[]} blocks */
export const problemsOf = (...blocks) => program(...blocks).problems.map(({ severity, key }) => `${severity} ${key}`);

/** @param {number} value @returns {BlockState} */
export const number = (value) => ({ type: "math_number", fields: { NUM: value } });

/** One below the other. @param {BlockState[]} blocks @returns {BlockState} */
export function stack(...blocks) {
  const [first, ...others] = blocks;
  return others.length === 0 ? first : { ...first, next: { block: stack(...others) } };
}

/**
 * A ZIP archive.
 *
 * @param {Record<string, string>} files
 * @param {boolean} [packed]
 */
export function zip(files, packed = true) {
  const contents = Object.entries(files).map(([name, text]) => [name, strToU8(text)]);
  return zipSync(Object.fromEntries(contents), { level: packed ? 6 : 0, mtime: new Date(2026, 0, 1) });
}
