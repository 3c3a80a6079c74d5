// Statements that call functions of the robot for which Thymio Blockly has no blocks. Programs of VPL that are shown as
// blocks need them; the toolbox does not offer them.

import { call, number, variable } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */

/**
 * A statement that computes the number of a variable.
 *
 * @param {string} name  of the function
 * @param {readonly string[]} inputs
 * @returns {BlockSpec}
 */
const computation = (name, inputs) => ({
  type: `thymio_math_${name}`,
  shape: "statement",
  style: "math_blocks",
  args: [variable("VAR", "angle"), ...inputs.map((input) => number(input, 0))],
  statement(g, block) {
    const values = inputs.map((input) => g.number(block, input));
    return [g.line(block, call(`math.${name}`, [g.scalar(block, "VAR"), ...values]))];
  },
});

/** @type {readonly BlockSpec[]} */
export const NATIVES = [
  computation("cos", ["ANGLE"]),
  computation("atan2", ["Y", "X"]),
  {
    type: "thymio_sound_wave",
    shape: "statement",
    style: "actuator_blocks",
    args: [variable("VAR", "wave")],
    statement: (g, block) => [g.line(block, call("sound.wave", [g.variable(block, "VAR")]))],
  },
];
