// What the picture of the robot shows.

import assert from "node:assert/strict";
import { test } from "node:test";

import { barPath, BARS, motorPath, ringPath } from "../../web_ui/robot_tab/picture_shape.js";
import { lightOf, pictureOf, shadeOf } from "../../web_ui/robot_tab/picture_values.js";
import { PROXIMITY } from "../../web_ui/state/names.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";

const ROBOT = {
  ...NEW_ROBOT,
  raw: {
    proximity: [0, 900, 2650, 3900, 1480, 0, 9999],
    ground: [0, 0, 0, 0, 905, 118],
    motor: [210, -90, 0, 0],
    accelerometer: [0, 0, 23],
    sound: [64, 256],
    temperature: [226],
    remote: [0, 87],
  },
  leds: { circle: [1, 0.5, 0, 0, 0, 0, 0, 0], top: [0, 0.5, 0.25], bottom_left: [0, 0, 0] },
  buttons: { ...NEW_ROBOT.buttons, forward: true },
  sound: [440.2, 1, 1],
};

test("the picture has every reading with its share of the largest value", () => {
  const { proximity, ground, motors, buttons, ring, sound, warmth, remote } = pictureOf(ROBOT);
  assert.deepEqual(
    proximity.map(({ count }) => count),
    [0, 900, 2650, 3900, 1480, 0, 9999],
  );
  assert.equal(proximity[1].share, 900 / 4505);
  assert.equal(proximity[6].share, 1); // never larger than its slot
  assert.deepEqual(
    ground.map(({ count, shade }) => [count, shade]),
    [
      [905, "white"],
      [118, "black"],
    ],
  );
  assert.deepEqual(
    motors.map(({ share }) => share),
    [0.42, -0.18],
  );
  assert.equal(buttons.forward, true);
  assert.equal(buttons.left, false);
  assert.deepEqual(ring.slice(0, 3), [1, 0.5, 0]);
  assert.deepEqual([sound.count, sound.plays, warmth, remote], [64, 440, 23, 87]);
});

test("before the first message nothing is known, and nothing looks like a reading of zero", () => {
  const { proximity, ground, motors, tilt, sound, warmth, remote, ring } = pictureOf(NEW_ROBOT);
  assert.ok([...proximity, ...ground, ...motors, sound].every(({ count, share }) => count === null && share === 0));
  assert.ok(ground.every(({ shade }) => shade === null));
  assert.deepEqual([tilt.degrees, warmth, remote], [null, null, null]);
  assert.deepEqual(ring, [0, 0, 0, 0, 0, 0, 0, 0]);
});

test("the floor is white, gray or black", () => {
  assert.deepEqual([1023, 700, 699, 300, 299, 0].map(shadeOf), ["white", "white", "gray", "gray", "black", "black"]);
});

test("a light has the color of its channels at full level", () => {
  assert.deepEqual(lightOf([0, 0.5, 0.25]), { color: "rgb(0 255 128)", level: 0.5 });
  assert.deepEqual(lightOf([0, 0, 0]), { color: "", level: 0 });
  assert.deepEqual(lightOf(undefined), { color: "", level: 0 });
});

test("the bubble of the level goes to the higher side", () => {
  /** @param {number[]} accelerometer */
  const tilt = (accelerometer) => pictureOf({ ...ROBOT, raw: { ...ROBOT.raw, accelerometer } }).tilt;
  assert.deepEqual(tilt([0, 0, 23]), { degrees: 0, share: 0.5 });
  assert.equal(tilt([16, 0, 16]).degrees, 45);
  assert.ok(tilt([8, 0, 21]).share > 0.5); // left side down
  assert.ok(tilt([-8, 0, 21]).share < 0.5);
  assert.equal(tilt([-23, 0, 0]).share, 0);
});

test("there is a bar for each distance sensor, as far out as its share", () => {
  assert.equal(BARS.length, PROXIMITY.length);
  const center = BARS[2];
  assert.equal(barPath(center, 0), "");
  assert.equal(barPath(center, 0.5), "M209.0 109.0L203.0 72.0L237.0 72.0L231.0 109.0Z");
  assert.equal(barPath(center, 1), "M209.0 109.0L197.0 35.0L243.0 35.0L231.0 109.0Z");
});

test("motors fill upwards when the wheel goes forward, the ring starts in front", () => {
  assert.equal(motorPath(0, 0), "");
  assert.equal(motorPath(0, 1), "M102.6 255V222.0");
  assert.equal(motorPath(1, -0.5), "M337.4 255V271.5");
  assert.match(ringPath(0), /^M210\.1 143\.1A44 44 0 0 1 229\.9 143\.1$/);
});
