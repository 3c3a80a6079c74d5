// Statements for the lights. Intensities are 0 to 32.

import { LEDS, RGB_LEDS } from "./robot.js";
import { call, choice, color, number } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./spec.js").Arg} Arg */

const STYLE = "led_blocks";
const FULL = 32;

/**
 * A light whose native function takes one intensity per input.
 *
 * @param {string} type
 * @param {string} native  the function, or the field that names it
 * @param {readonly string[]} inputs
 * @param {Arg[]} [fields]
 * @returns {BlockSpec}
 */
const intensities = (type, native, inputs, fields = []) => ({
  type,
  shape: "statement",
  style: STYLE,
  args: [...fields, ...inputs.map((name) => number(name, FULL))],
  statement(g, block) {
    const name = fields.length > 0 ? g.field(block, native) : native;
    return [
      g.line(
        block,
        call(
          name,
          inputs.map((input) => g.number(block, input)),
        ),
      ),
    ];
  },
});

/** @param {string} name @param {number} count */
const numbered = (name, count) => Array.from({ length: count }, (_, index) => `${name}${index}`);

/** A color of a file as intensities. @param {string} hex  such as "#ff0000" */
export function intensitiesOf(hex) {
  return [1, 3, 5].map((at) => Math.round(parseInt(hex.slice(at, at + 2), 16) / 8));
}

/** @type {readonly BlockSpec[]} */
export const LED_BLOCKS = [
  {
    type: "thymio_led",
    shape: "statement",
    style: STYLE,
    args: [choice("LED", "led", RGB_LEDS), color("COLOR", "#ff0000")],
    statement: (g, block) => [
      g.line(block, call(g.field(block, "LED"), intensitiesOf(g.field(block, "COLOR")).map(String))),
    ],
  },
  intensities("thymio_led_rgb", "LED", ["RED", "GREEN", "BLUE"], [choice("LED", "led", RGB_LEDS)]),
  intensities("thymio_led_circle", "leds.circle", numbered("CIRCLE", 8)),
  intensities("thymio_led_prox", "leds.prox.h", numbered("PROX", 8)),
  intensities("thymio_led_prox_ground", "leds.prox.v", numbered("PROX", 2)),
  intensities("thymio_led_button", "leds.buttons", ["FORWARD", "RIGHT", "BACKWARD", "LEFT"]),
  intensities("thymio_led_temperature", "leds.temperature", ["RED", "BLUE"]),
  intensities(
    "thymio_led_rc_sound",
    "LED",
    ["INTENSITY"],
    [
      choice("LED", "led", [
        ["remote_control", "leds.rc"],
        ["sound", "leds.sound"],
      ]),
    ],
  ),
  {
    type: "thymio_led_off",
    shape: "statement",
    style: STYLE,
    args: [
      choice(
        "LED",
        "led",
        LEDS.map(([word, native]) => [word, native]),
      ),
    ],
    statement(g, block) {
      const native = g.field(block, "LED");
      const [, , count] = LEDS.find(([, value]) => value === native) ?? LEDS[0];
      return [g.line(block, call(native, Array(count).fill("0")))];
    },
  },
];
