// The text in front of the handlers: variables, the wave of melodies, the outputs at the start, the display of
// the state.

import { eventTest } from "./conditions.js";
import { blocksOf } from "./program.js";
import { isSounding } from "./statements.js";

/** @typedef {import("./program.js").Row} Row */
/** @typedef {import("./versions.js").Generator} Generator */

/** Statements that show the state on the circle of lights. */
export const STATE_DISPLAY = "call leds.circle(0,state[1]*32,0,state[3]*32,0,state[2]*32,0,state[0]*32)";

/**
 * Variables, and what runs at the start.
 *
 * @param {boolean} advanced
 * @param {readonly Readonly<Row>[]} rows  those that are generated
 * @param {Generator} generator
 * @returns {string[]} lines
 */
export function initialization(advanced, rows, generator) {
  const note = notes(generator);
  /** @param {string} name */
  const uses = (name) => rows.some((row) => blocksOf(row).some((block) => block.name === name));
  const states = ["var state[4] = [0,0,0,0]", "var new_state[4] = [0,0,0,0]", ""];
  return [
    ...(advanced ? [...note("variables for state"), ...states] : []),
    ...(isAngleNeeded(rows, generator) ? [...note("variable for angle"), "var angle"] : []),
    ...(uses("counter") || uses("setcounter") ? [...note("variable for the counter"), "var counter = 0"] : []),
    ...(isAnySounding(rows, generator) ? wave(generator) : []),
    ...(uses("timeout") ? [...note("stop timer 0"), "timer.period[0] = 0"] : []),
    ...(uses("clap") ? [...note("setup threshold for detecting claps"), "mic.threshold = 250"] : []),
    ...note("reset outputs"),
    "call sound.system(-1)",
    "call leds.top(0,0,0)",
    "call leds.bottom.left(0,0,0)",
    "call leds.bottom.right(0,0,0)",
    "call leds.circle(0,0,0,0,0,0,0,0)",
  ];
}

/**
 * The subroutine and the handler that rows rely on.
 *
 * @param {boolean} advanced
 * @param {readonly Readonly<Row>[]} rows
 * @param {Generator} generator
 * @returns {string[]} lines
 */
export function definitions(advanced, rows, generator) {
  const display = ["", ...notes(generator)("subroutine to display the current state"), "sub display_state"];
  return [
    ...(advanced ? [...display, `\t${STATE_DISPLAY}`] : []),
    ...(isAnySounding(rows, generator) ? nextNote(generator) : []),
  ];
}

/** Comments, where the generator writes them. @param {Generator} generator @returns {(text: string) => string[]} */
function notes({ described }) {
  return (text) => (described ? [`# ${text}`] : []);
}

/** @param {readonly Readonly<Row>[]} rows @param {Generator} generator */
function isAnySounding(rows, generator) {
  return rows.some(({ actions }) => actions.some((each) => isSounding(each, generator)));
}

/**
 * Whether rows compute an angle. Old versions compute the wave with the same variable.
 *
 * @param {readonly Readonly<Row>[]} rows
 * @param {Generator} generator
 */
function isAngleNeeded(rows, generator) {
  const tests = rows.flatMap(({ event, conditions }) => [event, ...conditions]).filter((block) => block !== null);
  if (isAnySounding(rows, generator) && generator.wave.includes("angle")) return false;
  return tests.some((block) => eventTest(block, generator).before.length > 0);
}

/** @param {Generator} generator */
function wave({ melody, wave: [phase, intensity] }) {
  const lines = ["# variables for notes", "var notes[6]", "var durations[6]", "var note_index = 6"];
  if (melody === "rests") lines.push("var note_count = 6");
  return [
    ...lines,
    "var wave[142]",
    "var i",
    `var ${phase}`,
    `var ${intensity}`,
    "",
    "# compute a sinus wave for sound",
    "for i in 0:141 do",
    `\t${phase} = (i-70)*468`,
    `\tcall math.cos(${intensity}, ${phase})`,
    `\twave[i] = ${intensity}/256`,
    "end",
    "call sound.wave(wave)",
  ];
}

/** @param {Generator} generator */
function nextNote(generator) {
  return [
    "",
    ...notes(generator)("when a note is finished, play the next note"),
    "onevent sound.finished",
    `\tif note_index != ${generator.melody === "rests" ? "note_count" : 6} then`,
    "\t\tcall sound.freq(notes[note_index], durations[note_index])",
    "\t\tnote_index += 1",
    "\tend",
  ];
}
