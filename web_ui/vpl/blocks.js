// The blocks of a program: a kind and its values. Immutable.

import { BLOCKS } from "./kinds.js";

/** @typedef {import("./kinds.js").BlockKind} BlockKind */
/** @typedef {import("./kinds.js").Mode} Mode */
/** @typedef {import("./kinds.js").Parameter} Parameter */
/** @typedef {{ readonly name: string, readonly values: readonly number[] }} Block */

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
/** @param {Block | string} block  a block or the name of its kind @returns {BlockKind} */
export function kindOf(block) {
  const name = typeof block === "string" ? block : block.name;
  const found = BLOCKS.get(name);
  if (found === undefined)
    throw new RangeError(`found block "${name}", expected one of ${[...BLOCKS.keys()].join(", ")}`);
  return found;
}

/** The key of the name of a block, for pupils. @param {Block | string} block */
export function nameKey(block) {
  return `block.${kindOf(block).name}`;
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
 * The first mode that has a block as it is. An empty state filter is in every mode: it has no effect.
 *
 * @param {Block} block
 * @returns {Mode}
 */
export function modeOf(block) {
  const { mode, type, parameters } = kindOf(block);
  if (type === "state") return hasCondition(block) ? mode : "basic";
  const beyond = parameters.some((parameter, index) => isBeyondBasic(parameter, block.values[index]));
  return mode === "basic" && beyond ? "advanced" : mode;
}

/**
 * Whether a block can be a further condition of a row: it is about something that lasts.
 *
 * @param {Block} block
 */
export function canBeCondition({ name, values }) {
  if (name === "button") return values[5] === BUTTONS;
  if (name === "acc") return values[0] !== TAP;
  return kindOf(name).type === "condition" || ["prox", "proxground", "posture", "groundmean"].includes(name);
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
