// Interpolates the drawn pose of a robot between its last two poses, so that 20 messages per second look smooth.
// Pure; all times are in milliseconds of the page's clock.

/** @typedef {import("../state/robot.js").Pose} Pose */
/** @typedef {import("../state/robot.js").PoseSample} PoseSample */

/** A longer gap is a pause, not a slow movement. */
const LONGEST_MS = 250;
/** A larger distance is a reset or a placement, not driving. */
const LEAP_M = 0.1;

/**
 * @param {PoseSample | null} previous
 * @param {PoseSample} latest
 * @param {number} nowMs
 * @returns {{ pose: Pose, arrived: boolean }}
 */
export function poseAt(previous, latest, nowMs) {
  if (previous === null || latest.stampNs < previous.stampNs) return { pose: latest.pose, arrived: true };
  const from = previous.pose;
  const to = latest.pose;
  const duration = Math.min(latest.arrivedMs - previous.arrivedMs, LONGEST_MS);
  const progress = duration > 0 ? (nowMs - latest.arrivedMs) / duration : 1;
  const isLeap = Math.hypot(to.x - from.x, to.y - from.y) > LEAP_M;
  if (progress >= 1 || isLeap || isSame(from, to)) return { pose: to, arrived: true };
  const part = Math.max(progress, 0);
  return {
    pose: {
      x: from.x + (to.x - from.x) * part,
      y: from.y + (to.y - from.y) * part,
      z: from.z + (to.z - from.z) * part,
      yaw: from.yaw + shortestTurn(from.yaw, to.yaw) * part,
      roll: from.roll + (to.roll - from.roll) * part,
      pitch: from.pitch + (to.pitch - from.pitch) * part,
    },
    arrived: false,
  };
}

/** Whether a robot stands: then there is nothing to draw between two messages. @param {Pose} one @param {Pose} other */
function isSame(one, other) {
  return /** @type {(keyof Pose)[]} */ (Object.keys(one)).every((key) => one[key] === other[key]);
}

/**
 * The rotation from one heading to another, at most half a turn.
 *
 * @param {number} from
 * @param {number} to
 */
export function shortestTurn(from, to) {
  const turn = (to - from) % (2 * Math.PI);
  if (turn > Math.PI) return turn - 2 * Math.PI;
  return turn < -Math.PI ? turn + 2 * Math.PI : turn;
}
