// Many robots are placed by the transforms that all robots share.

import assert from "node:assert/strict";
import { test } from "node:test";

import { INITIAL, reduce } from "../../web_ui/state/index.js";
import { isWatched, subscriptionKey, urgencyOf } from "../../web_ui/state/names.js";

/** @typedef {import("../../web_ui/state/index.js").State} State */

const NAMES = ["a", "b", "c", "d", "e"];

/** @param {string[]} names @returns {State} */
function standing(names) {
  const topics = names.flatMap((name) => [`/${name}/_ground_truth/odom`, `/${name}/joint_states`, `/${name}/_led/state`]);
  return reduce(INITIAL, { type: "channels", topics: [...topics, "/tf"] });
}

/** @param {number} yaw */
function about(yaw) {
  return { x: 0, y: 0, z: Math.sin(yaw / 2), w: Math.cos(yaw / 2) };
}

/** @param {string} frame @param {string} child @param {number[]} place @param {{ x: number, y: number, z: number, w: number }} rotation @param {number} sec */
function transform(frame, child, [x, y, z], rotation, sec) {
  const header = { frame_id: frame, stamp: { sec, nanosec: 0 } };
  return { header, child_frame_id: child, transform: { translation: { x, y, z }, rotation } };
}

/** A robot one meter ahead of an odometry that began 2 m along x, looking along y. @param {string} name */
function frames(name, { sec = 1, odometry = "odom" } = {}) {
  const spun = { x: 0, y: Math.sin(0.25), z: 0, w: Math.cos(0.25) };
  return [
    transform("map", `${name}/${odometry}`, [2, 0, 0], about(Math.PI / 2), sec),
    transform(`${name}/${odometry}`, `${name}/base_link`, [1, 0, 0.1], about(0.5), sec),
    transform(`${name}/base_link`, `${name}/left_wheel_link`, [0, 0.05, 0], spun, sec),
  ];
}

/** @param {State} state @param {any[]} transforms @param {number} [nowMs] */
function reported(state, transforms, nowMs = 0) {
  return reduce(state, { type: "message", topic: "/tf", value: { transforms }, timeNs: 0n, nowMs });
}

/** @param {State} state @param {boolean} paused */
function paused(state, paused) {
  const value = { data: JSON.stringify({ playground: "p", paused, robots: NAMES.map((name) => ({ name })) }) };
  return reduce(state, { type: "message", topic: "/simulator/_state", value, timeNs: 0n });
}

test("with many robots, a pose is computed from two transforms", () => {
  const { robots } = reported(standing(NAMES), frames("b"), 70);
  const { pose, stampNs, arrivedMs } = /** @type {any} */ (robots.b.latest);
  const expected = { x: 2, y: 1, z: 0.1, yaw: Math.PI / 2 + 0.5, roll: 0, pitch: 0 };
  for (const [key, value] of Object.entries(expected)) assert.ok(Math.abs(pose[key] - value) < 1e-12, key);
  assert.deepEqual([stampNs, arrivedMs, robots.b.previous], [1e9, 70, null]);
  assert.ok(Math.abs(robots.b.wheels.left - 0.5) < 1e-12);
  assert.equal(robots.b.wheels.right, 0);
  assert.equal(robots.c.latest, null);
});

test("a robot leans in its own direction", () => {
  const lean = { x: 0, y: Math.sin(0.1), z: 0, w: Math.cos(0.1) };
  const [odometry] = frames("b");
  const leaning = transform("b/odom", "b/base_link", [0, 0, 0], lean, 1);
  const { yaw, pitch, roll } = /** @type {any} */ (reported(standing(NAMES), [odometry, leaning]).robots.b.latest).pose;
  for (const [found, value] of [[yaw, Math.PI / 2], [pitch, 0.2], [roll, 0]]) assert.ok(Math.abs(found - value) < 1e-12);
});

test("a repeated transform is one sample, and the next one follows it", () => {
  const once = reported(standing(NAMES), frames("b"), 10);
  assert.equal(reported(once, frames("b"), 20).robots.b.latest?.arrivedMs, 10);
  const { previous, latest } = reported(once, frames("b", { sec: 2 }), 60).robots.b;
  assert.deepEqual([previous?.stampNs, latest?.stampNs, latest?.arrivedMs], [1e9, 2e9, 60]);
});

test("the selected robot, and a few robots, get their poses from their own topics", () => {
  const many = standing(NAMES);
  assert.equal(many.selected, "a");
  assert.equal(reported(many, frames("a")).robots.a, many.robots.a);
  const few = standing(["a", "b"]);
  assert.equal(reported(few, frames("b")), few);
});

test("unknown frames place no robot, and that is noted", () => {
  const many = standing(NAMES);
  const noted = { ...many.robots.b, isByTransforms: false };
  const ignored = reported(many, frames("b", { odometry: "wheels" }));
  assert.deepEqual(ignored.robots.b, noted);
  assert.deepEqual(reported(many, frames("b").slice(1)).robots.b, noted);
  assert.equal(reported(ignored, frames("b", { odometry: "wheels" })), ignored);
  const placed = reported(ignored, frames("b"));
  assert.equal(placed.robots.b.isByTransforms, true);
  assert.equal(reported(placed, frames("x")), placed);
});

test("poses are subscribed to while there are no transforms of a robot, and while paused", () => {
  const topics = ["/tf", "/a/joint_states", "/b/_ground_truth/odom", "/b/joint_states", "/b/_led/state"];
  const watched = (/** @type {State} */ state) => topics.filter((topic) => isWatched(state, topic));
  const many = standing(NAMES);
  const placed = reported(many, frames("b"));
  const withoutPoses = ["/tf", "/a/joint_states", "/b/_led/state"];
  assert.deepEqual(watched(many), withoutPoses, "they will come");
  assert.deepEqual(watched({ ...many, topics: [] }), topics, "nobody publishes transforms");
  assert.deepEqual(watched(reported(many, frames("c"))), topics, "they are not of this robot");
  assert.deepEqual(watched(placed), withoutPoses);
  assert.deepEqual(watched(paused(placed, true)), topics);
  assert.deepEqual(watched(paused(placed, false)), watched(placed));
  assert.deepEqual(watched(standing(["a", "b"])), topics.slice(1));
  const states = [many, reported(many, frames("c")), placed, paused(placed, true), reduce(placed, { type: "select", robot: "b" }), standing(["a"])];
  assert.equal(new Set(states.map(subscriptionKey)).size, states.length);
});

test("what concerns all robots is subscribed to first, then the selected robot", () => {
  const topics = ["/b/_pen/trail", "/b/_led/state", "/a/_led/state", "/tf", "/a/_raw/ground", "/simulator/_state"];
  const order = [...topics].sort((one, other) => urgencyOf({ selected: "a" }, one) - urgencyOf({ selected: "a" }, other));
  assert.deepEqual(order, ["/tf", "/simulator/_state", "/a/_led/state", "/a/_raw/ground", "/b/_led/state", "/b/_pen/trail"]);
});
