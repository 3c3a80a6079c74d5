// What event blocks and state filters mean in Aseba: the event, and the conditions of a row.

import { ARROWS, BUTTONS, hasCondition, ROLL, TAP } from "./blocks.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./versions.js").Generator} Generator */
/**
 * @typedef {object} EventTest
 * @property {string} event     the Aseba event
 * @property {string[]} before  statements in front of the test
 * @property {string} condition  "" if the row runs at every event
 * @property {boolean} edge     whether the row runs only when the condition becomes true
 */

const BUTTON_NAMES = ["forward", "left", "backward", "right", "center"];
/** Commands of the remote control, by key of the arrows; those of the center depend on the version. */
const ARROW_COMMANDS = [
  [80, 32],
  [85, 17, 77],
  [81, 33],
  [86, 16, 78],
];
/** Commands of the keypad, row by row. */
const KEYPAD_COMMANDS = [1, 2, 3, 4, 5, 6, 7, 8, 9, 17, 0, 16];
/** 90° in the angles of Aseba. */
const RIGHT_ANGLE = 16384;
/** Orientations are multiples of 15°: 6 of them are 90°. */
const GREATEST_ORIENTATION = 6;
/** Half of 15°. */
const HALF_STEP = 1365;
/** States of the squares of sensors; 0 is ignored, and 3, between, is none of these. */
const NEAR = 1;
const FAR = 2;

/** Event of the rows that run once, at the start; it has no handler. */
export const START = "";
/** Postures of extended mode. */
const ON_A_SIDE = 1;
const UPSIDE_DOWN = 2;
const COMPARISONS = ["", "<=", "<", "==", ">", ">="];

/** @type {Record<string, (block: Block, generator: Generator) => Partial<EventTest> & { event: string }>} */
const EVENTS = {
  button: ({ values }, { center }) => {
    const [mode, key] = [values[5], values[6]];
    if (mode !== BUTTONS) {
      const commands = mode === ARROWS ? [...ARROW_COMMANDS, center][key] : [KEYPAD_COMMANDS[key]];
      return { event: "rc5", condition: commands.map((each) => `rc5.command == ${each}`).join(" or "), edge: false };
    }
    const pressed = BUTTON_NAMES.filter((_name, index) => values[index] > 0);
    return { event: "buttons", condition: all(pressed.map((name) => `button.${name} == 1`)) };
  },
  prox: ({ values }, generator) => {
    const limits = generator.distance ?? [values[7], values[8]];
    return { event: "prox", condition: squares("prox.horizontal", values.slice(0, 7), limits, generator) };
  },
  proxground: ({ values }, generator) => {
    const variable = generator.ground === null ? "prox.ground.delta" : "prox.ground.reflected";
    const limits = generator.ground ?? [values[2], values[3]];
    return { event: "prox", condition: squares(variable, values.slice(0, 2), limits, generator) };
  },
  acc: ({ values: [mode, orientation] }, { strictAngle }) => {
    if (mode === TAP) return { event: "tap" };
    const [axis, middle] = mode === ROLL ? ["acc[0]", -orientation] : ["acc[1]", orientation];
    return { event: "acc", before: [angleOf(axis)], condition: angleCondition(middle, strictAngle) };
  },
  clap: () => ({ event: "mic" }),
  timeout: () => ({ event: "timer0" }),
  init: () => ({ event: START }),
  posture: ({ values: [posture] }) => {
    if (posture === ON_A_SIDE) {
      const condition = `abs(abs(angle) - ${RIGHT_ANGLE}) < ${HALF_STEP}`;
      return { event: "acc", before: [angleOf("acc[0]")], condition };
    }
    if (posture === UPSIDE_DOWN) return { event: "acc", condition: "-acc[2] / 2 > abs(acc[0]) + abs(acc[1])" };
    return { event: "acc", condition: "abs(acc[0]) + abs(acc[1]) + abs(acc[2]) < 16" };
  },
  groundmean: ({ values: [presence] }) => {
    const sum = "prox.ground.delta[0] + prox.ground.delta[1]";
    return { event: "prox", condition: presence === NEAR ? `${sum} >= 900` : `${sum} <= 800` };
  },
  counter: ({ values: [comparison, value] }) => ({
    event: START,
    condition: `counter ${COMPARISONS[comparison]} ${value}`,
  }),
};

/** The statement that computes an angle. @param {string} axis */
const angleOf = (axis) => `call math.atan2(angle, ${axis}, acc[2])`;

/**
 * What an event block, or a further condition of a row, tests.
 *
 * @param {Block} block
 * @param {Generator} generator
 * @returns {EventTest}
 */
export function eventTest(block, generator) {
  return { before: [], condition: "", edge: true, ...EVENTS[block.name](block, generator) };
}

/** The condition of a state filter, "" if there is none. @param {Block | null} filter */
export function stateCondition(filter) {
  if (filter === null || !hasCondition(filter)) return "";
  return all(
    filter.values.flatMap((value, index) => (value === 0 ? [] : [`state[${index}] == ${value === 1 ? 1 : 0}`])),
  );
}

/** All of these conditions; "" is none. @param {string[]} conditions */
export const all = (conditions) => conditions.filter((each) => each !== "").join(" and ");

/**
 * @param {string} variable
 * @param {readonly number[]} states   of its sensors
 * @param {readonly number[]} limits   low and high
 * @param {Generator} generator
 */
function squares(variable, states, [low, high], { strict, swapped }) {
  const [less, greater] = strict ? ["<", ">"] : ["<=", ">="];
  const near = swapped ? FAR : NEAR;
  const far = swapped ? NEAR : FAR;
  return all(
    states.flatMap((state, index) => {
      const sensor = `${variable}[${index}]`;
      if (state === 0) return [];
      if (state === near) return [`${sensor} ${greater} ${high}`];
      if (state === far) return [`${sensor} ${less} ${low}`];
      return strict ? [`${sensor} > ${low}`, `${sensor} < ${high}`] : [`${sensor} >= ${low}`, `${sensor} <= ${high}`];
    }),
  );
}

/**
 * The angle is within half a step of an orientation; at the ends one bound is enough.
 *
 * @param {number} orientation
 * @param {boolean} strict
 */
function angleCondition(orientation, strict) {
  const middle = Math.trunc((orientation * RIGHT_ANGLE) / GREATEST_ORIENTATION);
  const lower = orientation > -GREATEST_ORIENTATION ? [`angle ${strict ? ">" : ">="} ${middle - HALF_STEP}`] : [];
  const upper = orientation < GREATEST_ORIENTATION ? [`angle < ${middle + HALF_STEP}`] : [];
  return all([...lower, ...upper]);
}
