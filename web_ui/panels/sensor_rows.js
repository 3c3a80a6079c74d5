// The rows of the sensor panel: SI values and Thymio's integers. Pure.

import { BUTTONS, GROUND, PROXIMITY } from "../state/names.js";

/** @typedef {import("../state/robot.js").Robot} Robot */
/**
 * @typedef {object} Row
 * @property {string} label
 * @property {(robot: Robot) => string} value
 * @property {(robot: Robot) => number | undefined} raw
 * @property {number} full   full scale of the integer, for the bar
 */

const WHEEL_RADIUS_M = 0.022;
const PROXIMITY_FULL = 4505;
const GROUND_FULL = 1023;
// docs/spec/thymio-robot.md sections 2.1, 7.3 and 7.4
const PWM_FULL = 801;
const ACC_PER_G = 23;
const GRAVITY = 9.81;
const MIC_FULL = 255;
const COUNTS_PER_VOLT = 198.9;

/** @param {import("../i18n/index.js").Translate} t @returns {[string, Row[]][]} */
export function groupsOf(t) {
  return [
    [
      t("sensors.proximity"),
      PROXIMITY.map((name, index) => ({
        label: t(`proximity.${name}`),
        value: ({ proximity }) => formatRange(proximity[name], t),
        raw: ({ raw }) => raw.proximity?.[index],
        full: PROXIMITY_FULL,
      })),
    ],
    [
      t("sensors.ground"),
      GROUND.map((name, index) => ({
        label: t(`side.${name}`),
        value: ({ ground }) =>
          ground[name] === undefined ? "" : t(isBright(ground[name]) ? "sensors.bright" : "sensors.dark"),
        raw: ({ raw }) => raw.ground?.[4 + index],
        full: GROUND_FULL,
      })),
    ],
    [
      t("sensors.motors"),
      /** @type {const} */ (["left", "right"]).map((side, index) => ({
        label: t(`side.${side}`),
        value: ({ wheelSpeeds }) => `${(wheelSpeeds[side] * WHEEL_RADIUS_M * 100).toFixed(1)} cm/s`,
        raw: ({ raw }) => raw.motor?.[index],
        full: 500,
      })),
    ],
    [
      t("sensors.pwm"),
      /** @type {const} */ (["left", "right"]).map((side, index) => ({
        label: t(`side.${side}`),
        value: ({ raw }) => percent(raw.motor?.[2 + index], PWM_FULL),
        raw: ({ raw }) => raw.motor?.[2 + index],
        full: PWM_FULL,
      })),
    ],
    [
      t("sensors.acceleration"),
      ["x", "y", "z"].map((axis, index) => ({
        label: axis,
        value: ({ raw }) => unit(raw.accelerometer?.[index], GRAVITY / ACC_PER_G, "m/s²", 1),
        raw: ({ raw }) => raw.accelerometer?.[index],
        full: 32,
      })),
    ],
    [
      t("sensors.others"),
      [
        {
          label: t("sensors.temperature"),
          value: ({ raw }) => unit(raw.temperature?.[0], 0.1, "°C", 1),
          raw: ({ raw }) => raw.temperature?.[0],
          full: 500,
        },
        {
          label: t("sensors.microphone"),
          value: ({ raw }) => percent(raw.sound?.[0], MIC_FULL),
          raw: ({ raw }) => raw.sound?.[0],
          full: MIC_FULL,
        },
        {
          label: t("sensors.remote"),
          value: ({ raw }) => (raw.remote === undefined ? "–" : t("sensors.address", { address: raw.remote[0] })),
          raw: ({ raw }) => raw.remote?.[1],
          full: 127,
        },
        {
          label: t("sensors.comm"),
          value: ({ raw }) => (raw.comm === undefined ? "–" : t("sensors.strength", { value: strongest(raw.comm) })),
          raw: ({ raw }) => raw.comm?.[0],
          full: 1023,
        },
        {
          label: t("sensors.battery"),
          value: ({ raw }) => unit(raw.battery?.[0], 1 / COUNTS_PER_VOLT, "V", 2),
          raw: ({ raw }) => raw.battery?.[0],
          full: 4.2 * COUNTS_PER_VOLT,
        },
        {
          label: t("sensors.loudspeaker"),
          value: ({ sound: [frequency, seconds] }) =>
            frequency > 0 ? `${frequency.toFixed(0)} Hz` : seconds > 0 ? t("sensors.samples") : "–",
          raw: () => undefined,
          full: 1,
        },
      ],
    ],
    [
      t("sensors.buttons"),
      BUTTONS.map((name) => ({
        label: t(`button.${name}`),
        value: ({ buttons }) => t(buttons[name] ? "sensors.pressed" : "sensors.released"),
        raw: ({ buttons }) => Number(buttons[name]),
        full: 1,
      })),
    ],
  ];
}

/** The table as tab-separated text for a spreadsheet. @param {[string, Row[]][]} groups @param {Robot} robot */
export function asText(groups, robot) {
  return groups
    .flatMap(([title, rows]) =>
      rows.map((row) => [title, row.label, row.value(robot), row.raw(robot) ?? ""].join("\t")),
    )
    .join("\n");
}

/** @param {number | undefined} count @param {number} size  of one @param {string} name @param {number} digits */
function unit(count, size, name, digits) {
  return count === undefined ? "" : `${(count * size).toFixed(digits)} ${name}`;
}

/** @param {number | undefined} count @param {number} full */
function percent(count, full) {
  return count === undefined ? "" : `${Math.round((100 * count) / full)} %`;
}

/**
 * The strongest of the seven infrared receivers. Words: value, seven payloads, seven intensities.
 *
 * @param {number[]} words
 */
function strongest(words) {
  return Math.max(0, ...words.slice(8, 15));
}

/**
 * Reflecting ground is reported as "too close" (−inf), or as 0 by the driver (docs/spec/ros-interface.md section 4.3).
 *
 * @param {number} range
 */
function isBright(range) {
  return range <= 0;
}

/** @param {number | undefined} range @param {import("../i18n/index.js").Translate} t */
function formatRange(range, t) {
  if (range === undefined) return "";
  if (range === Infinity || (range < 0 && range !== -Infinity)) return t("sensors.nothing");
  return range === -Infinity ? "< 2.2 cm" : `${(range * 100).toFixed(1)} cm`;
}
