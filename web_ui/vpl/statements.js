// What action blocks mean in Aseba: the statements of a row.

import { hasCondition } from "./blocks.js";
import { LENGTH_UNIT, SILENCE } from "./kinds.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./versions.js").Generator} Generator */

/** Frequencies of the notes and of silence, in Hz. */
const FREQUENCIES = [262, 311, 370, 440, 524, 0];
/** Length of a short note in sixtieths of a second. */
const SHORT = 7;

const GREATEST_COUNT = 255;
/** Set, add, subtract; the counter stays from 0 to 255. @type {Record<number, (value: number) => string[]>} */
const COUNTER_OPERATIONS = {
  1: (value) => [`counter = ${value}`],
  2: (value) => [`counter = counter + ${value}`, ...limited(">", GREATEST_COUNT)],
  3: (value) => [`counter = counter - ${value}`, ...limited("<", 0)],
};

/** @type {Record<string, (values: readonly number[], generator: Generator) => string[]>} */
const ACTIONS = {
  move: ([left, right]) => [`motor.left.target = ${left}`, `motor.right.target = ${right}`],
  colortop: (color) => [`call leds.top(${color.join(",")})`],
  colorbottom: (color) => [`call leds.bottom.left(${color.join(",")})`, `call leds.bottom.right(${color.join(",")})`],
  sound: (values, { melody }) => (melody === "six" ? sixNotes(values) : notesAndRests(values)),
  timer: ([milliseconds]) => [`timer.period[0] = ${milliseconds}`],
  setstate: (values) =>
    values.flatMap((value, index) => (value === 0 ? [] : [`new_state[${index}] = ${value === 1 ? 1 : 0}`])),
  setcounter: ([operation, value]) => COUNTER_OPERATIONS[operation](value),
  play: ([number]) => [`call sound.play(${number})`],
  playstop: () => ["call sound.play(-1)"],
};

/** @param {Block} block @param {Generator} generator */
export function actionStatements(block, generator) {
  return ACTIONS[block.name](block.values, generator);
}

/** @param {string} beyond @param {number} limit */
function limited(beyond, limit) {
  return [`if counter ${beyond} ${limit} then`, `\tcounter = ${limit}`, "end"];
}

/**
 * Whether an action plays notes, and so needs the variables of melodies.
 *
 * @param {Block} block
 * @param {Generator} generator
 */
export function isSounding(block, { melody }) {
  return block.name === "sound" && (melody === "six" || heard(block.values).length > 0);
}

/** Whether an action sets a state. @param {Block} block */
export function setsState(block) {
  return block.name === "setstate" && hasCondition(block);
}

/** @param {number} value @returns {{ note: number, length: number }} */
function decodeNote(value) {
  return { note: value % LENGTH_UNIT, length: Math.floor(value / LENGTH_UNIT) };
}

/** The notes without rests at the end; consecutive rests are one. @param {readonly number[]} values */
function heard(values) {
  /** @type {{ note: number, length: number }[]} */ const notes = [];
  for (const { note, length } of values.map(decodeNote)) {
    const last = notes.at(-1);
    if (note === SILENCE && last?.note === SILENCE) last.length += length;
    else notes.push({ note, length });
  }
  if (notes.at(-1)?.note === SILENCE) notes.pop();
  return notes;
}

/** @param {readonly number[]} values */
function notesAndRests(values) {
  const notes = heard(values);
  if (notes.length === 0) return ["# zero notes in sound block"];
  const part = `[0:${notes.length - 1}]`;
  return [
    `call math.copy(notes${part}, ${list(notes.map(({ note }) => FREQUENCIES[note]))})`,
    `call math.copy(durations${part}, ${list(notes.map(({ length }) => (length === 0 ? -1 : SHORT * length)))})`,
    "note_index = 1",
    `note_count = ${notes.length}`,
    "call sound.freq(notes[0], durations[0])",
  ];
}

/** The melody of versions before 1.4: six notes, each a sixtieth longer. @param {readonly number[]} values */
function sixNotes(values) {
  const notes = values.map(decodeNote);
  return [
    `call math.copy(notes, ${list(notes.map(({ note }) => FREQUENCIES[note]))})`,
    `call math.copy(durations, ${list(notes.map(({ length }) => SHORT * length + 1))})`,
    "call sound.freq(notes[0], durations[0])",
    "note_index = 1",
  ];
}

/** @param {number[]} numbers */
const list = (numbers) => `[${numbers.join(", ")}]`;
