// Plane geometry: poses, convex outlines and overlap. Meters, radians, counter-clockwise. Pure.
// The same overlap tests as in thymio_sim_ros/sim/model/geometry.py, so that page and simulator agree.

/** @typedef {readonly [number, number]} Point */
/** @typedef {{ x: number, y: number, yaw: number }} Pose */
/** @typedef {{ vertices: readonly Point[] } | { middle: Point, radius: number }} Footprint  a convex polygon or a disc */

const EXACT = 1e-12;
const ON_THE_EDGE = 1e-9;
const ROUND = 28;

/**
 * Transform points from the frame of a pose to the frame in which the pose is given.
 *
 * @param {Pose} pose
 * @param {readonly Point[]} points
 * @returns {Point[]}
 */
export function placed({ x, y, yaw }, points) {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  return points.map(([u, v]) => [x + cos * u - sin * v, y + sin * u + cos * v]);
}

/** A point in the frame of a pose. @param {Pose} pose @param {Point} point @returns {Point} */
export function inFrame({ x, y, yaw }, [px, py]) {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  return [cos * (px - x) + sin * (py - y), cos * (py - y) - sin * (px - x)];
}

/**
 * The corners of a rectangle about its center, counter-clockwise.
 *
 * @param {number} sizeX
 * @param {number} sizeY
 * @returns {Point[]}
 */
export function rectangle(sizeX, sizeY) {
  const [x, y] = [sizeX / 2, sizeY / 2];
  return [[-x, -y], [x, -y], [x, y], [-x, y]]; // prettier-ignore
}

/** A circle as a polygon. @param {number} radius @param {number} [sides] @returns {Point[]} */
export function circle(radius, sides = ROUND) {
  return Array.from({ length: sides }, (_, side) => {
    const angle = (2 * Math.PI * side) / sides;
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
}

/** Whether two footprints share more than an edge. @param {Footprint} one @param {Footprint} two */
export function overlap(one, two) {
  if ("radius" in one) {
    if ("radius" in two) return distance(one.middle, two.middle) < one.radius + two.radius;
    return discOverlaps(one.middle, one.radius, two.vertices);
  }
  if ("radius" in two) return discOverlaps(two.middle, two.radius, one.vertices);
  return !separates(one.vertices, two.vertices) && !separates(two.vertices, one.vertices);
}

/** Whether a point is inside a convex polygon or on its edge. @param {readonly Point[]} polygon @param {Point} point */
export function containsPoint(polygon, [x, y]) {
  return polygon.every(([ax, ay], index) => {
    const [bx, by] = polygon[(index + 1) % polygon.length];
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= -ON_THE_EDGE;
  });
}

/** @param {Point} one @param {Point} two */
export function distance([ax, ay], [bx, by]) {
  return Math.hypot(bx - ax, by - ay);
}

/** Normalize an angle to (-π, π]. @param {number} angle */
export function wrapped(angle) {
  const turn = angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
  return turn <= -Math.PI + EXACT ? Math.PI : turn;
}

/** @param {Point} middle @param {number} radius @param {readonly Point[]} hull */
function discOverlaps(middle, radius, hull) {
  let outside = false;
  for (const [index, [bx, by]] of hull.entries()) {
    const [ax, ay] = hull.at(index - 1) ?? [bx, by];
    const [dx, dy, px, py] = [bx - ax, by - ay, middle[0] - ax, middle[1] - ay];
    if (dx * py - dy * px < 0) outside = true;
    const along = Math.min(1, Math.max(0, (px * dx + py * dy) / (dx * dx + dy * dy)));
    if (Math.hypot(px - along * dx, py - along * dy) < radius) return true;
  }
  return !outside;
}

/**
 * Whether an edge of the first polygon has all of the second on its outer side.
 *
 * @param {readonly Point[]} one
 * @param {readonly Point[]} two
 */
function separates(one, two) {
  return one.some(([bx, by], index) => {
    const [ax, ay] = one.at(index - 1) ?? [bx, by];
    return two.every(([x, y]) => (bx - ax) * (y - ay) - (by - ay) * (x - ax) <= EXACT);
  });
}
