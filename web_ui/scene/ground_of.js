// The ground of a playground as a whole: where it is, its border, and whether walls stand around it. Pure.

import { bodyOf, placed } from "../move/placed_bodies.js";
import { containsPoint } from "../playground/geometry.js";
import { MARKER } from "../state/markers.js";
import { yawOf } from "../state/robot.js";

/** @typedef {import("../state/markers.js").Marker} Marker */
/** @typedef {import("./surroundings.js").Ground} Ground */
/** @typedef {import("../move/placed_bodies.js").Point} Point */

/** Points of a border at which a wall has to stand are this close: less than a robot. */
const GAP_M = 0.05;

/** Corners at the same place, to 0.1 mm. @param {Readonly<Point>} point */
function keyOf([x, y]) {
  return `${Math.round(x * 1e4)},${Math.round(y * 1e4)}`;
}

/** @param {Iterable<Marker>} markers @returns {Ground | null}  null: nothing stands or lies there */
export function groundOf(markers) {
  const all = [...markers];
  const floors = all.filter(({ ns, type }) => ns.startsWith("floor/") && type === MARKER.TRIANGLE_LIST);
  const bodies = all.filter(({ ns }) => ns.startsWith("solid/")).map(bodyOf);
  const places = floors.length > 0 ? floors.flatMap(cornersOf) : bodies.map(({ pose: { x, y } }) => [x, y]);
  if (places.length === 0) return null;
  const [xs, ys] = [0, 1].map((axis) => places.map((place) => place[axis]));
  const edges = borderOf(floors);
  const walls = bodies.flatMap(({ outline, pose }) => placed(outline, pose));
  return {
    bounds: { min: { x: Math.min(...xs), y: Math.min(...ys) }, max: { x: Math.max(...xs), y: Math.max(...ys) } },
    edges,
    isWalled: edges.flatMap(pointsOn).every((point) => walls.some((wall) => containsPoint(wall, point))),
  };
}

/** Between them no robot fits. @param {[Point, Point]} edge @returns {Point[]} */
function pointsOn([[fromX, fromY], [toX, toY]]) {
  const parts = Math.max(2, Math.ceil(Math.hypot(toX - fromX, toY - fromY) / GAP_M));
  return Array.from({ length: parts }, (_, at) => {
    const share = (at + 0.5) / parts;
    return [fromX + share * (toX - fromX), fromY + share * (toY - fromY)];
  });
}

/** The corners of a floor's triangles in the world. @param {Marker} marker @returns {Point[]} */
function cornersOf({ points, scale, pose: { position, orientation } }) {
  const local = points.map(({ x, y }) => /** @type {Point} */ ([x * scale.x, y * scale.y]));
  return placed([local], { x: position.x, y: position.y, yaw: yawOf(orientation) })[0];
}

/** The edges that belong to one triangle only, with the floor at their left. @param {Marker[]} floors */
function borderOf(floors) {
  /** @type {Map<string, [Point, Point]>} */ const edges = new Map();
  for (const floor of floors) {
    const corners = cornersOf(floor);
    for (let at = 0; at + 2 < corners.length; at += 3) {
      const triangle = corners.slice(at, at + 3);
      triangle.forEach((from, side) => {
        const to = triangle[(side + 1) % 3];
        const [there, back] = [`${keyOf(from)} ${keyOf(to)}`, `${keyOf(to)} ${keyOf(from)}`];
        if (!edges.delete(back)) edges.set(there, [from, to]);
      });
    }
  }
  return [...edges.values()];
}
