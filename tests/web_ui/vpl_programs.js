// Programs for the tests of VPL: short notation, golden answers, random ones.

import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";

import { canBeCondition, kindOf, makeBlock } from "../../web_ui/vpl/blocks.js";
import { palette } from "../../web_ui/vpl/mode.js";
import { makeProgram, makeRow, programOf } from "../../web_ui/vpl/program.js";

/** @typedef {import("../../web_ui/vpl/blocks.js").Block} Block */
/** @typedef {import("../../web_ui/vpl/program.js").Program} Program */
/** @typedef {[string, ...number[]]} Short  name and values of a block */

const FOLDER = new URL("../data/web/vpl/", import.meta.url);

/** A file of the test data. @param {string} name */
export function vplFile(name) {
  return readFileSync(new URL(name, FOLDER), "utf8");
}

/** Names of the files with a program. */
export const FILES = ["format0.aesl", "settings.aesl", "current.aesl"];

/**
 * The golden programs, with the answers of VPL of Aseba 2.4.1.
 *
 * @typedef {{ error: string, row: number, other_row: number }} Refused
 * @returns {{ id: string, program: Program, words?: number[], refused?: Refused }[]}
 */
export function goldenPrograms() {
  const lines = gunzipSync(readFileSync(new URL("programs.jsonl.gz", FOLDER)))
    .toString()
    .trim()
    .split("\n");
  return lines.map((line) => {
    const { id, words, refused, advanced, rows } = JSON.parse(line);
    return {
      id,
      words,
      refused,
      program: programOf({ mode: advanced ? "advanced" : "basic", rows: rows.map(plainRow) }),
    };
  });
}

/** @typedef {[string, number[]] | null} Pair  block of a golden program */

/** @param {{ event: Pair, state: Pair, actions: Pair[] }} row */
function plainRow({ event, state, actions }) {
  /** @param {Pair} pair */
  const plain = (pair) => (pair === null ? null : { name: pair[0], values: pair[1] });
  return { event: plain(event), state: plain(state), actions: actions.map(plain).filter((each) => each !== null) };
}

/** @param {Short | null} [short] */
export function block(short = null) {
  return short === null ? null : makeBlock(short[0], short.slice(1).map(Number));
}

/**
 * A program; a row is its event, its actions, its state filter, and its further conditions.
 *
 * @param {import("../../web_ui/vpl/kinds.js").Mode} mode
 * @param {[event: Short | null, actions: Short[], state?: number[], conditions?: Short[]][]} rows
 */
export function program(mode, ...rows) {
  /** @param {Short} short */
  const made = ([name, ...values]) => makeBlock(name, values);
  return makeProgram(
    mode,
    rows.map(([event, actions, state, conditions = []]) =>
      makeRow({
        event: block(event),
        state: mode === "basic" ? null : makeBlock("statefilter", state),
        conditions: conditions.map(made),
        actions: actions.map(made),
      }),
    ),
  );
}

/** Numbers from 0 to below 1, the same for each seed (mulberry32). @param {number} seed */
export function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), 1 | state);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** @param {() => number} random @param {number} below */
export const pick = (random, below) => Math.floor(random() * below);

/**
 * A block with random values that its editor allows.
 *
 * @param {() => number} random
 * @param {string} name
 * @param {boolean} [isAdvanced]
 */
export function randomBlock(random, name, isAdvanced = true) {
  const { parameters } = kindOf(name);
  return makeBlock(
    name,
    parameters.map(({ kind, least, greatest, advanced = greatest, initial }) => {
      if (kind === "choice") return pick(random, 1 + (isAdvanced ? advanced : greatest));
      if (kind === "threshold" && !isAdvanced) return initial;
      if (kind === "note") return pick(random, 6) + 256 * (1 + pick(random, 2));
      return least + pick(random, greatest - least + 1);
    }),
  );
}

/**
 * A program that may have errors.
 *
 * @param {() => number} random
 * @param {import("../../web_ui/vpl/kinds.js").Mode} mode
 */
export function randomProgram(random, mode) {
  /** @param {string} name */
  const made = (name) => randomBlock(random, name, mode !== "basic");
  const events = palette("event", mode);
  const rows = Array.from({ length: pick(random, 8) }, () => {
    const event = random() < 0.9 ? made(events[pick(random, events.length)]) : null;
    const actions = palette("action", mode)
      .filter(() => random() < 0.4)
      .map(made);
    const further = mode === "extended" ? [...events, "counter"].filter(() => random() < 0.2).map(made) : [];
    const state = random() < 0.5 ? makeBlock("statefilter") : made("statefilter");
    return makeRow({
      event,
      state: mode === "basic" ? null : state,
      conditions: further.filter(canBeCondition),
      actions,
    });
  });
  return makeProgram(mode, rows);
}
