import assert from "node:assert/strict";
import { test } from "node:test";

import { asText, groupsOf } from "../../web_ui/robot_tab/sensor_rows.js";
import { valueLabelsOf } from "../../web_ui/scene/value_labels.js";
import { Quality } from "../../web_ui/scene/quality.js";
import { robotColor } from "../../web_ui/state/robot_colors.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";

const ROBOT = {
  ...NEW_ROBOT,
  proximity: { center: 0.05 },
  raw: {
    proximity: [0, 0, 3000, 0, 0, 0, 0],
    ground: [0, 0, 1, 1, 300, 900],
    motor: [100, -100, -160, 160],
    accelerometer: [0, -23, 23],
    temperature: [221],
    sound: [51, 256],
    remote: [3, 87],
    comm: [5, 0, 0, 5, 0, 0, 0, 0, 0, 0, 1500, 0, 0, 0, 0],
    battery: [796, 796],
  },
};

const ROW = { label: { en: "" }, unit: "", scale: 1, digits: 0, full_scale: null, words: 1 };
const G = 9.81 / 23;

/** The declarations of the built-in sensors (thymio_sim_ros/sim/sensors/). */
const DECLARED = [
  {
    name: "accelerometer",
    label: { en: "acceleration" },
    values: ["x", "y", "z"].map((axis) => ({ ...ROW, label: { en: axis }, unit: "m/s²", scale: G, digits: 1 })),
  },
  { name: "battery", label: { en: "battery" }, values: [{ ...ROW, unit: "V", scale: 1 / 198.9, digits: 2 }] },
  { name: "sound", label: { en: "microphone" }, values: [{ ...ROW, unit: "%", scale: 100 / 255 }] },
  { name: "temperature", label: { en: "temperature" }, values: [{ ...ROW, unit: "°C", scale: 0.1, digits: 1 }] },
];

const key = (/** @type {string} */ name) => name;

test("every value is shown in SI units beside Thymio's integer, ready for a spreadsheet", () => {
  const lines = asText(groupsOf({ robotText: key, stageText: key }, "en", DECLARED), ROBOT).split("\n").map((line) => line.split("\t")); // prettier-ignore
  const find = (/** @type {string} */ label, group = "sensors.others") =>
    lines.find(([title, name]) => title === group && name === label)?.slice(2);
  assert.deepEqual(find("sensors.temperature"), ["22.1 °C", "221"]);
  assert.deepEqual(find("sensors.microphone"), ["20 %", "51"]);
  assert.deepEqual(find("sensors.remote"), ["sensors.address", "87"]);
  assert.deepEqual(find("sensors.comm"), ["sensors.strength", "5"]);
  assert.deepEqual(find("sensors.battery"), ["4.00 V", "796"]);
  assert.deepEqual(find("z", "sensors.acceleration"), ["9.8 m/s²", "23"]);
  assert.deepEqual(find("side.left", "sensors.pwm"), ["-20 %", "-160"]);
  assert.deepEqual(find("proximity.center", "sensors.proximity"), ["5.0 cm", "3000"]);
});

test("a robot without messages has empty values", () => {
  const text = asText(groupsOf({ robotText: key, stageText: key }, "en", DECLARED), NEW_ROBOT);
  assert.ok(!text.includes("NaN") && !text.includes("undefined"));
});

test("a sensor of a plug-in has the rows that it declares", () => {
  const compass = {
    name: "compass",
    label: { en: "compass", de: "Kompass" },
    values: [
      { ...ROW, label: { en: "heading" }, unit: "°", full_scale: 180 },
      { ...ROW, label: { en: "field" }, words: 3 },
    ],
  };
  const robot = { ...NEW_ROBOT, raw: { compass: [-90, 1, 2, 3] } };
  /** @param {string} language @param {import("../../web_ui/state/robot.js").Robot} shown */
  const last = (language, shown = robot) => {
    const groups = groupsOf({ robotText: key, stageText: key }, language, [...DECLARED, compass]);
    assert.deepEqual(groups.at(-1)?.[1].map(({ full }) => full), [180, null]);
    return asText(groups, shown).split("\n").slice(-2);
  };
  assert.deepEqual(last("en"), ["compass\theading\t-90 °\t-90", "compass\tfield\t1 2 3\t1 2 3"]);
  assert.deepEqual(last("de")[0], "Kompass\theading\t-90 °\t-90");
  assert.deepEqual(last("fr", NEW_ROBOT)[1], "compass\tfield\t\t");
});

test("the rows of built-in sensors keep their places and labels", () => {
  const groups = groupsOf({ robotText: key, stageText: key }, "en", DECLARED);
  const titles = groups.map(([title]) => title);
  assert.deepEqual(titles.slice(4), ["sensors.acceleration", "sensors.others", "sensors.buttons"]);
  assert.deepEqual(groups[5][1].map(({ label }) => label).slice(0, 2), ["sensors.temperature", "sensors.microphone"]);
  assert.equal(groupsOf({ robotText: key, stageText: key }, "en", []).length, 6);
});

test("value labels are at the ends of the beams and beside the ground patches", () => {
  const numbers = valueLabelsOf(ROBOT);
  assert.deepEqual(
    numbers.map(({ text }) => text),
    ["0", "0", "3000", "0", "0", "0", "0", "300", "900"],
  );
  assert.ok(Math.abs(numbers[2].place.x - 0.0795 - 0.05) < 1e-9);
  assert.deepEqual(valueLabelsOf(NEW_ROBOT), []);
});

test("a fixed quality stays, and automatic starts over", () => {
  const quality = new Quality({ isSoftware: true });
  quality.choose("fine");
  for (let frame = 0; frame < 200; frame++) assert.equal(quality.note(frame * 200, true), false);
  assert.equal(quality.settings.pixelRatio, 2);
  quality.choose("auto");
  assert.equal(quality.level, 1);
  quality.choose("no such");
  assert.equal(quality.choice, "auto");
});

test("robots have colors of their own, in order", () => {
  assert.notEqual(robotColor(["a", "b"], "a"), robotColor(["a", "b"], "b"));
  assert.equal(robotColor([], "x"), robotColor(["x"], "x"));
});
