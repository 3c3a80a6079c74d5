// Helpers of the tests of blocks: golden programs, small workspaces.

import { readFileSync, readdirSync } from "node:fs";
import { deflateRawSync } from "node:zlib";

import { readFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";

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
  /** @type {Buffer[]} */ const locals = [];
  /** @type {Buffer[]} */ const entries = [];
  let at = 0;
  for (const [name, text] of Object.entries(files)) {
    const data = packed ? deflateRawSync(text) : Buffer.from(text);
    const local = Buffer.alloc(30);
    local.writeUInt32LE(0x04034b50, 0);
    local.writeUInt16LE(name.length, 26);
    const entry = Buffer.alloc(46);
    entry.writeUInt32LE(0x02014b50, 0);
    entry.writeUInt16LE(packed ? 8 : 0, 10);
    entry.writeUInt32LE(data.length, 20);
    entry.writeUInt32LE(Buffer.byteLength(text), 24);
    entry.writeUInt16LE(name.length, 28);
    entry.writeUInt32LE(at, 42);
    locals.push(local, Buffer.from(name), data);
    entries.push(entry, Buffer.from(name));
    at += local.length + name.length + data.length;
  }
  const end = Buffer.alloc(22);
  end.writeUInt32LE(0x06054b50, 0);
  end.writeUInt16LE(Object.keys(files).length, 10);
  end.writeUInt32LE(at, 16);
  return new Uint8Array(Buffer.concat([...locals, ...entries, end]));
}
