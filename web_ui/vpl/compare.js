// Compares the text of a file with its picture: which version of VPL wrote it, and what changes when it is
// generated anew.

import { hasCondition } from "./blocks.js";
import { check } from "./check.js";
import { generateSource } from "./generator.js";
import { hasFilter, makeProgram, sameProgram } from "./program.js";
import { CURRENT, VERSIONS } from "./versions.js";

/** @typedef {import("./file.js").VplFile} VplFile */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Program} Program */
/** @typedef {import("./generator.js").Source} Source */
/** @typedef {import("./versions.js").Generator} Generator */
/** @typedef {import("./versions.js").Version} Version */
/**
 * - `current`: today's VPL generates the same program
 * - `older`: an older version generated it
 * - `edited`: no version generates it; text or picture were changed without the other
 * - `broken`: the picture has an error, so that there is no text for it
 * - `empty`: there is no text
 *
 * @typedef {"current" | "older" | "edited" | "broken" | "empty"} Origin
 */
/**
 * @typedef {object} Comparison
 * @property {Origin} origin
 * @property {Finding} message              what to say about it
 * @property {readonly Version[]} versions  those that generate the text, newest first; of a broken picture, its first
 *   rows count
 * @property {Source | null} source         the stored text with the lines of its rows, if they are known
 * @property {Finding[]} changes            what becomes different when the text is generated anew
 */

/** What a generator may do differently, and the key of its consequence. */
const CONSEQUENCES = /** @type {const} */ ([
  ["test", "change.edge"],
  ["swapped", "change.swapped"],
  ["distance", "change.distance"],
  ["ground", "change.ground"],
  ["strict", "change.strict"],
  ["melody", "change.melody"],
  ["strictAngle", "change.angle"],
  ["center", "change.center"],
  ["order", "change.order"],
  ["remember", "change.remember"],
  ["report", "change.report"],
]);
/** Statements of a debugging option of VPL, which no generator here writes. */
const DEBUGGING = /^[ \t]*_?emit (?:debug_log|DebugLog)\b.*$/gm;
const COMMENT = /#\*[\s\S]*?\*#|#.*/g;

/**
 * @param {VplFile} file
 * @returns {Comparison}
 */
export function compareText(file) {
  const refusal = check(file.program);
  if (file.code.trim() === "") return comparison("empty");
  if (refusal !== null) {
    const start = { ...file, program: above(file.program, refusal.row), stored: withoutError(file.stored) };
    return { ...comparison("broken", { row: refusal.row + 1 }), versions: versionsOf(start) };
  }
  const versions = versionsOf(file);
  if (versions.length === 0) return comparison("edited");
  const found = { versions, source: sourceOf(versions[0], file), changes: changesSince(versions[0], file) };
  if (versions[0].generator === CURRENT) return { ...comparison("current"), ...found };
  const [newest, oldest] = [versions[0].name, versions[versions.length - 1].name];
  const version = newest === oldest ? newest : `${oldest} – ${newest}`;
  return { ...comparison("older", { version }), ...found };
}

/**
 * The stored text with the lines of its rows: known if the text is equal, and its rows are those of the program.
 *
 * @param {Version} version
 * @param {VplFile} file
 */
function sourceOf({ generator }, { program, code }) {
  if (!generator.merged) return null;
  const source = generateSource(program, generator);
  return source.text.trimEnd() === code.trimEnd() ? source : null;
}

/** @param {Origin} origin @param {Record<string, string | number>} [values] @returns {Comparison} */
function comparison(origin, values = {}) {
  return { origin, message: { key: `text.${origin}`, values }, versions: [], source: null, changes: [] };
}

/** The versions that generate the text of a file from its picture, newest first. @param {VplFile} file */
function versionsOf(file) {
  const code = essence(file.code);
  return VERSIONS.filter(
    ({ format, generator }) =>
      (file.format === "extended" ? generator === CURRENT : format === file.format) &&
      essence(textBy(generator, file)) === code,
  );
}

/** @param {Generator} generator @param {VplFile} file */
function textBy(generator, { program, stored }) {
  return generateSource(generator.merged ? program : stored, generator).text;
}

/**
 * What differs between the text of a version and today's: each property of its generator that by itself changes
 * the text.
 *
 * @param {Version} version
 * @param {VplFile} file
 * @returns {Finding[]}
 */
function changesSince({ generator }, file) {
  const today = generateSource(file.program).text;
  const changes = CONSEQUENCES.filter(([property]) => {
    if (property === "strict" && generator.distance !== null) return false; // other limits anyway
    return generateSource(file.program, { ...CURRENT, [property]: generator[property] }).text !== today;
  }).map(([property, key]) => ({ key: /** @type {string} */ (key), values: limitsOf(generator, property) }));
  /** @param {string} key @param {boolean} applies */
  const add = (key, applies) => applies && changes.push({ key, values: {} });
  const isFiltered = file.program.rows.some((row) => hasCondition(row.event) && hasFilter(row));
  add("change.state", generator.test === "if" && isFiltered);
  add("change.merged", !sameProgram(file.program, file.stored));
  add("change.debugging", file.code.replace(DEBUGGING, "") !== file.code);
  const known = new Set(commentsOf(today + textBy(generator, file)));
  add(
    "change.comments",
    commentsOf(file.code).some((comment) => !known.has(comment)),
  );
  return changes;
}

/** Fixed thresholds of a generator. @param {Generator} generator @param {keyof Generator} property */
function limitsOf(generator, property) {
  const limits = property === "distance" || property === "ground" ? generator[property] : null;
  return /** @type {Record<string, number>} */ (limits === null ? {} : { low: limits[0], high: limits[1] });
}

/** @param {string} text */
function commentsOf(text) {
  return [...text.matchAll(COMMENT)].map(([comment]) => comment.trimEnd());
}

/** The statements of a text, without comments, white space and debugging. @param {string} text */
function essence(text) {
  const bare = text.replace(DEBUGGING, "").replace(COMMENT, "");
  return bare
    .replace(/\s+/g, " ")
    .replace(/ ?(\W) ?/g, "$1")
    .trim();
}

/** The rows above one. @param {Program} program @param {number} row */
function above({ mode, rows }, row) {
  return makeProgram(mode, rows.slice(0, row));
}

/** @param {Program} program */
function withoutError(program) {
  const refusal = check(program);
  return refusal === null ? program : above(program, refusal.row);
}
