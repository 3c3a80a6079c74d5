// Values of the sensors.

import { choice, numberValue } from "../../blocks/spec.js";
import { MULTIPLY } from "../../precedence.js";

/** @typedef {import("../../blocks/spec.js").BlockSpec} BlockSpec */
/** @typedef {import("../../blocks/spec.js").Arg} Arg */
/** @typedef {import("../../blocks/spec.js").Option} Option */
/** @typedef {import("../../blocks/spec.js").Value} Value */

/** Aseba's word for a button, Scratch's value. @type {readonly Option[]} */
export const BUTTON_MENU = [
  ["center", "center"],
  ["forward", "front"],
  ["backward", "back"],
  ["left", "left"],
  ["right", "right"],
];

const SENSORS = ["front_left", "middle_left", "middle", "middle_right", "front_right", "back_left", "back_right"];

/** @param {readonly string[]} words @returns {readonly Option[]} */
const numbered = (words) => words.map((word, index) => [word, String(index)]);

/** @param {string} type @param {Arg[]} args @param {NonNullable<BlockSpec["value"]>} value @returns {BlockSpec} */
const reporter = (type, args, value) => ({ type, shape: "Number", style: "sensing_blocks", sensor: true, args, value });

/** @param {string} type @param {string} variable @param {readonly string[]} words @param {string} [initial] */
const element = (type, variable, words, initial = "0") =>
  reporter(type, [choice("N", "sensor", numbered(words), initial)], (g, block) =>
    numberValue(`${variable}[${g.field(block, "N")}]`),
  );

const GROUND = ["ground_left", "ground_right"];

/** @type {readonly BlockSpec[]} */
export const SENSING = [
  // a condition in Scratch, a number in earlier versions of this project
  {
    ...reporter("thymio_valButton", [choice("B", "button", BUTTON_MENU)], (g, block) => {
      const word = BUTTON_MENU.find(([, value]) => value === g.field(block, "B"))?.[0];
      return numberValue(`button.${word}`);
    }),
    anywhere: true,
  },
  element("thymio_proximity", "prox.horizontal", SENSORS, "2"),
  element("thymio_proxHorizontal", "prox.horizontal", SENSORS),
  element("thymio_ground", "prox.ground.delta", GROUND),
  element("thymio_proxGroundDelta", "prox.ground.delta", GROUND),
  reporter("thymio_micIntensity", [], () => numberValue("mic.intensity")),
  // the unit of `setMotor`
  reporter(
    "thymio_motor",
    [
      choice("M", "motor", [
        ["left", "left"],
        ["right", "right"],
      ]),
    ],
    (g, block) => numberValue(`motor.${g.field(block, "M")}.speed * 5 / 16`, MULTIPLY),
  ),
];
