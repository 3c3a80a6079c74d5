// The robot from above as shapes of a drawing of 440 x 404 units, 1.68 units per millimeter, front up. Pure.

/** @typedef {readonly [x: number, y: number]} Point */
/**
 * The bar of a distance sensor: it widens outwards and is filled from the robot outwards.
 *
 * @typedef {object} Bar
 * @property {readonly [Point, Point]} inner   near the robot
 * @property {readonly [Point, Point]} outer   in the same order
 * @property {Point} label   lower center of the number
 * @property {readonly [x: number, y: number, degrees: number, width: number]} window   the dark window of the sensor
 */

export const SIZE = { width: 440, height: 404 };
/** The middle of buttons and ring, of the pen hole, and of the wheels. */
export const BUTTONS_AT = { x: 220, y: 186 };
export const PEN_AT = { x: 220, y: 257 };

/** In Thymio's order: five in front from left to right, two at the rear. @type {readonly Bar[]} */
export const BARS = [
  {
    inner: [[111.7, 155.4], [128.6, 141.3]],
    outer: [[55, 106.4], [90.2, 76.9]],
    label: [63.6, 85],
    window: [129.8, 159.9, -40, 18],
  },
  {
    inner: [[146.7, 126.4], [167.2, 118.5]],
    outer: [[109, 61.6], [151.9, 45.2]],
    label: [125.4, 44.3],
    window: [162.3, 136.5, -21, 18],
  },
  {
    inner: [[209, 109], [231, 109]],
    outer: [[197, 35], [243, 35]],
    label: [220, 25],
    window: [220, 124.1, 0, 18],
  },
  {
    inner: [[272.8, 118.5], [293.3, 126.4]],
    outer: [[288.1, 45.2], [331, 61.6]],
    label: [314.6, 44.3],
    window: [277.7, 136.5, 21, 18],
  },
  {
    inner: [[311.4, 141.3], [328.3, 155.4]],
    outer: [[349.8, 76.9], [385, 106.4]],
    label: [376.4, 85],
    window: [310.2, 159.9, 40, 18],
  },
  {
    inner: [[141.8, 315.4], [163.8, 315.4]],
    outer: [[129.8, 359.4], [175.8, 359.4]],
    label: [152.8, 377.4],
    window: [152.8, 302, 0, 16],
  },
  {
    inner: [[276.2, 315.4], [298.2, 315.4]],
    outer: [[264.2, 359.4], [310.2, 359.4]],
    label: [287.2, 377.4],
    window: [287.2, 302, 0, 16],
  },
];

/** The hull: front an arc of 80 mm radius, rear corners of 10 mm. */
export const HULL =
  "M127.6 157.4L138.7 147.9L150.7 139.8L163.6 133L177.1 127.6L191.1 123.7L205.5 121.3L220 120.6L234.5 121.3L248.9 123.7" +
  "L262.9 127.6L276.4 133L289.3 139.8L301.3 147.9L312.4 157.4L312.4 288.6Q312.4 305.4 295.6 305.4L144.4 305.4" +
  "Q127.6 305.4 127.6 288.6Z";
/** Upper left corners of the wheels, 18 x 66. */
export const WHEELS = /** @type {readonly Point[]} */ ([[123.6, 222], [298.4, 222]]);
/** The bars of the motors: x, and the middle and half of the length. */
export const MOTORS = { x: /** @type {const} */ ([102.6, 337.4]), y: 255, half: 33 };
/** The strips of the lights below, at both sides under the hull: upper ends. */
export const STRIPS = /** @type {readonly Point[]} */ ([[119.5, 176], [320.5, 176]]);
export const STRIP_LENGTH = 36;

const RING_RADIUS = 44;
const RING_ANGLE = 26; // degrees of one segment

/** @param {number} degrees  clockwise from the front @returns {Point} */
function onRing(degrees) {
  const angle = (degrees * Math.PI) / 180;
  return [BUTTONS_AT.x + RING_RADIUS * Math.sin(angle), BUTTONS_AT.y - RING_RADIUS * Math.cos(angle)];
}

/** @param {readonly Point[]} points */
function pathOf(points) {
  return points.map(([x, y], at) => `${at === 0 ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
}

/** One of the eight lights around the buttons. @param {number} index  clockwise from the front */
export function ringPath(index) {
  const [[x0, y0], [x1, y1]] = [onRing(45 * index - RING_ANGLE / 2), onRing(45 * index + RING_ANGLE / 2)];
  return `M${x0.toFixed(1)} ${y0.toFixed(1)}A${RING_RADIUS} ${RING_RADIUS} 0 0 1 ${x1.toFixed(1)} ${y1.toFixed(1)}`;
}

/** The filled part of a bar; empty for nothing. @param {Bar} bar @param {number} share  0…1 */
export function barPath({ inner, outer }, share) {
  if (share <= 0) return "";
  const [[a, b], [c, d]] = [inner, outer];
  /** @param {Point} from @param {Point} to @returns {Point} */
  const at = (from, to) => [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share];
  return `${pathOf([a, at(a, c), at(b, d), b])}Z`;
}

/** The bar of a motor, from standing still forward or backward; empty for nothing. @param {0 | 1} side @param {number} share  -1…1 */
export function motorPath(side, share) {
  if (share === 0) return "";
  return `M${MOTORS.x[side]} ${MOTORS.y}V${(MOTORS.y - MOTORS.half * share).toFixed(1)}`;
}
