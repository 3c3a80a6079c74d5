// Blocks for lights and sound.

import { ADD, UNARY } from "../../blockly/precedence.js";
import { SYSTEM_SOUNDS } from "../../blockly/blocks/actuators.js";
import { call, choice, number, seconds } from "../../blockly/blocks/spec.js";

/** @typedef {import("../../blockly/blocks/spec.js").BlockSpec} BlockSpec */
/** @typedef {import("../../blockly/blocks/spec.js").Arg} Arg */

/** @param {string} type @param {Arg[]} args @param {BlockSpec["statement"]} statement @returns {BlockSpec} */
const light = (type, args, statement) => ({ type, shape: "statement", style: "looks_blocks", args, statement });

/** @param {string} type @param {Arg[]} args @param {BlockSpec["statement"]} statement @returns {BlockSpec} */
const sound = (type, args, statement) => ({ type, shape: "statement", style: "sound_blocks", args, statement });

/** @param {string} type @param {string} native @param {readonly string[]} inputs */
const native = (type, native, inputs) =>
  light(
    type,
    inputs.map((name) => number(name, 32)),
    (g, block) => [
      g.line(
        block,
        call(
          native,
          inputs.map((input) => g.number(block, input)),
        ),
      ),
    ],
  );

/** @param {string} type @param {string} native @param {number} initial */
const sample = (type, native, initial) =>
  sound(type, [number("N", initial)], (g, block) => [g.line(block, call(native, [g.number(block, "N")]))]);

/** Menu of the color lights → functions. @type {Record<string, readonly string[]>} */
const RGB = {
  all: ["leds.top", "leds.bottom.left", "leds.bottom.right"],
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

/** @param {number} count */
const letters = (count) => Array.from({ length: count }, (_, index) => String.fromCharCode(65 + index));

/** @type {readonly BlockSpec[]} */
export const LIGHTS = [
  light(
    "thymio_leds",
    [
      choice(
        "L",
        "rgb",
        Object.keys(RGB).map((value) => [value.replace("-", "_"), value]),
      ),
      number("R", 32),
      number("G", 0),
      number("B", 0),
    ],
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
  light("thymio_setLeds", [number("C", 0)], (g, block) => {
    g.scripts.use("color.show");
    return [g.line(block, `color.number = ${g.number(block, "C")}`), g.line(block, "callsub color.show")];
  }),
  light("thymio_changeLeds", [number("C", 33)], (g, block) => {
    g.scripts.use("color.show");
    const change = `color.number = color.number + ${g.number(block, "C", ADD)}`;
    return [g.line(block, change), g.line(block, "callsub color.show")];
  }),
  light("thymio_clearLeds", [], (g, block) =>
    ALL.map(([name, count]) => g.line(block, call(name, Array(count).fill("0")))),
  ),
  light(
    "thymio_nextDial",
    [
      choice("D", "direction", [
        ["left", "left"],
        ["right", "right"],
      ]),
    ],
    (g, block) => {
      g.scripts.use("dial.show");
      const sign = g.field(block, "D") === "left" ? "-" : "+";
      return [g.line(block, `dial.number = dial.number ${sign} 1`), g.line(block, "callsub dial.show")];
    },
  ),
  native("thymio_ledsCircle", "leds.circle", letters(8)),
  native("thymio_ledsProxH", "leds.prox.h", letters(8)),
  native("thymio_ledsProxV", "leds.prox.v", letters(2)),
  native("thymio_ledsButtons", "leds.buttons", letters(4)),
  native("thymio_ledsTemperature", "leds.temperature", letters(2)),
  native("thymio_ledsRc", "leds.rc", letters(1)),
  native("thymio_ledsSound", "leds.sound", letters(1)),
  sound("thymio_soundSystem", [choice("S", "system_sound", SYSTEM_SOUNDS)], (g, block) => [
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
