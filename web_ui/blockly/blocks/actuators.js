// Statements for motors, timers, sound and messages.

import { UNARY } from "../precedence.js";
import { choice, number } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./spec.js").Arg} Arg */
/** @typedef {import("./spec.js").Option} Option */

const STYLE = "actuator_blocks";

/** Command → parts of the speed of the left and the right wheel. @type {Record<string, readonly [number, number]>} */
const COMMANDS = {
  FORWARD: [1, 1],
  BACKWARD: [-1, -1],
  TURNLEFT: [0, 1],
  TURNRIGHT: [1, 0],
  TURNBACKWARDLEFT: [0, -1],
  TURNBACKWARDRIGHT: [-1, 0],
  SPINCCW: [-1, 1],
  SPINCW: [1, -1],
};

/** @type {readonly Option[]} */
const COMMAND_OPTIONS = [
  ["forward", "FORWARD"],
  ["backward", "BACKWARD"],
  ["left", "TURNLEFT"],
  ["right", "TURNRIGHT"],
  ["backward_left", "TURNBACKWARDLEFT"],
  ["backward_right", "TURNBACKWARDRIGHT"],
  ["spin_left", "SPINCCW"],
  ["spin_right", "SPINCW"],
];

/** The system sounds; a file has their number. @type {readonly Option[]} */
export const SYSTEM_SOUNDS = [
  "startup",
  "shutdown",
  "arrow_button",
  "center_button",
  "free_fall",
  "collision",
  "target_friendly",
  "target_detected",
].map((word, index) => [word, String(index)]);

/** @param {string} type @param {Arg[]} args @param {BlockSpec["statement"]} statement @returns {BlockSpec} */
const block = (type, args, statement) => ({ type, shape: "statement", style: STYLE, args, statement });

/**
 * A statement that sets a variable of the robot.
 *
 * @param {string} type
 * @param {string} target  the variable, or the field that names it
 * @param {number} shadow
 * @param {Arg[]} [fields]
 */
const assignment = (type, target, shadow, fields = []) =>
  block(type, [...fields, number("VALUE", shadow)], (g, each) => {
    const name = fields.length > 0 ? g.field(each, target) : target;
    return [g.line(each, `${name} = ${g.number(each, "VALUE")}`)];
  });

/** @type {readonly BlockSpec[]} */
export const ACTUATORS = [
  block("thymio_motors_start", [choice("COMMAND", "drive", COMMAND_OPTIONS), number("SPEED", 300)], (g, each) => {
    const parts = COMMANDS[g.field(each, "COMMAND")];
    const speeds = parts.map((part) => {
      if (part === 0) return "0";
      return part > 0 ? g.number(each, "SPEED") : `-${g.number(each, "SPEED", UNARY)}`;
    });
    return [g.line(each, `motor.left.target = ${speeds[0]}`), g.line(each, `motor.right.target = ${speeds[1]}`)];
  }),
  block("thymio_motors_stop", [], (g, each) => [
    g.line(each, "motor.left.target = 0"),
    g.line(each, "motor.right.target = 0"),
  ]),
  assignment("thymio_actuator_motor", "VARIABLE", 0, [
    choice("VARIABLE", "motor", [
      ["left", "motor.left.target"],
      ["right", "motor.right.target"],
    ]),
  ]),
  assignment("thymio_actuator_timer", "VARIABLE", 1000, [
    choice("VARIABLE", "timer", [
      ["first", "timer.period[0]"],
      ["second", "timer.period[1]"],
    ]),
  ]),
  assignment("thymio_actuator_mic", "mic.threshold", 40),
  assignment("thymio_actuator_comm", "prox.comm.tx", 0),
  block(
    "thymio_communication",
    [
      choice("MODE", "switch", [
        ["enable", "ENABLE"],
        ["disable", "DISABLE"],
      ]),
    ],
    (g, each) => [g.line(each, `call prox.comm.enable(${g.field(each, "MODE") === "DISABLE" ? 0 : 1})`)],
  ),
  block("thymio_sound_system", [choice("SOUND", "system_sound", SYSTEM_SOUNDS)], (g, each) => [
    g.line(each, `call sound.system(${g.field(each, "SOUND")})`),
  ]),
  block("thymio_sound_note", [number("FREQ", 440), number("DURATION", 10)], (g, each) => [
    g.line(each, `call sound.freq(${g.number(each, "FREQ")}, ${g.number(each, "DURATION")})`),
  ]),
  block("thymio_sound_stop", [], (g, each) => [g.line(each, "call sound.system(-1)")]),
];
