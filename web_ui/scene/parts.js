// Named parts of the robot with their positions in its frame (meters, docs/spec/thymio-robot.md sections 1,
// 7.1 and 8.3). Drawing, hit tests and browser tests use this table.

import { GROUND, PROXIMITY } from "../state/names.js";

/** @typedef {{ x: number, y: number, z: number }} Place */
/** @typedef {{ name: string, group: string, index: number, place: Place, normal: Place, radius: number, color: number }} Light */

export const HEIGHT_M = 0.053;
export const WHEEL = { radius: 0.022, width: 0.015, track: 0.094 };

const UP = { x: 0, y: 0, z: 1 };
const RED = 0xff2a1f;
const YELLOW = 0xffb23e;
const BLUE = 0x2f6bff;
const TOP_M = HEIGHT_M + 0.0006;

/** Five buttons on top: position and size of the touch target. */
export const BUTTON_PLACES = /** @type {Record<string, Place>} */ ({
  center: { x: 0.048, y: 0, z: HEIGHT_M },
  forward: { x: 0.063, y: 0, z: HEIGHT_M },
  backward: { x: 0.033, y: 0, z: HEIGHT_M },
  left: { x: 0.048, y: 0.015, z: HEIGHT_M },
  right: { x: 0.048, y: -0.015, z: HEIGHT_M },
});

/** Position and direction of each proximity sensor (degrees from straight ahead). */
export const PROXIMITY_PLACES = /** @type {Record<string, Place & { yaw: number }>} */ (
  Object.fromEntries(
    [
      [62, 48.5, 40],
      [75, 25.5, 20],
      [79.5, 0, 0],
      [75, -25.5, -20],
      [62, -48.5, -40],
      [-29.5, 29.5, 180],
      [-29.5, -29.5, 180],
    ].map(([x, y, degrees], index) => [
      PROXIMITY[index],
      { x: x / 1000, y: y / 1000, z: 0.034, yaw: (degrees * Math.PI) / 180 },
    ]),
  )
);

/** Origin of the beams of a lidar (docs/robot.md). */
export const LIDAR_PLACE = { x: 0.02, y: 0, z: 0.05 };

export const GROUND_PLACES = /** @type {Record<string, Place>} */ ({
  [GROUND[0]]: { x: 0.072, y: 0.0115, z: 0 },
  [GROUND[1]]: { x: 0.072, y: -0.0115, z: 0 },
});

/** @param {number} degrees @returns {Place} */
function facing(degrees) {
  return { x: Math.cos((degrees * Math.PI) / 180), y: Math.sin((degrees * Math.PI) / 180), z: 0 };
}

/**
 * @param {string} group
 * @param {number} radius
 * @param {[number, number, number, Place, number][]} rows  x, y, z in mm, outward direction, color
 * @returns {Light[]}
 */
function lights(group, radius, rows) {
  return rows.map(([x, y, z, normal, color], index) => ({
    name: `led.${group}.${index}`,
    group,
    index,
    place: { x: x / 1000, y: y / 1000, z: z / 1000 },
    normal,
    radius,
    color,
  }));
}

const TOP_MM = TOP_M * 1000;

/** Every light of one color; the RGB lights are `RGB_LIGHTS`. */
export const LIGHTS = [
  ...lights("circle", 0.0021, [
    [73.2, 0, TOP_MM, UP, YELLOW],
    [66, -17.2, TOP_MM, UP, YELLOW],
    [48.9, -24.3, TOP_MM, UP, YELLOW],
    [31.7, -17.2, TOP_MM, UP, YELLOW],
    [24.6, 0, TOP_MM, UP, YELLOW],
    [31.7, 17.2, TOP_MM, UP, YELLOW],
    [48.9, 24.3, TOP_MM, UP, YELLOW],
    [66, 17.2, TOP_MM, UP, YELLOW],
  ]),
  ...lights("buttons", 0.0011, [
    [55.6, 0, TOP_MM, UP, RED],
    [48, -7.6, TOP_MM, UP, RED],
    [40.4, 0, TOP_MM, UP, RED],
    [48, 7.6, TOP_MM, UP, RED],
  ]),
  ...lights("proximity", 0.0018, [
    [59.6, 55.8, 40, facing(60), RED],
    [72.3, 36.6, 40, facing(27), RED],
    [80.6, 3.2, 40, facing(2), RED],
    [80.6, -3.2, 40, facing(-2), RED],
    [72.3, -36.6, 40, facing(-27), RED],
    [59.6, -55.8, 40, facing(-60), RED],
    [-30.8, 40.6, 40, facing(180), RED],
    [-30.8, -40.6, 40, facing(180), RED],
  ]),
  ...lights("ground", 0.0018, [
    [79.2, 12, 15.6, facing(9), RED],
    [79.2, -12, 15.6, facing(-9), RED],
  ]),
  ...lights("temperature", 0.0018, [
    [36, 56.8, 36.7, facing(90), RED],
    [29, 56.8, 36.7, facing(90), BLUE],
  ]),
  ...lights("microphone", 0.0018, [[26.7, -56.8, 36.7, facing(-90), BLUE]]),
  ...lights("remote", 0.0018, [[41.7, -56.8, 36.7, facing(-90), RED]]),
];

/** The RGB lights: the top of the shell, and two strips low on the sides. */
export const RGB_LIGHTS = /** @type {Record<string, Place>} */ ({
  top: { x: 0.005, y: 0.03, z: HEIGHT_M },
  bottom_left: { x: 0.039, y: 0.0562, z: 0.014 },
  bottom_right: { x: 0.039, y: -0.0562, z: 0.014 },
});

/** The position of every named part in the robot's frame. */
export const PARTS = new Map(
  /** @type {[string, Place][]} */ ([
    ["robot", { x: 0.02, y: 0, z: HEIGHT_M }],
    ["pen", { x: 0, y: 0, z: HEIGHT_M }],
    ["wheel.left", { x: 0, y: WHEEL.track / 2, z: WHEEL.radius }],
    ["wheel.right", { x: 0, y: -WHEEL.track / 2, z: WHEEL.radius }],
    ...Object.entries(BUTTON_PLACES).map(([name, place]) => [`button.${name}`, place]),
    ...Object.entries(PROXIMITY_PLACES).map(([name, place]) => [`proximity.${name}`, place]),
    ...Object.entries(GROUND_PLACES).map(([name, place]) => [`ground.${name}`, place]),
    ...LIGHTS.map(({ name, place }) => [name, place]),
    ...Object.entries(RGB_LIGHTS).map(([name, place]) => [`led.${name}`, place]),
  ]),
);
