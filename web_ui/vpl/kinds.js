// The blocks of VPL: their parameters, ranges and defaults. Values have the order of the attributes value0,
// value1, … in files.

/** @typedef {"event" | "state" | "condition" | "action"} BlockType */
/** @typedef {"basic" | "advanced" | "extended"} Mode  extended: with blocks and conditions that VPL of Aseba lacks */
/**
 * A parameter of a block. `accept` returns the value that a file or an editor may set, or null if it must be ignored.
 *
 * @typedef {object} Parameter
 * @property {"choice" | "number" | "threshold" | "note"} kind
 * @property {number} least
 * @property {number} greatest
 * @property {number} [advanced]  greatest value in advanced mode, if that differs
 * @property {number} step        of an editor; files may hold values between
 * @property {number} initial
 * @property {(value: number) => number | null} accept
 */
/**
 * @typedef {object} BlockKind
 * @property {string} name
 * @property {BlockType} type
 * @property {Mode} mode          the first mode that has the block
 * @property {readonly Parameter[]} parameters
 * @property {number} conditions  number of leading values that make a condition if one of them is above 0
 */

/** Number that stands for silence in the notes of a melody; 0 to 4 are notes. */
export const SILENCE = 5;
/** A value of a melody is note + 256 · length. */
export const LENGTH_UNIT = 256;
/** The word range of Aseba: a program with other numbers does not compile. */
const LEAST_WORD = -32768;
const GREATEST_WORD = 32767;

/** @param {number} value @param {number} least @param {number} greatest */
const clamp = (value, least, greatest) => Math.min(Math.max(value, least), greatest);

/** @param {number} greatest @param {number} [advanced] @returns {Parameter} */
const choice = (greatest, advanced = greatest) => ({
  kind: "choice",
  least: 0,
  greatest,
  advanced,
  step: 1,
  initial: 0,
  accept: (value) => (value >= 0 && value <= advanced ? value : null),
});

/** A choice that is never at rest: from 1. @param {number} greatest @param {number} initial @returns {Parameter} */
const oneOf = (greatest, initial) => ({
  kind: "choice",
  least: 1,
  greatest,
  step: 1,
  initial,
  accept: (value) => (value >= 1 && value <= greatest ? value : null),
});

/** @param {number} least @param {number} greatest @param {number} step @returns {Parameter} */
const number = (least, greatest, step) => ({
  kind: "number",
  least,
  greatest,
  step,
  initial: 0,
  accept: (value) => clamp(Math.trunc(value / step) * step + 0, least, greatest),
});

/**
 * A number that older editors did not snap to a grid.
 *
 * @param {Omit<Parameter, "accept">} range
 * @returns {Parameter}
 */
const free = (range) => ({ ...range, accept: (value) => clamp(value, LEAST_WORD, GREATEST_WORD) });

/** @param {number} least @param {number} greatest @param {number} step @param {number} initial */
const threshold = (least, greatest, step, initial) => free({ kind: "threshold", least, greatest, step, initial });

/** @param {number} initial @returns {Parameter} */
const note = (initial) => ({
  kind: "note",
  least: 0,
  greatest: SILENCE + 2 * LENGTH_UNIT,
  step: 1,
  initial,
  accept: (value) => (value >= 0 && value % LENGTH_UNIT <= SILENCE && value < 128 * LENGTH_UNIT ? value : null),
});

/** @param {number} times @param {Parameter} parameter @returns {Parameter[]} */
const repeat = (times, parameter) => Array.from({ length: times }, () => parameter);

/** @type {BlockKind[]} */
const ALL = [
  kind("event", "button", [...repeat(5, choice(1)), choice(0, 2), choice(0, 11)]),
  kind("event", "prox", [...repeat(7, choice(2, 3)), threshold(700, 4000, 0, 1000), threshold(700, 4000, 0, 2000)], 7),
  kind(
    "event",
    "proxground",
    [...repeat(2, choice(2, 3)), threshold(0, 1023, 25, 400), threshold(0, 1023, 25, 450)],
    2,
  ),
  kind("event", "acc", [choice(0, 2), number(-6, 6, 1)]),
  kind("event", "clap", []),
  advanced(kind("event", "timeout", [])),
  extended(kind("event", "init", [])),
  extended(kind("event", "posture", [oneOf(3, 1)])),
  extended(kind("event", "groundmean", [oneOf(2, 1)])),
  advanced(kind("state", "statefilter", repeat(4, choice(2)))),
  extended(kind("condition", "counter", [oneOf(5, 3), number(0, 255, 1)])),
  kind("action", "move", repeat(2, number(-500, 500, 50))),
  kind("action", "colortop", repeat(3, number(0, 32, 1))),
  kind("action", "colorbottom", repeat(3, number(0, 32, 1))),
  kind("action", "sound", [259, 260, 515, 258, 257, 514].map(note)),
  advanced(kind("action", "timer", [free({ kind: "number", least: 0, greatest: 4000, step: 250, initial: 1 })])),
  advanced(kind("action", "setstate", repeat(4, choice(2)))),
  extended(kind("action", "setcounter", [oneOf(3, 2), { ...number(0, 255, 1), initial: 1 }])),
  extended(kind("action", "play", [number(0, 255, 1)])),
  extended(kind("action", "playstop", [])),
];

/**
 * A kind of basic mode.
 *
 * @param {BlockType} type
 * @param {string} name
 * @param {Parameter[]} parameters
 * @param {number} [conditions]
 * @returns {BlockKind}
 */
function kind(type, name, parameters, conditions = parameters.length) {
  return { type, name, parameters, conditions, mode: "basic" };
}

/** @param {BlockKind} kind @returns {BlockKind} */
function advanced(kind) {
  return { ...kind, mode: "advanced" };
}

/** @param {BlockKind} kind @returns {BlockKind} */
function extended(kind) {
  return { ...kind, mode: "extended" };
}

/** Block kinds by name, in the order of the palettes. @type {ReadonlyMap<string, BlockKind>} */
export const BLOCKS = new Map(ALL.map((each) => [each.name, each]));

/** The modes, each with everything of those before it. @type {readonly Mode[]} */
export const MODES = ["basic", "advanced", "extended"];

/** Whether a mode has what another one, or a later one, has. @param {Mode} mode @param {Mode} needed */
export function includes(mode, needed) {
  return MODES.indexOf(needed) <= MODES.indexOf(mode);
}
