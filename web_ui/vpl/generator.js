// Generates the Aseba text of a VPL program, with the lines of each row.

import { REPORTS } from "../editor/aesl.js";
import { hasCondition } from "./blocks.js";
import { check } from "./check.js";
import { all, eventTest, START, stateCondition } from "./conditions.js";
import { definitions, initialization, STATE_DISPLAY } from "./preamble.js";
import { hasFilter, isAdvancedRow, isEmptyRow } from "./program.js";
import { actionStatements, setsState } from "./statements.js";
import { CURRENT } from "./versions.js";

/** @typedef {import("./program.js").Program} Program */
/** @typedef {import("./program.js").Row} Row */
/** @typedef {import("./versions.js").Generator} Generator */
/** @typedef {{ first: number, last: number }} Lines  numbers of lines, from 1, both included */
/** @typedef {{ text: string, rows: readonly (Lines | null)[] }} Source  text, and the lines of each row; null: none */
/** @typedef {{ row: Readonly<Row>, index: number, lines: string[] }} Part  a row and its text */

const COPY_STATE = "call math.copy(state, new_state)";
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
export function generateSource({ mode, rows }, generator = CURRENT) {
  const advanced = mode !== "basic";
  const indexed = rows.map((row, index) => ({ row, index })).filter(({ row }) => !isEmptyRow(row));
  /** @type {(Lines | null)[]} */ const spans = rows.map(() => null);
  if (indexed.length === 0) return { text: "", rows: spans };
  const used = indexed.map(({ row }) => row);
  const lines = initialization(advanced, used, generator);
  /** @param {Part[]} parts */
  const add = (parts) => {
    for (const { index, lines: own } of parts) {
      spans[index] = { first: lines.length + 1, last: lines.length + own.length };
      lines.push(...own);
      if (generator.spaced) lines.push("");
    }
    lines.push(...stateLines(advanced, parts, generator));
  };
  const { start, handlers } = arranged(advanced, indexed, generator);
  add(start);
  lines.push(...definitions(advanced, used, generator));
  for (const [event, parts] of handlers) {
    lines.push("", `onevent ${event}`);
    if (event === "timer0") lines.push("\ttimer.period[0] = 0");
    add(parts);
  }
  return { text: lines.map((line) => `${line}\n`).join(""), rows: spans };
}

/**
 * The row that has just run, as an event of the robot reports it; null for other events.
 *
 * @param {string} event
 * @param {readonly number[]} values
 */
export function reportedRow(event, values) {
  return REPORTS.includes(event) && values.length > 0 ? values[0] : null;
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
 * The rows that run at the start, and those of each handler, in the order of the text.
 *
 * @param {boolean} advanced
 * @param {{ row: Readonly<Row>, index: number }[]} indexed
 * @param {Generator} generator
 * @returns {{ start: Part[], handlers: [string, Part[]][] }}
 */
function arranged(advanced, indexed, generator) {
  /** @type {Map<string, Part[]>} */ const found = new Map();
  for (const { row, index } of indexed) {
    if (row.event === null) continue; // refused by `check`
    const { event, lines } = rowText(row, row.event, index, generator);
    const parts = found.get(event) ?? [];
    if (parts.length === 0) found.set(event, parts);
    const at = comesFirst(row, advanced, generator) ? parts.findIndex((part) => isTested(part.row, generator)) : -1;
    parts.splice(at < 0 ? parts.length : at, 0, { row, index, lines });
  }
  const start = found.get(START) ?? [];
  found.delete(START);
  const handlers = [...found];
  if (generator.fixedHandlers) handlers.sort(([a], [b]) => HANDLERS.indexOf(a) - HANDLERS.indexOf(b));
  return { start, handlers };
}

/**
 * Whether a row is put before those with conditions.
 *
 * @param {Readonly<Row>} row
 * @param {boolean} advanced
 * @param {Generator} generator
 */
function comesFirst(row, advanced, { order }) {
  if (hasCondition(row.event) || hasFilter(row)) return false;
  return order === "basic" ? !advanced : !isAdvancedRow(row);
}

/** Whether rows without conditions are put before this one. @param {Readonly<Row>} row @param {Generator} generator */
function isTested(row, { order }) {
  return hasFilter(row) || (order !== "state" && hasCondition(row.event));
}

/**
 * @param {Readonly<Row>} row
 * @param {import("./blocks.js").Block} block  its event
 * @param {number} index
 * @param {Generator} generator
 */
function rowText(row, block, index, generator) {
  const { event, before, condition, edge } = eventTest(block, generator);
  const statements = row.actions.flatMap((action) => actionStatements(action, generator));
  if (generator.report !== "") statements.push(`emit ${generator.report} ${index}`);
  // Each further condition has an `if` of its own: long conditions need more stack than the robot has.
  const inner = row.conditions.reduceRight((body, each) => {
    const test = eventTest(each, generator);
    return [...test.before, ...enclosed("if", test.condition, body)];
  }, statements);
  const state = stateCondition(row.state);
  const body =
    generator.test === "if"
      ? enclosed("if", all([condition, state]), inner)
      : enclosed(edge ? "when" : "if", condition, enclosed("if", state, inner));
  if (event === START) return { event, lines: [...before, ...body] };
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
  if (!wanted || parts.length === 0) return [];
  // At the start there is no subroutine yet.
  const isStart = parts[0].row.event?.name === "init";
  const lines = isStart ? [COPY_STATE, STATE_DISPLAY] : [`\t${COPY_STATE}`, "\tcallsub display_state"];
  return spaced ? [...lines, ""] : ["", ...lines];
}
