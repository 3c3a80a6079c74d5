// The text in front of the handlers: variables, the wave of melodies, the outputs at the start, the display of
// the state.

import { isSounding } from "./statements.js";

/** @typedef {import("./program.js").Row} Row */
/** @typedef {import("./versions.js").Generator} Generator */

const STATE_DISPLAY = "call leds.circle(0,state[1]*32,0,state[3]*32,0,state[2]*32,0,state[0]*32)";

/**
 * @param {boolean} advanced
 * @param {readonly Readonly<Row>[]} rows  those that are generated
 * @param {Generator} generator
 * @returns {string[]} lines
 */
export function preamble(advanced, rows, generator) {
  /** @param {string} name */
  const uses = (name) => rows.some(({ event }) => event?.name === name);
  const measuresAngle = rows.some(({ event }) => event?.name === "acc" && event.values[0] > 0);
  const sounding = rows.some(({ actions }) => actions.some((each) => isSounding(each, generator)));
  /** A comment, where the generator writes them. @param {string} text */
  const note = (text) => (generator.described ? [`# ${text}`] : []);
  return [
    ...(advanced
      ? [...note("variables for state"), "var state[4] = [0,0,0,0]", "var new_state[4] = [0,0,0,0]", ""]
      : []),
    ...(measuresAngle ? [...note("variable for angle"), "var angle"] : []),
    ...(sounding ? wave(generator) : []),
    ...(uses("timeout") ? [...note("stop timer 0"), "timer.period[0] = 0"] : []),
    ...(uses("clap") ? [...note("setup threshold for detecting claps"), "mic.threshold = 250"] : []),
    ...note("reset outputs"),
    "call sound.system(-1)",
    "call leds.top(0,0,0)",
    "call leds.bottom.left(0,0,0)",
    "call leds.bottom.right(0,0,0)",
    "call leds.circle(0,0,0,0,0,0,0,0)",
    ...(advanced
      ? ["", ...note("subroutine to display the current state"), "sub display_state", `\t${STATE_DISPLAY}`]
      : []),
    ...(sounding ? nextNote(generator) : []),
  ];
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
function nextNote({ melody, described }) {
  return [
    "",
    ...(described ? ["# when a note is finished, play the next note"] : []),
    "onevent sound.finished",
    `\tif note_index != ${melody === "rests" ? "note_count" : 6} then`,
    "\t\tcall sound.freq(notes[note_index], durations[note_index])",
    "\t\tnote_index += 1",
    "\tend",
  ];
}
