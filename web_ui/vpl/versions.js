// The versions of VPL that wrote files, and what each generated differently (docs/vpl.md has them as a table).

/**
 * What differs between generators. `current` (below) is today's.
 *
 * @typedef {object} Generator
 * @property {"when" | "if"} test         `when`: a row runs once, when its condition becomes true; `if`: at every event
 * @property {boolean} merged             several actions in a row; false: a row for each action
 * @property {[number, number] | null} distance  thresholds of `prox`, low and high, or null: those of the block
 * @property {[number, number] | null} ground    the same of `proxground`; fixed ones are for `prox.ground.reflected`
 * @property {boolean} strict             thresholds are compared by < and >, not by <= and >=
 * @property {boolean} swapped            in the picture 1 means far or black, 2 near or white
 * @property {"set" | "all"} remember     handlers that end with the new state: those that set it, or all
 * @property {"rests" | "six"} melody     with rests and lengths of 7/60 s, or always six notes of 8/60 or 15/60 s
 * @property {string} report              event that is emitted when a row runs, or ""
 * @property {"plain" | "basic" | "state"} order  which rows without condition come first in a handler
 * @property {boolean} strictAngle        the lower bound of an angle is compared by >, not by >=
 * @property {number[]} center            commands of the remote control that mean its center key
 * @property {boolean} fixedHandlers      handlers have a fixed order, not that of their first row
 * @property {boolean} described          comments before all parts, not only before those of melodies
 * @property {string[]} wave      names of the two variables that compute the wave
 * @property {boolean} spaced             an empty line after each row
 */
/** @typedef {{ id: string, name: string, format: 0 | 1, generator: Generator }} Version */

/** @type {Readonly<Generator>} */
export const CURRENT = Object.freeze({
  test: "when",
  merged: true,
  distance: null,
  ground: null,
  strict: false,
  swapped: false,
  remember: "set",
  melody: "rests",
  report: "pair_run",
  order: "plain",
  strictAngle: false,
  center: [87, 13],
  fixedHandlers: true,
  described: true,
  wave: ["wave_phase", "wave_intensity"],
  spaced: true,
});

/** What each change took away, from the newest generator back to the oldest. */
const BEFORE_1_6_1 = { ...CURRENT, strictAngle: true };
const BEFORE_1_6 = { ...BEFORE_1_6_1, center: [87] };
/** @type {Generator} */
const BEFORE_1_5_4 = { ...BEFORE_1_6, fixedHandlers: false, remember: "all", order: "state", spaced: false };
const BEFORE_1_5 = { ...BEFORE_1_5_4, report: "", strict: true };
/** @type {Generator} */
const BEFORE_1_4 = { ...BEFORE_1_5, melody: "six" };
/** @type {Generator} */
const WITH_IF = { ...BEFORE_1_4, test: "if", order: "basic" };
const SWAPPED = { ...WITH_IF, swapped: true };
/** @type {Generator} */
const SINGLE = {
  ...WITH_IF,
  merged: false,
  described: false,
  wave: ["angle", "cos_result"],
  distance: [1500, 2500],
  ground: [150, 300],
};

/** The versions, newest first. @type {readonly Version[]} */
export const VERSIONS = [
  { id: "G10", name: "1.6.1", format: 1, generator: CURRENT },
  { id: "G9", name: "1.6.0, 2018", format: 1, generator: BEFORE_1_6_1 },
  { id: "G8", name: "1.5.5, 2016", format: 1, generator: BEFORE_1_6 },
  { id: "G7", name: "1.5.3, 2016", format: 1, generator: BEFORE_1_5_4 },
  { id: "G7", name: "2016-01", format: 1, generator: { ...BEFORE_1_5_4, report: "PairExecuted" } },
  { id: "G6", name: "1.4.0, 2015", format: 1, generator: BEFORE_1_5 },
  { id: "G5", name: "2015-07", format: 1, generator: BEFORE_1_4 },
  { id: "G4", name: "2015-06", format: 1, generator: WITH_IF },
  { id: "G3", name: "2014-03", format: 1, generator: SWAPPED },
  { id: "G3", name: "2014-02", format: 1, generator: { ...SWAPPED, wave: ["angle", "cos_result"] } },
  { id: "G2", name: "1.3.3, 2014", format: 0, generator: SINGLE },
  { id: "G1", name: "1.3.1, 2013", format: 0, generator: { ...SINGLE, distance: [400, 500] } },
];
