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

test("slow frames lower the quality, down to the last level", () => {
  const quality = new Quality(0);
  for (let frame = 0; frame < 1000; frame++) quality.note(frame * 100, true);
  assert.equal(quality.level, LEVELS.length - 1);
});

test("fast frames and pauses leave the quality alone", () => {
  const quality = new Quality(0);
  for (let frame = 0; frame < 1000; frame++) quality.note(frame * 20 + Math.floor(frame / 10) * 1000, frame % 10 !== 9);
  assert.equal(quality.level, 0);
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
