// A painted track: straight segments between points, joined by arcs if a corner radius is given.
// Computes the same stations as thymio_sim_ros/sim/shapes/track.py.

import { distance, wrapped } from "../geometry.js";
import { Fault } from "../rules.js";

/** @typedef {import("../geometry.js").Point} Point */
/** @typedef {[number, number, number]} Station  a point of the center line: x, y, direction */

const ARC_STEP = (5 * Math.PI) / 180;
const SAME_PLACE_M = 1e-9;

/** @type {import("./index.js").Draw} */
export function track(values) {
  const { width_m: width, color } = values;
  const stations = stationsOf(values);
  /** @type {import("../primitives.js").Primitive[]} */ const found = [];
  for (let at = 1; at < stations.length; at++) {
    const [[ax, ay, a], [bx, by, b]] = [stations[at - 1], stations[at]];
    if (distance([ax, ay], [bx, by]) < SAME_PLACE_M) continue;
    const half = width / 2;
    const [ux, uy, vx, vy] = [-Math.sin(a) * half, Math.cos(a) * half, -Math.sin(b) * half, Math.cos(b) * half];
    const vertices = /** @type {Point[]} */ ([
      [ax - ux, ay - uy],
      [bx - vx, by - vy],
      [bx + vx, by + vy],
      [ax + ux, ay + uy],
    ]);
    found.push({ type: "paint", vertices, color });
  }
  return found;
}

/**
 * The center line. Throws a Fault if all points coincide or if there is no room for the arcs.
 *
 * @param {Record<string, any>} values
 * @returns {Station[]}
 */
function stationsOf({ points_m, width_m: width, closed, corner_radius_m: radius }) {
  if (radius > 0 && radius < width / 2) throw new Fault("corner_radius_m", String(radius), { word: "fault.radius" });
  const all = /** @type {Point[]} */ (points_m);
  const points = all.filter(([x, y], index) => index === 0 || x !== all[index - 1][0] || y !== all[index - 1][1]);
  const [[firstX, firstY], [lastX, lastY]] = [points[0], points[points.length - 1]];
  if (closed && points.length > 1 && firstX === lastX && firstY === lastY) points.pop();
  if (points.length < 2) throw new Fault("points_m", "1", { word: "fault.places" });
  const ring = closed ? [...points, points[0]] : points;
  const directions = ring.slice(1).map(([x, y], index) => Math.atan2(y - ring[index][1], x - ring[index][0]));
  /** The length of a segment that the arc at its corner replaces. @param {number} from @param {number} to */
  const cut = (from, to) => {
    const turn = Math.abs(wrapped(to - from));
    return turn < Math.PI - 1e-6 ? radius * Math.tan(turn / 2) : 0;
  };
  /** @type {Station[]} */ const stations = [];
  directions.forEach((direction, index) => {
    const [begin, end] = [ring[index], ring[index + 1]];
    const before = index > 0 || closed ? directions[(index || directions.length) - 1] : direction;
    const isLast = index + 1 === directions.length && !closed;
    const after = isLast ? direction : directions[(index + 1) % directions.length];
    const [cutBegin, cutEnd] = [cut(before, direction), cut(direction, after)];
    if (cutBegin + cutEnd > distance(begin, end) + SAME_PLACE_M) {
      throw new Fault("corner_radius_m", String(radius), { word: "fault.corners" });
    }
    const [cos, sin] = [Math.cos(direction), Math.sin(direction)];
    stations.push([begin[0] + cutBegin * cos, begin[1] + cutBegin * sin, direction]);
    stations.push([end[0] - cutEnd * cos, end[1] - cutEnd * sin, direction]);
    stations.push(...arc(end, direction, wrapped(after - direction), cutEnd, radius));
  });
  return stations;
}

/**
 * @param {Point} corner
 * @param {number} direction
 * @param {number} turn
 * @param {number} cut
 * @param {number} size
 * @returns {Station[]}
 */
function arc(corner, direction, turn, cut, size) {
  if (cut === 0) return [];
  const radius = Math.sign(turn) * size;
  const [startX, startY] = [corner[0] - cut * Math.cos(direction), corner[1] - cut * Math.sin(direction)];
  const [middleX, middleY] = [startX - radius * Math.sin(direction), startY + radius * Math.cos(direction)];
  const steps = Math.max(1, Math.ceil(Math.abs(turn) / ARC_STEP));
  return Array.from({ length: steps + 1 }, (_, step) => {
    const angle = direction + (turn * step) / steps;
    return [middleX + radius * Math.sin(angle), middleY - radius * Math.cos(angle), angle];
  });
}
