// Footprints of all bodies of the world: which can be moved, and which are in the way. Pure.
// Only a preview for the user: the simulator decides whether a position is free.

import { ROBOT_HEIGHT_M, ROBOT_OUTLINE } from "../playground/robot_outline.js";
import { MARKER } from "../state/markers.js";
import { yawOf } from "../state/robot.js";

/** @typedef {[number, number]} Point  meters */
/** @typedef {{ x: number, y: number, yaw: number }} Pose */
/** @typedef {import("../state/markers.js").Marker} Marker */
/** @typedef {import("../state/index.js").State} State */
/**
 * @typedef {object} PlacedBody
 * @property {string} name        name in the world
 * @property {string | null} robot  name of the robot in topics; null for other bodies
 * @property {Pose} pose
 * @property {Point[][]} outline  convex polygons in the frame of the body
 * @property {number} height
 */

const ROUND = 20;
/** Footprints that overlap by less than this only touch. */
const TOUCHING_M = 0.0005;
const STEPS_OF_HEIGHT = 24;

/** Bodies that can be moved: robots and movable objects. @param {State} state @returns {PlacedBody[]} */
export function movables(state) {
  const names = state.simulator?.movables ?? [];
  const bodies = [...state.objects.values()].map(bodyOf);
  return [...robots(state), ...bodies.filter(({ name }) => names.includes(name))];
}

/** Bodies that may be in the way of the named one. @param {State} state @param {string} name */
export function obstacles(state, name) {
  const solids = [...state.markers.values(), ...state.objects.values()].filter(({ ns }) => ns.startsWith("solid/"));
  return [...robots(state), ...solids.map(bodyOf)].filter((body) => body.name !== name);
}

/** The ground, as convex polygons. @param {State} state */
export function floors({ markers }) {
  const all = [...markers.values()].filter(({ ns }) => ns.startsWith("floor/")).map(bodyOf);
  return all.flatMap(({ outline, pose }) => placed(outline, pose));
}

/**
 * The first obstacle at a pose of a body, or null.
 *
 * @param {PlacedBody} body
 * @param {Pose} pose
 * @param {PlacedBody[]} others
 */
export function blocker(body, pose, others) {
  const mine = placed(body.outline, pose);
  return (
    others.find(({ outline, pose: there }) => {
      const theirs = placed(outline, there);
      return mine.some((one) => theirs.some((two) => overlap(one, two)));
    }) ?? null
  );
}

/**
 * The first body on a line of sight and the height of the hit; null if there is none. The ray is sampled at heights
 * from top to ground, since all bodies are prisms.
 *
 * @param {{ origin: { x: number, y: number, z: number }, direction: { x: number, y: number, z: number } }} ray
 * @param {PlacedBody[]} bodies
 * @returns {{ body: PlacedBody, z: number, x: number, y: number } | null}
 */
export function hit(ray, bodies) {
  if (ray.direction.z >= 0) return null;
  const top = Math.max(0, ...bodies.map(({ height }) => height));
  for (let step = STEPS_OF_HEIGHT; step >= 0; step--) {
    const z = (top * step) / STEPS_OF_HEIGHT;
    const place = atHeight(ray, z);
    if (place === null) continue;
    const body = bodies.find(
      ({ outline, pose, height }) =>
        z <= height && placed(outline, pose).some((polygon) => isInside(polygon, place)),
    );
    if (body !== undefined) return { body, z, ...place };
  }
  return null;
}

/**
 * The point of a line of sight at height z; null if it never reaches that height.
 *
 * @param {Parameters<typeof hit>[0]} ray
 * @param {number} z
 */
export function atHeight({ origin, direction }, z) {
  const far = (z - origin.z) / direction.z;
  if (!Number.isFinite(far) || far < 0) return null;
  return { x: origin.x + far * direction.x, y: origin.y + far * direction.y };
}

/** The radius of a body about its center. @param {PlacedBody} body */
export function reach({ outline }) {
  return Math.max(...outline.flat().map(([x, y]) => Math.hypot(x, y)));
}

/** @param {State} state @returns {PlacedBody[]} */
function robots({ robots: known, simulator }) {
  return Object.entries(known).flatMap(([robot, { latest }]) => {
    if (latest === null) return [];
    const { x, y, yaw } = latest.pose;
    const name = simulator?.worldNames?.[robot] ?? robot;
    return [{ name, robot, pose: { x, y, yaw }, outline: [ROBOT_OUTLINE], height: ROBOT_HEIGHT_M }];
  });
}

/** @param {Marker} marker @returns {PlacedBody} */
export function bodyOf({ ns, type, pose: { position, orientation }, scale, points }) {
  const pose = { x: position.x, y: position.y, yaw: yawOf(orientation) };
  const name = ns.slice(ns.indexOf("/") + 1);
  const [x, y] = [scale.x / 2, scale.y / 2];
  if (type === MARKER.CUBE) {
    return { name, robot: null, pose, outline: [[[x, -y], [x, y], [-x, y], [-x, -y]]], height: scale.z }; // prettier-ignore
  }
  if (type === MARKER.CYLINDER) {
    const corner = (/** @type {number} */ step) => (2 * Math.PI * step) / ROUND;
    const round = Array.from(
      { length: ROUND },
      (_, step) => /** @type {Point} */ ([x * Math.cos(corner(step)), y * Math.sin(corner(step))]),
    );
    return { name, robot: null, pose, outline: [round], height: scale.z };
  }
  // A prism: its outline consists of the triangles of its top.
  const top = Math.max(...points.map(({ z }) => z));
  /** @type {Point[][]} */ const outline = [];
  for (let at = 0; at + 2 < points.length; at += 3) {
    const corners = points.slice(at, at + 3);
    if (corners.every(({ z }) => z === top))
      outline.push(corners.map((point) => /** @type {Point} */ ([point.x, point.y])));
  }
  return { name, robot: null, pose, outline, height: 2 * position.z };
}

/** @param {Point[][]} outline @param {Pose} pose @returns {Point[][]} */
export function placed(outline, { x, y, yaw }) {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  return outline.map((polygon) =>
    polygon.map(([u, v]) => /** @type {Point} */ ([x + u * cos - v * sin, y + u * sin + v * cos])),
  );
}

/**
 * Whether two convex polygons overlap (separating axis test): they do not if their projections on the normal of any
 * edge are disjoint.
 *
 * @param {Point[]} one
 * @param {Point[]} two
 */
export function overlap(one, two) {
  return [one, two].every((polygon) =>
    polygon.every(([x, y], index) => {
      const [nextX, nextY] = polygon[(index + 1) % polygon.length];
      const length = Math.hypot(nextX - x, nextY - y) || 1;
      const [nx, ny] = [(nextY - y) / length, (x - nextX) / length];
      const span = (/** @type {Point[]} */ points) => {
        const along = points.map(([px, py]) => px * nx + py * ny);
        return [Math.min(...along), Math.max(...along)];
      };
      const [[lowOne, highOne], [lowTwo, highTwo]] = [span(one), span(two)];
      return lowOne < highTwo - TOUCHING_M && lowTwo < highOne - TOUCHING_M;
    }),
  );
}

/** @param {Point[]} polygon  counter-clockwise @param {{ x: number, y: number }} point */
export function isInside(polygon, { x: px, y: py }) {
  return polygon.every(([x, y], index) => {
    const [nextX, nextY] = polygon[(index + 1) % polygon.length];
    return (nextX - x) * (py - y) - (nextY - y) * (px - x) >= 0;
  });
}
