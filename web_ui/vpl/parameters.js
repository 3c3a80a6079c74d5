// What the editor of a block does: a click on one of its parts, a slider, a note. Each returns a new block.

import { BUTTONS, buttonBlock, kindOf, makeBlock, TAP } from "./blocks.js";
import { LENGTH_UNIT, SILENCE } from "./kinds.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./kinds.js").Parameter} Parameter */

/** The distance thresholds snap to a tenth of the nearest of these. */
const DECADES = [10, 100, 200, 500, 750, 1000, 2000, 4000];
const MODE = 5;
const KEY = 6;
const SHORT = 1;
const LONG = 2;

/** The greatest value of a choice in a mode. @param {Parameter} parameter @param {boolean} advanced */
function greatestOf({ greatest, advanced: inAdvanced = greatest }, advanced) {
  return advanced ? inAdvanced : greatest;
}

/**
 * The block after a click on a part with several states (button, square, quarter): its next state.
 *
 * @param {Block} block
 * @param {number} index   of the value
 * @param {boolean} advanced  whether the program is in advanced mode
 */
export function press(block, index, advanced) {
  const parameter = parameterOf(block, index, "choice");
  const next = block.values[index] >= greatestOf(parameter, advanced) ? parameter.least : block.values[index] + 1;
  return withValue(block, index, next);
}

/**
 * The block in one of its modes: `button` has 3 (buttons, arrows and keypad of the remote control), `acc` too
 * (tap, roll, pitch).
 *
 * @param {Block} block
 * @param {number} mode
 */
export function withBlockMode(block, mode) {
  if (block.name === "button") return mode === block.values[MODE] ? block : buttonBlock(mode);
  if (block.name !== "acc") throw new RangeError(`found block "${block.name}", expected button or acc`);
  return makeBlock("acc", [mode, mode === TAP ? 0 : block.values[1]]);
}

/** The button block with another key of the remote control. @param {Block} block @param {number} key */
export function withKey(block, key) {
  return block.values[MODE] === BUTTONS ? block : withValue(block, KEY, key);
}

/**
 * The block with a number of a slider: moved to the nearest step, kept in range, thresholds in order.
 *
 * @param {Block} block
 * @param {number} index
 * @param {number} value
 */
export function withNumber(block, index, value) {
  const { parameters } = kindOf(block);
  const parameter = parameters[index];
  if (parameter?.kind === "threshold") {
    const low = parameters.findIndex(({ kind }) => kind === "threshold");
    const snapped = snapThreshold(value, parameter);
    const other = index === low ? low + 1 : low;
    const pushed = index === low ? Math.max(block.values[other], snapped) : Math.min(block.values[other], snapped);
    return withValue(withValue(block, other, pushed), index, snapped);
  }
  const { least, greatest, step } = parameterOf(block, index, "number");
  return withValue(block, index, limit(Math.round(value / step) * step, least, greatest));
}

/**
 * The melody after a click in a column, on the line of a note. The note that is there becomes long, then silent; a
 * click on another line moves it; silence becomes a short note.
 *
 * @param {Block} block
 * @param {number} column  0 to 5
 * @param {number} note    0 (low) to 4 (high)
 */
export function withNote(block, column, note) {
  parameterOf(block, column, "note");
  const [present, length] = [block.values[column] % LENGTH_UNIT, Math.floor(block.values[column] / LENGTH_UNIT)];
  if (present === SILENCE) return withValue(block, column, note + SHORT * LENGTH_UNIT);
  if (present !== note) return withValue(block, column, note + length * LENGTH_UNIT);
  return withValue(block, column, (length === SHORT ? note : SILENCE) + LONG * LENGTH_UNIT);
}

/** @param {Block} block @param {number} index @param {number} value */
export function withValue(block, index, value) {
  if (block.values[index] === value) return block;
  return makeBlock(
    block.name,
    block.values.map((old, each) => (each === index ? value : old)),
  );
}

/**
 * Steps of thresholds are cut down, so that a cursor never passes a step.
 *
 * @param {number} value
 * @param {Parameter} parameter
 */
function snapThreshold(value, { least, greatest, step }) {
  const grid = step > 0 ? step : nearest(value) / 10;
  return limit(Math.floor(value / grid) * grid, least, greatest);
}

/** @param {number} value */
function nearest(value) {
  return DECADES.reduce((best, each) => (Math.abs(each - value) < Math.abs(best - value) ? each : best));
}

/** @param {number} value @param {number} least @param {number} greatest */
const limit = (value, least, greatest) => Math.min(Math.max(value, least), greatest);

/** @param {Block} block @param {number} index @param {Parameter["kind"]} wanted */
function parameterOf(block, index, wanted) {
  const parameter = kindOf(block).parameters[index];
  if (parameter?.kind !== wanted) throw new RangeError(`${block.name}: found value ${index}, expected a ${wanted}`);
  return parameter;
}
