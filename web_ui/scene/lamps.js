// The lights and buttons of all robots as one small texture: row = robot, column = lamp. The robot's mesh names the
// column of each of its corners (`aLamp`), so all of them are drawn with the body, in one draw call.

import * as THREE from "three";

import { glow } from "./glow.js";
import { BUTTON_PLACES, LIGHTS } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const STRIPS = /** @type {const} */ (["bottom_left", "bottom_right"]);
const BUTTONS = Object.keys(BUTTON_PLACES);
const NAMES = [...LIGHTS.map(({ name }) => name), ...STRIPS, ...BUTTONS];
/** Column by name: `led.circle.0`, `bottom_left`, `forward` …; column 0 is the light under the shell. */
export const LAMP_COLUMNS = new Map(NAMES.map((name, index) => [name, index + 1]));
const WIDTH = NAMES.length + 1;

const TINTS = LIGHTS.map(({ color }) => new THREE.Color(color));
const HOVERED = new THREE.Color(0x4b43b8);
const PRESSED = new THREE.Color(0x25225c);
/** Color of a flash where the light under the shell is off. */
const FLASH = [1, 0.7, 0.24];

export class Lamps {
  /** @param {number} robots */
  constructor(robots) {
    this.data = new Uint8Array(4 * WIDTH * robots);
    this.texture = new THREE.DataTexture(this.data, WIDTH, robots);
    this.texture.needsUpdate = true;
  }

  /** @param {number} slot @param {Look} look @param {Look | null} before */
  show(slot, look, before) {
    const { robot, hovered, flash } = look;
    const isLit = before?.robot.leds !== robot.leds || before.flash !== flash;
    const isTouched = before?.robot.buttons !== robot.buttons || before.hovered !== hovered;
    if (isLit) {
      const { color, level } = glow(robot.leds.top);
      // The lower half of the range is light through the plastic, the upper half a flash of the whole body.
      this.#set(slot, 0, flash > 0 && level === 0 ? FLASH : color, flash > 0 ? 0.5 + flash / 2 : level / 2);
      LIGHTS.forEach(({ group, index }, at) => {
        const { r, g, b } = TINTS[at];
        this.#set(slot, at + 1, [r, g, b], Math.sqrt(robot.leds[group]?.[index] ?? 0));
      });
      STRIPS.forEach((name) => {
        const strip = glow(robot.leds[name]);
        this.#set(slot, /** @type {number} */ (LAMP_COLUMNS.get(name)), strip.color, strip.level);
      });
    }
    if (isTouched) {
      for (const name of BUTTONS) {
        const { r, g, b } = robot.buttons[name] ? PRESSED : HOVERED;
        const isOn = robot.buttons[name] || name === hovered;
        this.#set(slot, /** @type {number} */ (LAMP_COLUMNS.get(name)), [r, g, b], isOn ? 1 : 0);
      }
    }
    if (isLit || isTouched) this.texture.needsUpdate = true;
  }

  /** Color and level of a lamp, 0…1. @param {number} slot @param {string} name  empty: under the shell */
  lampOf(slot, name) {
    const at = 4 * (slot * WIDTH + (LAMP_COLUMNS.get(name) ?? 0));
    const [r, g, b, level] = [...this.data.subarray(at, at + 4)].map((value) => value / 255);
    return { r, g, b, level };
  }

  /** @param {number} slot @param {number} column @param {readonly number[]} color @param {number} level */
  #set(slot, column, color, level) {
    this.data.set(
      [...color, level].map((value) => Math.round(255 * value)),
      4 * (slot * WIDTH + column),
    );
  }

  dispose() {
    this.texture.dispose();
  }
}
