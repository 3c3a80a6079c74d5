import assert from "node:assert/strict";
import { test } from "node:test";

import { poseAt, shortestTurn } from "../../web_ui/scene/motion.js";
import { LEVELS, pictureRatio, Quality } from "../../web_ui/scene/quality.js";

/** @param {number} x @param {number} yaw @param {number} arrivedMs @param {number} [stampNs] */
function sample(x, yaw, arrivedMs, stampNs = arrivedMs * 1e6) {
  return { pose: { x, y: 0, z: 0, yaw, roll: 0, pitch: 0 }, stampNs, arrivedMs };
}

test("between two messages the pose is interpolated", () => {
  const { pose, arrived } = poseAt(sample(0, 0, 0), sample(0.01, 0.2, 50), 75);
  assert.deepEqual([pose.x, pose.yaw, arrived], [0.005, 0.1, false]);
});

test("after one more interval the last pose is reached", () => {
  assert.deepEqual(poseAt(sample(0, 0, 0), sample(0.01, 0.2, 50), 100), {
    pose: sample(0.01, 0.2, 50).pose,
    arrived: true,
  });
});

test("a robot that stands has arrived: nothing is drawn between two messages", () => {
  assert.equal(poseAt(sample(0.1, 1, 0), sample(0.1, 1, 50), 51).arrived, true);
});

test("the first pose is used as it is", () => {
  assert.equal(poseAt(null, sample(1, 0, 0), 0).pose.x, 1);
});

test("a leap is not interpolated", () => {
  assert.equal(poseAt(sample(0, 0, 0), sample(0.5, 0, 50), 51).pose.x, 0.5);
});

test("time that went back is a reset", () => {
  assert.equal(poseAt(sample(0, 0, 0, 9e9), sample(0.01, 0, 50, 0), 51).pose.x, 0.01);
});

test("a heading turns the short way across ±π", () => {
  assert.ok(Math.abs(shortestTurn(3, -3) - (2 * Math.PI - 6)) < 1e-12);
  assert.ok(Math.abs(shortestTurn(-3, 3) - (6 - 2 * Math.PI)) < 1e-12);
  assert.equal(shortestTurn(0.5, 1), 0.5);
});

/** Frames at this interval; returns the levels that were passed. @param {Quality} quality @param {number} intervalMs */
function run(quality, intervalMs) {
  const levels = [quality.level];
  for (let frame = 0; frame < 1000; frame++) if (quality.note(frame * intervalMs, true)) levels.push(quality.level);
  return levels.map((level) => LEVELS[level]);
}

test("slow frames cost first every second frame, then glows, then resolution", () => {
  const passed = run(new Quality({ isSoftware: true }), 100);
  assert.deepEqual(
    passed.map(({ framesPerSecond, hasGlows, pixelRatio }) => [framesPerSecond, hasGlows, pixelRatio]),
    [
      [Infinity, true, 1],
      [30, true, 1],
      [30, false, 1],
      [30, false, 0.87],
      [30, false, 0.75],
    ],
  );
});

test("on a graphics card nothing is left out", () => {
  assert.equal(run(new Quality({ isSoftware: false }), 100).length, 1);
});

test("thirty frames a second are enough where every second one is left out", () => {
  assert.equal(run(new Quality({ isSoftware: true }), 33).length, 2);
});

test("where every second frame is left out, a frame may be too early", () => {
  const quality = new Quality({ isSoftware: true });
  quality.level = 2;
  assert.equal(quality.isEarly(0), false);
  quality.note(0, true);
  assert.deepEqual([quality.isEarly(16), quality.isEarly(33)], [true, false]);
  quality.note(40, false);
  assert.equal(quality.isEarly(41), false, "nothing moved before");
});

test("resolution is full while nothing moves", () => {
  const quality = new Quality({ isSoftware: true });
  assert.equal(quality.rest(true), false, "it was full");
  quality.rest(false);
  run(quality, 100);
  assert.equal(quality.isReduced, true);
  assert.equal(quality.rest(true), true);
  assert.equal(quality.settings.pixelRatio, 1);
  assert.equal(quality.rest(false), true);
  assert.equal(quality.settings.pixelRatio, 0.75);
});

test("fast frames and pauses leave the quality alone", () => {
  const quality = new Quality({ isSoftware: true });
  for (let frame = 0; frame < 1000; frame++) quality.note(frame * 20 + Math.floor(frame / 10) * 1000, frame % 10 !== 9);
  assert.equal(quality.level, 1);
});

test("a saved image is large whatever the quality, and never too large for a graphics card", () => {
  for (const [width, height, devicePixelRatio] of [
    [800, 600, 1],
    [390, 480, 3],
    [1600, 900, 2],
    [150, 900, 1],
  ]) {
    const ratio = pictureRatio({ width, height }, devicePixelRatio);
    assert.ok(ratio >= devicePixelRatio);
    assert.ok(Math.max(width, height) * ratio <= 4096 + 1e-6);
    assert.ok(width * ratio >= 1920 - 1e-6 || height * ratio >= 4096 - 1e-6);
  }
});
