// The teacher's file that limits the blocks of all languages: JSON such as
//
//   { "toolbox": 1, "hide": ["sound", "category:loops"], "modes": ["basic"] }
//
// `hide` has names of blocks and of categories, `modes` the modes of VPL that can be chosen. Blocks that a program has
// stay in it, whatever the file hides. Pure.

/**
 * @typedef {{ hide: readonly string[], modes: readonly string[] | null }} Toolbox   modes: null if the file has none
 */
/** @typedef {{ key: string, values: Record<string, string> }} Problem   a text of the languages' files */

const FORMAT = "toolbox";
const LISTS = /** @type {const} */ (["hide", "modes"]);

/** What is shown without a file. @type {Toolbox} */
export const WHOLE = { hide: [], modes: null };

/** Whether a file is meant as a list of blocks. @param {string} text */
export function looksLikeToolbox(text) {
  return /^\uFEFF?\s*\{/.test(text) && new RegExp(`"${FORMAT}"\\s*:`).test(text);
}

/**
 * Read a file; nothing is hidden if it has a problem.
 *
 * @param {string} text
 * @returns {{ toolbox: Toolbox, problem: null } | { toolbox: null, problem: Problem }}
 */
export function readToolbox(text) {
  /** @type {any} */ let data;
  try {
    data = JSON.parse(text.replace(/^\uFEFF/, ""));
  } catch (error) {
    return refused("json", { what: error instanceof Error ? error.message : String(error) });
  }
  if (data?.[FORMAT] !== 1) return refused("format", { found: shown(data?.[FORMAT]) });
  const unknown = Object.keys(data).find((key) => key !== FORMAT && !LISTS.some((list) => list === key));
  if (unknown !== undefined) return refused("entry", { found: unknown, known: LISTS.join(", ") });
  for (const name of LISTS) {
    const list = data[name];
    const isList = Array.isArray(list) && list.every((each) => typeof each === "string");
    if (list !== undefined && !isList) return refused("list", { name, found: shown(list) });
  }
  return { toolbox: { hide: data.hide ?? WHOLE.hide, modes: data.modes ?? WHOLE.modes }, problem: null };
}

/** @param {Toolbox} toolbox */
export function writeToolbox({ hide, modes }) {
  return `${JSON.stringify({ [FORMAT]: 1, hide, ...(modes === null ? {} : { modes }) }, null, 2)}\n`;
}

/**
 * What a file names that no language has.
 *
 * @param {Toolbox} toolbox
 * @param {readonly string[]} known  names of all languages
 */
export function unknownNames({ hide, modes }, known) {
  return [...hide, ...(modes ?? [])].filter((name) => !known.includes(name));
}

/** @param {string} key @param {Record<string, string>} values */
const refused = (key, values) => ({ toolbox: null, problem: { key: `toolbox.${key}`, values } });

/** @param {unknown} value */
const shown = (value) => (value === undefined ? "–" : JSON.stringify(value));
