// The robot seen from above, and its height (docs/spec/thymio-robot.md section 1.1).

/** @typedef {[number, number]} Point  meters */

const RADIUS_M = 0.08;
const HALF_WIDTH_M = 0.055;
const REAR_M = -0.03;

export const ROBOT_HEIGHT_M = 0.053;

/** A convex polygon, counter-clockwise: the round front, and the two corners at the rear. @type {Point[]} */
export const ROBOT_OUTLINE = (() => {
  const corner = Math.asin(HALF_WIDTH_M / RADIUS_M);
  const front = Array.from({ length: 11 }, (_, step) => {
    const angle = -corner + (corner * step) / 5;
    return /** @type {Point} */ ([RADIUS_M * Math.cos(angle), RADIUS_M * Math.sin(angle)]);
  });
  return [...front, [REAR_M, HALF_WIDTH_M], [REAR_M, -HALF_WIDTH_M]];
})();
