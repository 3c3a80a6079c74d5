// Generates the Aseba text of a VPL program, with the lines of each row.

import { hasCondition } from "./blocks.js";
import { check } from "./check.js";
import { all, eventTest, stateCondition } from "./conditions.js";
import { preamble } from "./preamble.js";
import { isAdvancedRow, isEmptyRow } from "./program.js";
import { actionStatements, setsState } from "./statements.js";
import { CURRENT } from "./versions.js";

/** @typedef {import("./program.js").Program} Program */
/** @typedef {import("./program.js").Row} Row */
/** @typedef {import("./versions.js").Generator} Generator */
/** @typedef {{ first: number, last: number }} Lines  numbers of lines, from 1, both included */
/** @typedef {{ text: string, rows: readonly (Lines | null)[] }} Source  text, and the lines of each row; null: none */
/** @typedef {{ row: Readonly<Row>, index: number, lines: string[] }} Part  a row and its text */

/** Names of the event that a generated program emits with the index of a row, each time the row has run. */
export const REPORTS = ["pair_run", "PairExecuted"];
const HANDLERS = ["acc", "buttons", "mic", "prox", "rc5", "tap", "timer0"];

/**
 * The text of a program, or why there is none.
 *
 * @param {Program} program
 * @returns {{ source: Source, refusal: null } | { source: null, refusal: import("./check.js").Refusal }}
 */
export function generate(program) {
  const refusal = check(program);
  return refusal === null ? { source: generateSource(program), refusal } : { source: null, refusal };
}

/**
 * The text of a program without errors, as a version of VPL generates it.
 *
 * @param {Program} program
 * @param {Generator} [generator]
 * @returns {Source}
 */
export function generateSource({ advanced, rows }, generator = CURRENT) {
  const indexed = rows.map((row, index) => ({ row, index })).filter(({ row }) => !isEmptyRow(row));
  /** @type {(Lines | null)[]} */ const spans = rows.map(() => null);
  if (indexed.length === 0) return { text: "", rows: spans };
  const used = indexed.map(({ row }) => row);
  const lines = preamble(advanced, used, generator);
  for (const [event, parts] of handlers(advanced, indexed, generator)) {
    lines.push("", `onevent ${event}`);
    if (event === "timer0") lines.push("\ttimer.period[0] = 0");
    for (const { index, lines: own } of parts) {
      spans[index] = { first: lines.length + 1, last: lines.length + own.length };
      lines.push(...own);
      if (generator.spaced) lines.push("");
    }
    lines.push(...stateLines(advanced, parts, generator));
  }
  return { text: lines.map((line) => `${line}\n`).join(""), rows: spans };
}

/**
 * The row whose lines contain a line, or null: the line belongs to all rows.
 *
 * @param {Source} source
 * @param {number} line  from 1
 */
export function rowOfLine({ rows }, line) {
  const index = rows.findIndex((lines) => lines !== null && lines.first <= line && line <= lines.last);
  return index < 0 ? null : index;
}

/**
 * The rows of each handler, in the order of the text.
 *
 * @param {boolean} advanced
 * @param {{ row: Readonly<Row>, index: number }[]} indexed
 * @param {Generator} generator
 * @returns {[string, Part[]][]}
 */
function handlers(advanced, indexed, generator) {
  /** @type {Map<string, Part[]>} */ const found = new Map();
  for (const { row, index } of indexed) {
    if (row.event === null) continue; // refused by `check`
    const { event, lines } = rowText(row, row.event, index, generator);
    const parts = found.get(event) ?? [];
    if (parts.length === 0) found.set(event, parts);
    const at = comesFirst(row, advanced, generator) ? parts.findIndex((part) => isTested(part.row, generator)) : -1;
    parts.splice(at < 0 ? parts.length : at, 0, { row, index, lines });
  }
  const all = [...found];
  return generator.fixedHandlers ? all.sort(([a], [b]) => HANDLERS.indexOf(a) - HANDLERS.indexOf(b)) : all;
}

/**
 * Whether a row is put before those with conditions.
 *
 * @param {Readonly<Row>} row
 * @param {boolean} advanced
 * @param {Generator} generator
 */
function comesFirst(row, advanced, { order }) {
  if (hasCondition(row.event) || hasCondition(row.state)) return false;
  return order === "basic" ? !advanced : !isAdvancedRow(row);
}

/** Whether rows without conditions are put before this one. @param {Readonly<Row>} row @param {Generator} generator */
function isTested({ event, state }, { order }) {
  return hasCondition(state) || (order !== "state" && hasCondition(event));
}

/**
 * @param {Readonly<Row>} row
 * @param {import("./blocks.js").Block} block  its event
 * @param {number} index
 * @param {Generator} generator
 */
function rowText(row, block, index, generator) {
  const { event, before, condition, edge } = eventTest(block, generator);
  const { report } = generator;
  const statements = row.actions.flatMap((action) => actionStatements(action, generator));
  if (report !== "") statements.push(`emit ${report} ${index}`);
  const state = stateCondition(row.state);
  let body = statements;
  if (generator.test === "if") {
    body = enclosed("if", all([condition, state].filter((each) => each !== "")), body);
  } else {
    body = enclosed("if", state, body);
    body = enclosed(edge ? "when" : "if", condition, body);
  }
  const lines = [...before, ...body].map((line) => `\t${line}`);
  // The original has a blank here, and a file is compared with the text of the original.
  if (event === "rc5") lines[1] = ` ${lines[1]}`;
  return { event, lines };
}

/** @param {"when" | "if"} test @param {string} condition @param {string[]} body */
function enclosed(test, condition, body) {
  if (condition === "") return body;
  return [`${test} ${condition} ${test === "when" ? "do" : "then"}`, ...body.map((line) => `\t${line}`), "end"];
}

/**
 * The end of a handler: the new state becomes the state, and the robot shows it.
 *
 * @param {boolean} advanced
 * @param {Part[]} parts
 * @param {Generator} generator
 */
function stateLines(advanced, parts, { remember, spaced }) {
  const wanted = remember === "all" ? advanced : parts.some(({ row }) => row.actions.some(setsState));
  if (!wanted) return [];
  const lines = ["\tcall math.copy(state, new_state)", "\tcallsub display_state"];
  return spaced ? [...lines, ""] : ["", ...lines];
}
