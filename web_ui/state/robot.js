// The page's state of one robot, and how each of its topics changes it.

import { applyMarkers } from "./markers.js";
import { BUTTONS } from "./names.js";

/** @typedef {import("./markers.js").Marker} Marker */
/** @typedef {{ x: number, y: number, z: number, yaw: number, roll: number, pitch: number }} Pose  meters, radians */
/** @typedef {{ pose: Pose, stampNs: number, arrivedMs: number }} PoseSample */
/**
 * @typedef {object} Program
 * @property {string} state      running, paused, stopped, fault, or ""
 * @property {string} name
 * @property {string} message
 * @property {number} level      0 ok, 1 warning, 2 error
 * @property {string} line
 * @property {Readonly<Record<string, string>>} values  all values of the status message (docs/aseba_ros.md)
 */
/** @typedef {{ ranges: ArrayLike<number>, angleMin: number, step: number }} Scan  meters, Infinity: nothing; radians */
/**
 * @typedef {object} Robot
 * @property {PoseSample | null} previous
 * @property {PoseSample | null} latest
 * @property {{ left: number, right: number }} wheels            rad
 * @property {{ left: number, right: number }} wheelSpeeds       rad/s
 * @property {Record<string, number[]>} leds                     levels 0…1 by group
 * @property {Record<string, number>} proximity                  meters, Infinity: nothing
 * @property {Record<string, number>} ground                     Range: ±Infinity
 * @property {Record<string, number[]>} raw                      Thymio integers by sensor
 * @property {boolean} hasLidar
 * @property {Scan | null} scan                                  the last of its lidar
 * @property {Record<string, boolean>} buttons
 * @property {readonly number[]} sound                           Hz, s, volume 0…1 of the current sound
 * @property {ArrayLike<number> | null} wave                     one period of its tones
 * @property {ArrayLike<number> | null} samples                  of its last sound other than a tone
 * @property {ReadonlyMap<string, Marker>} trail                 the line drawn by its pen
 * @property {boolean} isReal                                    without ground truth: drawn where its odometry is
 * @property {boolean | null} isByTransforms   whether its pose comes from the shared transforms; null: none have come
 */

/** @type {Robot} */
export const NEW_ROBOT = {
  previous: null,
  latest: null,
  wheels: { left: 0, right: 0 },
  wheelSpeeds: { left: 0, right: 0 },
  leds: {},
  proximity: {},
  ground: {},
  raw: {},
  hasLidar: false,
  scan: null,
  buttons: Object.fromEntries(BUTTONS.map((name) => [name, false])),
  sound: [0, 0, 0],
  wave: null,
  samples: null,
  trail: new Map(),
  isReal: false,
  isByTransforms: null,
};

/** One row per topic, or per folder of topics (then `leaf` is the rest of the name). */
const READERS = /** @type {Record<string, (robot: Robot, value: any, leaf: string, nowMs: number) => Robot>} */ ({
  "_ground_truth/odom": (robot, value, _leaf, nowMs) => ({
    ...robot,
    previous: robot.latest,
    latest: poseSample(value, nowMs),
  }),
  odom: (robot, value, _leaf, nowMs) =>
    robot.isReal ? { ...robot, previous: robot.latest, latest: poseSample(value, nowMs) } : robot,
  joint_states: readJoints,
  "_led/state": (robot, value) => ({ ...robot, leds: splitGroups(value) }),
  proximity: (robot, value, leaf) => ({ ...robot, proximity: { ...robot.proximity, [leaf]: value.range } }),
  ground: (robot, value, leaf) => ({ ...robot, ground: { ...robot.ground, [leaf]: value.range } }),
  scan: (robot, value) => ({
    ...robot,
    scan: { ranges: value.ranges, angleMin: value.angle_min, step: value.angle_increment },
  }),
  buttons: (robot, value, leaf) => ({ ...robot, buttons: { ...robot.buttons, [leaf]: value.data } }),
  "_pen/trail": (robot, value) => ({ ...robot, trail: applyMarkers(robot.trail, value.markers) }),
  "_sound/state": (robot, value) => ({ ...robot, sound: value.data }),
  "_sound/state/wave": (robot, value) => ({ ...robot, wave: value.data }),
  "_sound/state/samples": (robot, value) => ({ ...robot, samples: value.data }),
  _raw: (robot, value, leaf) => ({ ...robot, raw: { ...robot.raw, [leaf]: value.data } }),
});

/**
 * @param {Robot} robot
 * @param {string} name   topic relative to the robot
 * @param {any} value
 * @param {number} nowMs  wall time of arrival, for drawing only
 */
export function reduceRobot(robot, name, value, nowMs) {
  const [folder, leaf = ""] = name.split("/");
  const read = READERS[name] ?? READERS[folder];
  return read === undefined ? robot : read(robot, value, leaf, nowMs);
}

/** @param {any} odometry @param {number} nowMs @returns {PoseSample} */
function poseSample({ header, pose }, nowMs) {
  const { sec, nanosec } = header.stamp;
  const { position, orientation } = pose.pose;
  return { pose: poseOf(position, orientation), stampNs: sec * 1e9 + nanosec, arrivedMs: nowMs };
}

/** The angle about the vertical axis, in radians. @param {{ x: number, y: number, z: number, w: number }} quaternion */
export function yawOf({ x, y, z, w }) {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/**
 * @param {{ x: number, y: number, z: number }} place
 * @param {{ x: number, y: number, z: number, w: number }} q
 * @returns {Pose}
 */
export function poseOf({ x, y, z }, q) {
  const yaw = yawOf(q);
  const roll = Math.atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y));
  const pitch = Math.asin(Math.max(-1, Math.min(1, 2 * (q.w * q.y - q.z * q.x))));
  return { x, y, z, yaw, roll, pitch };
}

/** @param {Robot} robot @param {any} value */
function readJoints(robot, value) {
  /** @param {number[]} values @param {string} side @param {number} otherwise */
  const pick = (values, side, otherwise) => {
    const index = value.name.findIndex((/** @type {string} */ name) => name.endsWith(`${side}_wheel_joint`));
    return values[index] ?? otherwise;
  };
  const { wheels, wheelSpeeds } = robot;
  return {
    ...robot,
    wheels: { left: pick(value.position, "left", wheels.left), right: pick(value.position, "right", wheels.right) },
    wheelSpeeds: {
      left: pick(value.velocity, "left", wheelSpeeds.left),
      right: pick(value.velocity, "right", wheelSpeeds.right),
    },
  };
}

/** Split the array of all LED levels by its labeled dimensions. @param {any} value */
function splitGroups(value) {
  /** @type {Record<string, number[]>} */
  const groups = {};
  let start = 0;
  for (const { label, size } of value.layout.dim) {
    groups[label] = value.data.slice(start, start + size);
    start += size;
  }
  return groups;
}

/** The program state in a status message of the runtime. @param {any} status @returns {Program} */
export function readStatus(status) {
  const values = Object.fromEntries(status.values.map((/** @type {any} */ { key, value }) => [key, value]));
  return {
    state: values.state ?? "",
    name: values.program ?? "",
    message: status.message,
    level: status.level,
    line: values.line ?? "",
    values,
  };
}
