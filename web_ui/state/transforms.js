// Poses of many robots from their shared transforms: one message instead of two per robot.

import { isSensed } from "./names.js";
import { poseOf } from "./robot.js";

/** @typedef {import("./robot.js").Robot} Robot */
/** @typedef {{ x: number, y: number, z: number }} Vector */
/** @typedef {Vector & { w: number }} Quaternion */
/** @typedef {{ translation: Vector, rotation: Quaternion }} Transform */

const MAP = "map";
const ODOMETRY = "odom";
const BODY = "base_link";
const WHEELS = /** @type {const} */ ({ left: "left_wheel_link", right: "right_wheel_link" });

/**
 * Set the poses of robots from a TFMessage, unless their own topics are subscribed to. Of robots that are not in the
 * first one it is noted that they need their own topics.
 *
 * @template {{ robots: Readonly<Record<string, Robot>>, selected: string }} S
 * @param {S} state
 * @param {any} message
 * @param {number} nowMs  wall time of arrival, for drawing only
 * @returns {S}
 */
export function applyTransforms(state, message, nowMs) {
  const frames = new Map();
  for (const reported of message.transforms) frames.set(reported.child_frame_id, reported);
  /** @type {Record<string, Robot>} */
  const moved = {};
  for (const [name, robot] of Object.entries(state.robots)) {
    if (isSensed(state, name)) continue;
    const frame = (/** @type {string} */ word) => (name === "" ? word : `${name}/${word}`);
    const odometry = frames.get(frame(ODOMETRY));
    const body = frames.get(frame(BODY));
    if (odometry?.header.frame_id !== MAP || body?.header.frame_id !== frame(ODOMETRY)) {
      if (robot.isByTransforms === null) moved[name] = { ...robot, isByTransforms: false };
      continue;
    }
    const { sec, nanosec } = body.header.stamp;
    const stampNs = sec * 1e9 + nanosec;
    const isNew = robot.latest?.stampNs !== stampNs;
    const { translation, rotation } = chained(odometry.transform, body.transform);
    const sample = { pose: poseOf(translation, rotation), stampNs, arrivedMs: nowMs };
    const angle = (/** @type {"left" | "right"} */ side) => {
      const turn = frames.get(frame(WHEELS[side]))?.transform.rotation;
      return turn === undefined ? robot.wheels[side] : 2 * Math.atan2(turn.y, turn.w);
    };
    moved[name] = {
      ...robot,
      ...(isNew ? { previous: robot.latest, latest: sample } : {}),
      wheels: { left: angle("left"), right: angle("right") },
      isByTransforms: true,
    };
  }
  return Object.keys(moved).length === 0 ? state : { ...state, robots: { ...state.robots, ...moved } };
}

/** @param {Transform} outer @param {Transform} inner @returns {Transform} */
function chained(outer, inner) {
  const { x, y, z } = turned(outer.rotation, inner.translation);
  const { translation: from } = outer;
  return {
    translation: { x: from.x + x, y: from.y + y, z: from.z + z },
    rotation: product(outer.rotation, inner.rotation),
  };
}

/** @param {Quaternion} p @param {Quaternion} q @returns {Quaternion} */
function product(p, q) {
  return {
    w: p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z,
    x: p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
    y: p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
    z: p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w,
  };
}

/** @param {Quaternion} q @param {Vector} vector @returns {Vector} */
function turned(q, { x, y, z }) {
  return product(product(q, { x, y, z, w: 0 }), { x: -q.x, y: -q.y, z: -q.z, w: q.w });
}
