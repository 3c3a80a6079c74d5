// Reads the languages' folders. Runs in Node only, never in a browser: see `*.texts.js`.

import { existsSync, readdirSync, readFileSync } from "node:fs";

/** One folder per language, which Python reads too. */
const FOLDER = new URL("../../aseba_vm/languages/", import.meta.url);

/**
 * The texts of one file in every language, English first; no texts where a language lacks the file.
 *
 * @param {string} file  such as "page"
 * @returns {Record<string, Record<string, string>>}
 */
export function readTexts(file) {
  const codes = readdirSync(FOLDER).filter((code) => existsSync(new URL(`${code}/language.json`, FOLDER)));
  codes.sort((a, b) => Number(b === "en") - Number(a === "en") || (a < b ? -1 : 1));
  return Object.fromEntries(codes.map((code) => [code, readTable(new URL(`${code}/${file}.json`, FOLDER))]));
}

/** @param {URL} path */
function readTable(path) {
  return existsSync(path) ? JSON.parse(readFileSync(path, "utf8")) : {};
}
