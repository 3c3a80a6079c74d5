// The blocks of VPL: their parameters, ranges and defaults. Values have the order of the attributes value0,
// value1, … in files.

/** @typedef {"event" | "state" | "action"} BlockType */
/** @typedef {{ readonly name: string, readonly values: readonly number[] }} Block */
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
 * @property {boolean} advanced  whether the block exists in advanced mode only
 * @property {readonly Parameter[]} parameters
 * @property {number} conditions  number of leading values that make a condition if one of them is above 0
 */

/** Number that stands for silence in the notes of a melody; 0 to 4 are notes. */
export const SILENCE = 5;
/** A value of a melody is note + 256 · length. */
export const LENGTH_UNIT = 256;
/** Modes of the button block. */
export const BUTTONS = 0;
export const ARROWS = 1;
export const KEYPAD = 2;
/** Selected key at first, by mode of the button block, and their number. */
const FIRST_KEY = [0, 4, 0];
const KEYS = [1, 5, 12];
/** Modes of the accelerometer block. */
export const TAP = 0;
export const ROLL = 1;
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
  kind("event", "timeout", [], 0, true),
  kind("state", "statefilter", repeat(4, choice(2)), 4, true),
  kind("action", "move", repeat(2, number(-500, 500, 50))),
  kind("action", "colortop", repeat(3, number(0, 32, 1))),
  kind("action", "colorbottom", repeat(3, number(0, 32, 1))),
  kind("action", "sound", [259, 260, 515, 258, 257, 514].map(note)),
  kind("action", "timer", [free({ kind: "number", least: 0, greatest: 4000, step: 250, initial: 1 })], 1, true),
  kind("action", "setstate", repeat(4, choice(2)), 4, true),
];

/**
 * @param {BlockType} type
 * @param {string} name
 * @param {Parameter[]} parameters
 * @param {number} [conditions]
 * @param {boolean} [advanced]
 * @returns {BlockKind}
 */
function kind(type, name, parameters, conditions = parameters.length, advanced = false) {
  return { type, name, parameters, conditions, advanced };
}

/** Block kinds by name, in the order of the palettes. @type {ReadonlyMap<string, BlockKind>} */
export const BLOCKS = new Map(ALL.map((each) => [each.name, each]));

/** @param {Block | string} block  a block or the name of its kind @returns {BlockKind} */
export function kindOf(block) {
  const name = typeof block === "string" ? block : block.name;
  const found = BLOCKS.get(name);
  if (found === undefined)
    throw new RangeError(`found block "${name}", expected one of ${[...BLOCKS.keys()].join(", ")}`);
  return found;
}

/**
 * A block with these values; missing and impossible ones are the defaults.
 *
 * @param {string} name
 * @param {readonly (number | undefined)[]} [values]
 * @returns {Block}
 */
export function makeBlock(name, values = []) {
  const { parameters } = kindOf(name);
  const accepted = parameters.map(({ accept, initial }, index) => {
    const value = values[index];
    return value === undefined || !Number.isFinite(value) ? initial : (accept(Math.trunc(value)) ?? initial);
  });
  return Object.freeze({ name, values: Object.freeze(consistent(name, accepted)) });
}

/**
 * The values with those at rest that the mode of the block does not use.
 *
 * @param {string} name
 * @param {number[]} values
 */
function consistent(name, values) {
  if (name === "acc" && values[0] === TAP) return [TAP, 0];
  if (name !== "button") return values;
  const [mode, key] = [values[5], values[6]];
  if (mode === BUTTONS) return [...values.slice(0, 6), 0];
  return [0, 0, 0, 0, 0, mode, key < KEYS[mode] ? key : FIRST_KEY[mode]];
}

/** The block with the key that is selected first in a mode of the button block. @param {number} mode */
export function buttonBlock(mode) {
  return makeBlock("button", [0, 0, 0, 0, 0, mode, FIRST_KEY[mode]]);
}

/** Whether a block has a condition, which its event must fulfill. @param {Block | null} block */
export function hasCondition(block) {
  return block !== null && block.values.slice(0, kindOf(block).conditions).some((value) => value > 0);
}

/**
 * Whether a block exists in advanced mode only, as it is. An empty state filter is none: it has no effect.
 *
 * @param {Block | null} block
 */
export function isAdvanced(block) {
  if (block === null) return false;
  const { name, values } = block;
  if (name === "statefilter") return hasCondition(block);
  const { advanced, parameters } = kindOf(block);
  return advanced || parameters.some((parameter, index) => isBeyondBasic(parameter, values[index]));
}

/** @param {Parameter} parameter @param {number} value */
function isBeyondBasic({ kind, greatest, initial }, value) {
  if (kind === "threshold") return value !== initial;
  return kind === "choice" && value > greatest;
}

/** @param {Block | null} a @param {Block | null} b */
export function sameBlock(a, b) {
  if (a === null || b === null) return a === b;
  return (
    a.name === b.name &&
    a.values.length === b.values.length &&
    a.values.every((value, index) => value === b.values[index])
  );
}
