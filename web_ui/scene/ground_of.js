// The ground of a playground as a whole: where it is, its border, and whether walls stand around it. Pure.

import { MARKER } from "../state/markers.js";

/** @typedef {import("../state/markers.js").Marker} Marker */
/** @typedef {import("./surroundings.js").Ground} Ground */

/** Corners at the same place, to 0.1 mm. @param {readonly [number, number]} point */
function keyOf([x, y]) {
  return `${Math.round(x * 1e4)},${Math.round(y * 1e4)}`;
}

/** @param {Iterable<Marker>} markers @returns {Ground | null}  null: nothing stands or lies there */
export function groundOf(markers) {
  const all = [...markers];
  const floors = all.filter(({ ns, type }) => ns.startsWith("floor/") && type === MARKER.TRIANGLE_LIST);
  const solids = all.filter(({ ns }) => ns.startsWith("solid/"));
  const places = floors.length > 0 ? floors.flatMap(cornersOf) : solids.map(({ pose: { position: { x, y } } }) => [x, y]);
  if (places.length === 0) return null;
  const [xs, ys] = [0, 1].map((axis) => places.map((place) => place[axis]));
  const walled = new Set(solids.map(({ ns }) => ns.slice("solid/".length)));
  return {
    bounds: { min: { x: Math.min(...xs), y: Math.min(...ys) }, max: { x: Math.max(...xs), y: Math.max(...ys) } },
    edges: borderOf(floors),
    isWalled: floors.every(({ ns }) => walled.has(ns.slice("floor/".length))),
  };
}

/** The corners of a floor's triangles in the world. @param {Marker} marker @returns {[number, number][]} */
function cornersOf({ points, scale, pose: { position, orientation } }) {
  const { x, y, z, w } = orientation;
  const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  return points.map((point) => {
    const [px, py] = [point.x * scale.x, point.y * scale.y];
    return [position.x + px * cos - py * sin, position.y + px * sin + py * cos];
  });
}

/** The edges that belong to one triangle only, with the floor at their left. @param {Marker[]} floors */
function borderOf(floors) {
  /** @type {Map<string, [number, number][]>} */ const edges = new Map();
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
