// Values and conditions of the sensors.

import { COMPARE } from "../precedence.js";
import { BUTTONS, GROUND, GROUND_MODES, HORIZONTAL, PROXIMITY_MODES, ground, proximity } from "./robot.js";
import { booleanValue, choice, numberValue } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./spec.js").Arg} Arg */
/** @typedef {import("./spec.js").Generator} Generator */
/** @typedef {import("./spec.js").BlockState} BlockState */

/**
 * @param {string} type
 * @param {Arg[]} args
 * @param {(g: Generator, block: BlockState) => string} code
 * @returns {BlockSpec}
 */
const check = (type, args, code) => ({
  type,
  shape: "Boolean",
  style: "sensor_check_blocks",
  sensor: true,
  args,
  value: (g, block) => booleanValue(code(g, block), COMPARE),
});

/**
 * A value that is a variable of the robot.
 *
 * @param {string} type
 * @param {string} variable  the variable, or the field that names it
 * @param {Arg[]} [args]
 * @returns {BlockSpec}
 */
const reading = (type, variable, args = []) => ({
  type,
  shape: "Number",
  style: "sensor_blocks",
  sensor: true,
  args,
  value: (g, block) => numberValue(args.length > 0 ? g.field(block, variable) : variable),
});

/** @type {readonly BlockSpec[]} */
export const SENSORS = [
  check(
    "thymio_button_pressed",
    [choice("BUTTON", "button", BUTTONS)],
    (g, block) => `${g.field(block, "BUTTON")} == 1`,
  ),
  check(
    "thymio_prox_check",
    [choice("SENSOR", "sensor", HORIZONTAL), choice("MODE", "near", PROXIMITY_MODES)],
    (g, block) => proximity(g.field(block, "SENSOR"), g.field(block, "MODE")),
  ),
  check(
    "thymio_prox_ground_check",
    [choice("SENSOR", "sensor", GROUND), choice("MODE", "ground", GROUND_MODES)],
    (g, block) => ground(g.field(block, "SENSOR"), g.field(block, "MODE")),
  ),
  reading("thymio_sensor_prox", "SENSOR", [choice("SENSOR", "sensor", [...HORIZONTAL, ...GROUND])]),
  reading("thymio_sensor_motor", "SENSOR", [
    choice("SENSOR", "motor", [
      ["left", "motor.left.speed"],
      ["right", "motor.right.speed"],
    ]),
  ]),
  reading("thymio_sensor_acc", "SENSOR", [
    choice("SENSOR", "axis", [
      ["left_right", "acc[0]"],
      ["front_back", "acc[1]"],
      ["up_down", "acc[2]"],
    ]),
  ]),
  reading("thymio_sensor_temperature", "temperature"),
  reading("thymio_sensor_mic", "mic.intensity"),
  reading("thymio_sensor_comm", "prox.comm.rx"),
  reading("thymio_sensor_rc", "SENSOR", [
    choice("SENSOR", "remote_control", [
      ["address", "rc5.address"],
      ["command", "rc5.command"],
    ]),
  ]),
];
