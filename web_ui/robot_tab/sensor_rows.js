// The rows of the sensor panel: SI values and Thymio's integers. Pure.
//
// Sensors declare their rows in Python (docs/plugins.md), also those of plug-ins. The rows here are those that combine
// several topics, or show a text instead of a number.

import { BUTTONS, GROUND, PROXIMITY } from "../state/names.js";
import { NEW_ROBOT } from "../state/robot.js";

/** @typedef {import("../state/robot.js").Robot} Robot */
/** @typedef {import("../state/index.js").SensorInfo} SensorInfo */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/**
 * @typedef {object} Row
 * @property {string} label
 * @property {(robot: Robot) => string} value
 * @property {(robot: Robot) => readonly (number | undefined)[]} words   integers; undefined: not received yet
 * @property {number | null} full   the integer that fills the bar; null: no bar
 */
/** @typedef {[title: string, rows: Row[]]} Group */

const WHEEL_RADIUS_M = 0.022;
const PROXIMITY_FULL = 4505;
const GROUND_FULL = 1023;
const SPEED_FULL = 500;
// docs/spec/thymio-robot.md section 2.1
const PWM_FULL = 801;
const COMMAND_FULL = 127;
const COMM_FULL = 1023;
/** Parts of the turn, counter-clockwise from the front. */
const LIDAR_SECTORS = [
  { key: "nearest", from: 0, to: 1 },
  { key: "front", from: -1 / 8, to: 1 / 8 },
  { key: "left", from: 1 / 8, to: 3 / 8 },
  { key: "back", from: 3 / 8, to: 5 / 8 },
  { key: "right", from: 5 / 8, to: 7 / 8 },
];

/**
 * @param {{ robotText: Translate, stageText: Translate }} texts
 * @param {string} language
 * @param {readonly SensorInfo[]} sensors   declarations
 * @param {Pick<Robot, "hasLidar">} [robot]
 * @returns {Group[]}
 */
export function groupsOf({ robotText: t, stageText }, language, sensors, { hasLidar } = NEW_ROBOT) {
  const others = new Map(sensors.map((sensor) => [sensor.name, sensor]));
  /**
   * The rows of a sensor that has its place and its label here.
   *
   * @param {string} name
   * @param {string} title
   */
  const placed = (name, title) => {
    const sensor = others.get(name);
    others.delete(name);
    return sensor === undefined ? [] : declaredRows(sensor, title, language);
  };
  const groups = builtInGroups(t, stageText, placed).filter(([, rows]) => rows.length > 0);
  if (hasLidar) groups.push(lidarGroup(t));
  return [...groups, ...[...others.values()].map((sensor) => declaredGroup(sensor, language))];
}

/** The nearest distance that the lidar measured, all around and in four directions. @param {Translate} t @returns {Group} */
function lidarGroup(t) {
  const rows = LIDAR_SECTORS.map(({ key, from, to }) => ({
    label: t(`lidar.${key}`),
    /** @param {Robot} robot */
    value: ({ scan }) => {
      if (scan === null) return "";
      const { length } = scan.ranges;
      const beams = Array.from({ length: Math.ceil((to - from) * length) }, (_, at) => Math.round(from * length) + at);
      const nearest = Math.min(...beams.map((beam) => scan.ranges[(beam + length) % length]));
      return nearest === Infinity ? t("sensors.nothing") : `${(nearest * 100).toFixed(1)} cm`;
    },
    words: () => [],
    full: null,
  }));
  return [t("sensors.lidar"), rows];
}

/** @param {SensorInfo} sensor @param {string} language @returns {Group} */
function declaredGroup(sensor, language) {
  const title = chooseText(sensor.label, language) || sensor.name;
  return [title, declaredRows(sensor, title, language)];
}

/** @param {SensorInfo} sensor @param {string} title  label of rows without one @param {string} language @returns {Row[]} */
function declaredRows({ name, values }, title, language) {
  let next = 0;
  return values.map(({ label, unit, scale, digits, full_scale, words }) => {
    const from = next;
    next += words;
    /** @param {Robot} robot */
    const wordsOf = ({ raw }) => (raw[name] ?? []).slice(from, from + words);
    return {
      label: chooseText(label, language) || title,
      value: (robot) => scaled(wordsOf(robot), scale, digits, unit),
      words: wordsOf,
      full: full_scale,
    };
  });
}

/**
 * @param {Translate} t
 * @param {Translate} stageText
 * @param {(name: string, title: string) => Row[]} placed
 * @returns {Group[]}
 */
function builtInGroups(t, stageText, placed) {
  return [
    [
      t("sensors.proximity"),
      PROXIMITY.map((name, index) => ({
        label: t(`proximity.${name}`),
        value: ({ proximity }) => formatRange(proximity[name], t),
        words: ({ raw }) => [raw.proximity?.[index]],
        full: PROXIMITY_FULL,
      })),
    ],
    [
      t("sensors.ground"),
      GROUND.map((name, index) => ({
        label: t(`side.${name}`),
        value: ({ ground }) =>
          ground[name] === undefined ? "" : t(isBright(ground[name]) ? "sensors.bright" : "sensors.dark"),
        words: ({ raw }) => [raw.ground?.[4 + index]],
        full: GROUND_FULL,
      })),
    ],
    [
      t("sensors.motors"),
      /** @type {const} */ (["left", "right"]).map((side, index) => ({
        label: t(`side.${side}`),
        value: ({ wheelSpeeds }) => `${(wheelSpeeds[side] * WHEEL_RADIUS_M * 100).toFixed(1)} cm/s`,
        words: ({ raw }) => [raw.motor?.[index]],
        full: SPEED_FULL,
      })),
    ],
    [
      t("sensors.pwm"),
      /** @type {const} */ (["left", "right"]).map((side, index) => ({
        label: t(`side.${side}`),
        value: ({ raw }) => percent(raw.motor?.[2 + index], PWM_FULL),
        words: ({ raw }) => [raw.motor?.[2 + index]],
        full: PWM_FULL,
      })),
    ],
    [t("sensors.acceleration"), placed("accelerometer", "")],
    [
      t("sensors.others"),
      [
        ...placed("temperature", t("sensors.temperature")),
        ...placed("sound", t("sensors.microphone")),
        {
          label: t("sensors.remote"),
          value: ({ raw }) => (raw.remote === undefined ? "–" : t("sensors.address", { address: raw.remote[0] })),
          words: ({ raw }) => [raw.remote?.[1]],
          full: COMMAND_FULL,
        },
        {
          label: t("sensors.comm"),
          value: ({ raw }) => (raw.comm === undefined ? "–" : t("sensors.strength", { value: strongest(raw.comm) })),
          words: ({ raw }) => [raw.comm?.[0]],
          full: COMM_FULL,
        },
        ...placed("battery", t("sensors.battery")),
        {
          label: t("sensors.loudspeaker"),
          value: ({ sound: [frequency, seconds] }) =>
            frequency > 0 ? `${frequency.toFixed(0)} Hz` : seconds > 0 ? t("sensors.samples") : "–",
          words: () => [],
          full: null,
        },
      ],
    ],
    [
      t("sensors.buttons"),
      BUTTONS.map((name) => ({
        label: stageText(`button.${name}`),
        value: ({ buttons }) => t(buttons[name] ? "sensors.pressed" : "sensors.released"),
        words: ({ buttons }) => [Number(buttons[name])],
        full: 1,
      })),
    ],
  ];
}

/** The table as tab-separated text for a spreadsheet. @param {Group[]} groups @param {Robot} robot */
export function asText(groups, robot) {
  return groups
    .flatMap(([title, rows]) =>
      rows.map((row) => [title, row.label, row.value(robot), joined(row.words(robot))].join("\t")),
    )
    .join("\n");
}

/** Integers as text. @param {readonly (number | undefined)[]} words */
export function joined(words) {
  return words.map((word) => word ?? "").join(" ");
}

/** @param {readonly number[]} words @param {number} scale @param {number} digits @param {string} unit */
function scaled(words, scale, digits, unit) {
  const numbers = words.map((word) => (word * scale).toFixed(digits)).join(" ");
  return numbers === "" || unit === "" ? numbers : `${numbers} ${unit}`;
}

/** The text in a language, else in English. @param {import("../state/index.js").Label} label @param {string} language */
function chooseText(label, language) {
  return label[language] ?? label.en ?? "";
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
