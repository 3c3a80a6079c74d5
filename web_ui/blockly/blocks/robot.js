// What the robot has, as options of blocks: values are Aseba's names, as files have them.

/** @typedef {import("./spec.js").Option} Option */

/** @type {readonly Option[]} */
export const BUTTONS = ["center", "forward", "backward", "left", "right"].map((word) => [word, `button.${word}`]);

const FRONT = ["front_left", "middle_left", "middle", "middle_right", "front_right", "back_left", "back_right"];

/** @type {readonly Option[]} */
export const HORIZONTAL = FRONT.map((word, index) => [word, `prox.horizontal[${index}]`]);

/** @type {readonly Option[]} */
export const GROUND = [
  ["ground_left", "prox.ground.delta[0]"],
  ["ground_right", "prox.ground.delta[1]"],
];

/** @type {readonly Option[]} */
export const RGB_LEDS = [
  ["top", "leds.top"],
  ["bottom_left", "leds.bottom.left"],
  ["bottom_right", "leds.bottom.right"],
];

/** A light and how many numbers its native function takes. @type {readonly (readonly [...Option, number])[]} */
export const LEDS = [
  ["top", "leds.top", 3],
  ["bottom_left", "leds.bottom.left", 3],
  ["bottom_right", "leds.bottom.right", 3],
  ["circle", "leds.circle", 8],
  ["prox_horizontal", "leds.prox.h", 8],
  ["prox_ground", "leds.prox.v", 2],
  ["remote_control", "leds.rc", 1],
  ["buttons", "leds.buttons", 4],
  ["temperature", "leds.temperature", 2],
  ["sound", "leds.sound", 1],
];

/** A proximity above this is near, below the second number is far; between them the answer stays as it was. */
export const NEAR = { above: 2000, below: 1000 };
/** The same for the light that the ground reflects. */
export const BRIGHT = { above: 450, below: 400 };

/**
 * The comparison of a proximity sensor.
 *
 * @param {string} sensor
 * @param {string} mode
 */
export const proximity = (sensor, mode) =>
  mode === "PROX" ? `${sensor} > ${NEAR.above}` : `${sensor} < ${NEAR.below}`;

/**
 * The comparison of a ground sensor.
 *
 * @param {string} sensor
 * @param {string} mode
 */
export const ground = (sensor, mode) =>
  ["WHITE", "PROX"].includes(mode) ? `${sensor} > ${BRIGHT.above}` : `${sensor} < ${BRIGHT.below}`;

/** @type {readonly Option[]} */
export const PROXIMITY_MODES = [
  ["near", "PROX"],
  ["far", "NOPROX"],
];

/** @type {readonly Option[]} */
export const GROUND_MODES = [
  ["black", "BLACK"],
  ["white", "WHITE"],
  ["near", "PROX"],
  ["far", "NOPROX"],
];
