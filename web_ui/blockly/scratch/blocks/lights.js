// Blocks for lights and sound.

import { SYSTEM_SOUNDS } from "../../blocks/actuators.js";
import { call, choice, number, renamed, seconds } from "../../blocks/spec.js";
import { ADD, UNARY } from "../../precedence.js";
import { COLOR_LIGHTS } from "../library.js";

/** @typedef {import("../../blocks/spec.js").BlockSpec} BlockSpec */
/** @typedef {import("../../blocks/spec.js").Arg} Arg */

/** @param {string} type @param {Arg[]} args @param {BlockSpec["statement"]} statement @returns {BlockSpec} */
const light = (type, args, statement) => ({ type, shape: "statement", style: "looks_blocks", args, statement });

/** @param {string} type @param {Arg[]} args @param {BlockSpec["statement"]} statement @returns {BlockSpec} */
const sound = (type, args, statement) => ({ type, shape: "statement", style: "sound_blocks", args, statement });

/**
 * A native function whose arguments are the inputs A, B, ….
 *
 * @param {string} type
 * @param {string} native
 * @param {readonly number[]} initial
 */
function native(type, native, initial) {
  const inputs = initial.map((_, index) => String.fromCharCode(65 + index));
  const args = inputs.map((name, index) => number(name, initial[index]));
  return light(type, args, (g, block) => {
    const values = inputs.map((input) => g.number(block, input));
    return [g.line(block, call(native, values))];
  });
}

/** @param {string} type @param {string} native @param {number} initial */
const sample = (type, native, initial) =>
  sound(type, [number("N", initial)], (g, block) => [g.line(block, call(native, [g.number(block, "N")]))]);

/** Menu of the color lights → functions. @type {Record<string, readonly string[]>} */
const RGB = {
  all: COLOR_LIGHTS,
  top: ["leds.top"],
  bottom: ["leds.bottom.left", "leds.bottom.right"],
  "bottom-left": ["leds.bottom.left"],
  "bottom-right": ["leds.bottom.right"],
};

/** Functions of all lights, with the number of their arguments. @type {readonly [string, number][]} */
const ALL = [
  ["leds.top", 3],
  ["leds.bottom.left", 3],
  ["leds.bottom.right", 3],
  ["leds.circle", 8],
  ["leds.prox.h", 8],
  ["leds.prox.v", 2],
  ["leds.rc", 1],
  ["leds.buttons", 4],
  ["leds.temperature", 2],
  ["leds.sound", 1],
];

const GROUP = choice(
  "L",
  "rgb",
  Object.keys(RGB).map((value) => [value.replace("-", "_"), value]),
);

/**
 * A light whose color is a place on the color wheel; each color light has a place of its own.
 *
 * @param {string} type
 * @param {number} initial
 * @param {(place: string, value: string) => string} statement  sets the place of one light
 * @param {number} [outer]  the operator around the value
 */
const colored = (type, initial, statement, outer) =>
  light(type, [GROUP, number("C", initial)], (g, block) => {
    g.scripts.use("color.show");
    const lights = RGB[g.field(block, "L")].map((name) => COLOR_LIGHTS.indexOf(name));
    const value = g.number(block, "C", outer);
    return [
      ...lights.map((index) => g.line(block, statement(`color.number[${index}]`, value))),
      g.line(block, `color.lights = ${lights.reduce((mask, index) => mask | (1 << index), 0)}`),
      g.line(block, "callsub color.show"),
    ];
  });

/** @type {readonly BlockSpec[]} */
export const LIGHTS = [
  light(
    "thymio_leds",
    [GROUP, number("R", 32), number("G", 0), number("B", 0)],
    (g, block) =>
      RGB[g.field(block, "L")].map((name) =>
        g.line(
          block,
          call(
            name,
            ["R", "G", "B"].map((input) => g.number(block, input)),
          ),
        ),
      ),
  ),
  colored("thymio_setLeds", 0, (place, value) => `${place} = ${value}`),
  colored("thymio_changeLeds", 33, (place, value) => `${place} = ${place} + ${value}`, ADD),
  light("thymio_clearLeds", [], (g, block) =>
    ALL.map(([name, count]) => g.line(block, call(name, Array(count).fill("0")))),
  ),
  light(
    "thymio_nextDial",
    [
      renamed(
        "D",
        choice("L", "direction", [
          ["left", "left"],
          ["right", "right"],
        ]),
      ),
    ],
    (g, block) => {
      g.scripts.use("dial.show");
      const sign = g.field(block, "L") === "left" ? "-" : "+";
      return [g.line(block, `dial.number = dial.number ${sign} 1`), g.line(block, "callsub dial.show")];
    },
  ),
  native("thymio_ledsCircle", "leds.circle", [0, 8, 16, 32, 0, 8, 16, 32]),
  native("thymio_ledsProxH", "leds.prox.h", [0, 8, 16, 32, 0, 8, 16, 32]),
  native("thymio_ledsProxV", "leds.prox.v", [32, 32]),
  native("thymio_ledsButtons", "leds.buttons", [16, 32, 16, 32]),
  native("thymio_ledsTemperature", "leds.temperature", [32, 8]),
  native("thymio_ledsRc", "leds.rc", [16]),
  native("thymio_ledsSound", "leds.sound", [32]),
  sound("thymio_soundSystem", [choice("S", "system_sound", SYSTEM_SOUNDS, "1")], (g, block) => [
    g.line(block, `call sound.system(${g.field(block, "S")})`),
  ]),
  // seconds become sixtieths of a second
  sound("thymio_soundFreq", [number("N", 440), seconds("S", 1)], (g, block) => {
    const seconds = g.constant(block, "S");
    const sixtieths = seconds === null ? `${g.number(block, "S", UNARY)} * 60` : String(Math.round(seconds * 60));
    return [g.line(block, `call sound.freq(${g.number(block, "N")}, ${sixtieths})`)];
  }),
  sample("thymio_soundPlaySd", "sound.play", 0),
  sample("thymio_soundRecord", "sound.record", 0),
  sound("thymio_stopSoundRecord", [], (g, block) => [g.line(block, "call sound.record(-1)")]),
  sample("thymio_soundReplay", "sound.replay", 0),
];
