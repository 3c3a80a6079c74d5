// What the picture of the robot shows: numbers and shares from the state of a robot. Pure.
//
// `share` is 0…1 of the largest value; null: not received yet.

import { BUTTONS, PROXIMITY } from "../state/names.js";

/** @typedef {import("../state/robot.js").Robot} Robot */
/** @typedef {{ count: number | null, share: number }} Reading */
/** @typedef {"white" | "gray" | "black"} Shade */
/**
 * @typedef {object} PictureValues
 * @property {Reading[]} proximity     Thymio's order 0…6
 * @property {(Reading & { shade: Shade | null })[]} ground   left, right
 * @property {Reading[]} motors        left, right; share −1…1 of the largest speed
 * @property {Record<string, boolean>} buttons
 * @property {number[]} ring           levels 0…1 of the eight lights around the buttons, clockwise from the front
 * @property {Light} top
 * @property {[Light, Light]} below    left, right
 * @property {{ degrees: number | null, share: number }} tilt   share: place of the bubble of a spirit level, 0.5 is level
 * @property {Reading & { plays: number }} sound   volume at the microphone; plays: Hz of the loudspeaker, 0: silent
 * @property {number | null} warmth    °C
 * @property {number | null} remote    the last command of the remote control
 */
/** @typedef {{ color: string, level: number }} Light   level 0…1; the color is that at full level, "" while it is off */

// docs/spec/thymio-robot.md sections 2 and 4
const PROXIMITY_FULL = 4505;
const GROUND_FULL = 1023;
const SPEED_FULL = 500;
const SOUND_FULL = 255;
const GRAVITY = 23;
/** Largest tilt that the level shows. */
const TILT_FULL = 45;
/** Counts of the ground sensors above which the floor is gray or white. */
const GRAY_FROM = 300;
const WHITE_FROM = 700;
/** Where the two counts are in the words of `_raw/ground`: with the emitter on minus off. */
const GROUND_AT = 4;
const LIGHTS_OF_RING = 8;

/** @param {number | undefined} count @param {number} full @returns {Reading} */
function reading(count, full) {
  if (count === undefined) return { count: null, share: 0 };
  return { count, share: Math.max(-1, Math.min(1, count / full)) };
}

/** @param {number | null} count @returns {Shade | null} */
export function shadeOf(count) {
  if (count === null) return null;
  if (count >= WHITE_FROM) return "white";
  return count >= GRAY_FROM ? "gray" : "black";
}

/**
 * The light of levels 0…1: color = levels divided by the largest (docs/spec/thymio-robot.md section 8.1).
 *
 * @param {readonly number[] | undefined} levels  red, green, blue
 * @returns {Light}
 */
export function lightOf(levels = []) {
  const level = Math.min(1, Math.max(0, ...levels));
  if (level <= 0) return { color: "", level: 0 };
  const channels = [0, 1, 2].map((at) => Math.round((255 * (levels[at] ?? 0)) / level));
  return { color: `rgb(${channels.join(" ")})`, level };
}

/** @param {Robot} robot @returns {PictureValues} */
export function pictureOf({ raw, buttons, leds, sound }) {
  const [x, y, z] = raw.accelerometer ?? [];
  const [volume] = raw.sound ?? [];
  const [tenths] = raw.temperature ?? [];
  const [frequency = 0] = sound;
  return {
    proximity: PROXIMITY.map((_, at) => reading(raw.proximity?.[at], PROXIMITY_FULL)),
    ground: [0, 1].map((side) => {
      const found = reading(raw.ground?.[GROUND_AT + side], GROUND_FULL);
      return { ...found, shade: shadeOf(found.count) };
    }),
    motors: [0, 1].map((side) => reading(raw.motor?.[side], SPEED_FULL)),
    buttons: Object.fromEntries(BUTTONS.map((name) => [name, buttons[name] ?? false])),
    ring: Array.from({ length: LIGHTS_OF_RING }, (_, at) => Math.min(1, leds.circle?.[at] ?? 0)),
    top: lightOf(leds.top),
    below: [lightOf(leds.bottom_left), lightOf(leds.bottom_right)],
    tilt: tiltOf(x, y, z),
    sound: { ...reading(volume, SOUND_FULL), plays: Math.round(frequency) },
    warmth: tenths === undefined ? null : Math.round(tenths / 10),
    remote: raw.remote?.[1] ?? null,
  };
}

/**
 * The angle of the robot to the horizon, from the acceleration in Thymio's units. The bubble goes to the higher side: x is
 * positive with the left side down.
 *
 * @param {number | undefined} x
 * @param {number | undefined} y
 * @param {number | undefined} z
 */
function tiltOf(x, y, z) {
  if (x === undefined || y === undefined || z === undefined) return { degrees: null, share: 0.5 };
  const degrees = (Math.atan2(Math.hypot(x, y), z) * 180) / Math.PI;
  const aside = (Math.asin(Math.max(-1, Math.min(1, x / GRAVITY))) * 180) / Math.PI;
  const share = 0.5 + Math.max(-0.5, Math.min(0.5, aside / (2 * TILT_FULL)));
  return { degrees: Math.round(degrees), share: Number(share.toFixed(2)) };
}
