// Programs to begin with: the exercises of every language, and one for each family of blocks.

import { makeBlock } from "../blocks.js";
import { newVpl } from "../file.js";
import { generateSource } from "../generator.js";
import { makeProgram, makeRow } from "../program.js";

/** @typedef {import("../kinds.js").Mode} Mode */
/** @typedef {[name: string, ...values: number[]]} Written   a block */
/** @typedef {{ when: Written, state?: Written, and?: Written[], do: Written[] }} WrittenRow */

const RED = /** @type {const} */ ([32, 0, 0]);
const GREEN = /** @type {const} */ ([0, 32, 0]);
const BLUE = /** @type {const} */ ([0, 0, 32]);
const YELLOW = /** @type {const} */ ([32, 32, 0]);
const NEAR = 1;
const FAR = 2;

/** @param {number} index @returns {Written} */
const pressed = (index) => ["button", ...[0, 1, 2, 3, 4].map((each) => Number(each === index)), 0, 0];
/** @param {number} key  arrow of the remote control @returns {Written} */
const remote = (key) => ["button", 0, 0, 0, 0, 0, 1, key];
/** @param {number[]} states  of the seven sensors @returns {Written} */
const near = (...states) => ["prox", ...states];
/** @param {readonly [number, number, number]} color @returns {Written} */
const top = (color) => ["colortop", ...color];
/** @param {readonly [number, number, number]} color @returns {Written} */
const underside = (color) => ["colorbottom", ...color];

/** @type {Record<string, { mode: Mode, rows: WrittenRow[] }>} */
const SAMPLES = {
  empty: { mode: "basic", rows: [] },
  avoid: {
    mode: "basic",
    rows: [
      { when: near(FAR, 0, FAR, 0, FAR), do: [["move", 200, 200], top(GREEN)] },
      { when: near(NEAR), do: [["move", 200, -200], top(RED)] },
      { when: near(0, 0, NEAR), do: [["move", 200, -200], top(RED)] },
      { when: near(0, 0, 0, 0, NEAR), do: [["move", 200, -200], top(RED)] },
    ],
  },
  line: {
    mode: "basic",
    rows: [
      { when: ["proxground", FAR, FAR], do: [["move", 100, 100], underside(GREEN)] },
      { when: ["proxground", FAR, NEAR], do: [["move", 0, 100], underside(YELLOW)] },
      { when: ["proxground", NEAR, FAR], do: [["move", 100, 0], underside(YELLOW)] },
    ],
  },
  buttons: {
    mode: "basic",
    rows: [
      { when: pressed(0), do: [["move", 300, 300], top(GREEN)] },
      { when: pressed(1), do: [["move", -150, 150], top(YELLOW)] },
      { when: pressed(2), do: [["move", -300, -300], top(BLUE)] },
      { when: pressed(3), do: [["move", 150, -150], top(YELLOW)] },
      { when: pressed(4), do: [["move", 0, 0], top(RED)] },
    ],
  },
  music: {
    mode: "basic",
    rows: [
      { when: ["acc", 0, 0], do: [["sound", 256, 257, 258, 259, 516, 517], top(BLUE)] },
      { when: ["clap"], do: [["sound", 260, 259, 258, 257, 512, 517], underside(RED)] },
    ],
  },
  timer: {
    mode: "advanced",
    rows: [
      { when: pressed(4), do: [top(YELLOW), ["timer", 1000]] },
      { when: ["timeout"], state: ["statefilter", 2], do: [top(RED), ["timer", 2000], ["setstate", 1]] },
      { when: ["timeout"], state: ["statefilter", 1], do: [top(GREEN), ["timer", 2000], ["setstate", 2]] },
    ],
  },
  states: {
    mode: "advanced",
    rows: [
      { when: pressed(4), state: ["statefilter", 2], do: [["setstate", 1], ["move", 200, 200], top(GREEN)] },
      { when: pressed(4), state: ["statefilter", 1], do: [["setstate", 2], ["move", 0, 0], top(RED)] },
    ],
  },
  remote: {
    mode: "advanced",
    rows: [
      { when: remote(0), do: [["move", 300, 300]] },
      { when: remote(1), do: [["move", -150, 150]] },
      { when: remote(2), do: [["move", -300, -300]] },
      { when: remote(3), do: [["move", 150, -150]] },
      { when: remote(4), do: [["move", 0, 0]] },
    ],
  },
  tilt: {
    mode: "advanced",
    rows: [
      { when: ["acc", 1, 0], do: [top(GREEN)] },
      { when: ["acc", 1, 3], do: [top(RED), ["sound", 260, 773, 773, 773, 773, 773]] },
      { when: ["acc", 1, -3], do: [top(BLUE), ["sound", 256, 773, 773, 773, 773, 773]] },
    ],
  },
  counter: {
    mode: "extended",
    rows: [
      { when: ["init"], do: [["setcounter", 1, 0], top(BLUE)] },
      { when: pressed(4), do: [["setcounter", 2, 1]] },
      { when: pressed(0), and: [["counter", 5, 3]], do: [["move", 200, 200], top(GREEN)] },
      { when: pressed(2), do: [["move", 0, 0], ["setcounter", 1, 0], top(BLUE)] },
    ],
  },
};

/** @param {Written} written */
const block = ([name, ...values]) => makeBlock(name, values);

/** The file of a sample. @param {string} name */
export function sampleText(name) {
  const { mode, rows } = SAMPLES[name];
  const program = makeProgram(
    mode,
    rows.map(({ when, state, and = [], do: actions }) =>
      makeRow({
        event: block(when),
        state: state === undefined ? null : block(state),
        conditions: and.map(block),
        actions: actions.map(block),
      }),
    ),
  );
  return newVpl(program, generateSource(program).text);
}
