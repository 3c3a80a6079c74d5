// Parts of the pictures of blocks, as SVG in the coordinates of a block: 74 wide, 72 high. Colors are those of the page
// (styles/tokens.css); only the lights of the robot have colors of their own.

export const WIDTH = 74;
export const HEIGHT = 72;

/** The outline of an event has a nose at the right, the side of its actions. */
const EVENT =
  "M12 1.5H58a9 9 0 0 1 9 9V27c5 1 5 5 5 9s0 8-5 9V61.5a9 9 0 0 1-9 9H12A10.5 10.5 0 0 1 1.5 60V12A10.5 10.5 0 0 1 12 1.5Z";
const ACTION =
  "M10 1.5H62A8.5 8.5 0 0 1 70.5 10V62a8.5 8.5 0 0 1-8.5 8.5H10A8.5 8.5 0 0 1 1.5 62V10A8.5 8.5 0 0 1 10 1.5Z";

/** @typedef {Record<string, string | number>} Attributes */

/** @param {string} tag @param {Attributes} attributes @param {string} [inside] */
export function tag(tag, attributes, inside) {
  const written = Object.entries(attributes).map(([name, value]) => ` ${name}="${value}"`);
  return inside === undefined ? `<${tag}${written.join("")}/>` : `<${tag}${written.join("")}>${inside}</${tag}>`;
}

/** A closed shape. @param {string} d @param {string} fill @param {string} [edge] @param {Attributes} [more] */
export function shape(d, fill, edge = "var(--bot-edge)", more = {}) {
  return tag("path", { d, fill, stroke: edge, "stroke-width": 2, "stroke-linejoin": "round", ...more });
}

/**
 * A line with round ends.
 *
 * @param {string} d
 * @param {string} color
 * @param {number} [width]
 * @param {Attributes} [more]
 */
export function line(d, color, width = 2.4, more = {}) {
  const ends = { "stroke-linecap": "round", "stroke-linejoin": "round" };
  return tag("path", { d, fill: "none", stroke: color, "stroke-width": width, ...ends, ...more });
}

/**
 * The outline of a block.
 *
 * @param {import("../kinds.js").BlockType} type
 */
export function outline(type) {
  if (type === "action") return shape(ACTION, "var(--act-soft)", "var(--act-line)");
  if (type === "event") return shape(EVENT, "var(--sense-soft)", "var(--sense-line)");
  return shape(EVENT, "var(--run-soft)", "var(--run)", { "stroke-dasharray": type === "state" ? "none" : "5 3" });
}

/** The robot from above. @param {number} x @param {number} y @param {number} scale @param {string} [fill] */
export function fromAbove(x, y, scale, fill = "var(--bot)") {
  const d = "M-20 -6C-20 -19 -10 -25 0 -25S20 -19 20 -6V20a4 4 0 0 1-4 4H-16a4 4 0 0 1-4-4Z";
  return shape(d, fill, "var(--bot-edge)", { transform: `translate(${x} ${y}) scale(${scale})` });
}

/**
 * The robot from the side.
 *
 * @param {number} x @param {number} y
 * @param {{ top?: string, bottom?: string, turn?: number, lamp?: "top" | "bottom" }} [look]   fills, degrees, and the
 *   part that is a lamp, on or off
 */
export function fromSide(x, y, { top = "var(--bot)", bottom = "var(--bot-2)", turn = 0, lamp } = {}) {
  const edges = { top: "var(--bot-edge)", bottom: "var(--bot-edge)" };
  if (lamp !== undefined) edges[lamp] = "var(--act)";
  const lower = shape("M-22 1H23V9a3 3 0 0 1-3 3H-19a3 3 0 0 1-3-3Z", bottom, edges.bottom);
  const upper = shape("M-22 1V-3a9 9 0 0 1 9-9H16a7 7 0 0 1 7 7V1Z", top, edges.top);
  return tag(
    "g",
    { transform: `translate(${x} ${y}) rotate(${turn})` },
    (lamp === "top" ? lower + upper : upper + lower) +
      tag("circle", { cx: -9, cy: 9, r: 6.5, fill: "var(--tyre)" }) +
      tag("circle", { cx: -9, cy: 9, r: 2.4, fill: "var(--bot-2)" }),
  );
}

/**
 * The robot from behind, upright or turned around its long axis.
 *
 * @param {number} x
 * @param {number} y
 * @param {number} turn
 */
export function fromBehind(x, y, turn) {
  const wheel = (/** @type {number} */ at) =>
    tag("rect", { x: at, y: 0, width: 6, height: 13, rx: 2.5, fill: "var(--tyre)" });
  return tag(
    "g",
    { transform: `translate(${x} ${y}) rotate(${turn})` },
    wheel(-22) +
      wheel(16) +
      shape("M-19 9V-4a7 7 0 0 1 7-7H12a7 7 0 0 1 7 7V9Z", "var(--bot)") +
      line("M-19 2H19", "var(--bot-mark)", 1.6),
  );
}

const HAND =
  "M8 12.5V6.3a1.4 1.4 0 0 1 2.8 0v5V4.7a1.4 1.4 0 0 1 2.8 0v6.6V5.9a1.4 1.4 0 0 1 2.8 0V14c0 4-2.2 6.5-5.3 6.5-2.4 0-3.9-1.1-5.1-3.3L4.3 13.7a1.4 1.4 0 0 1 2.4-1.4L8 14Z";

/** A hand. @param {string} transform */
export function hand(transform) {
  const placed = { "stroke-width": 1.15, transform: `${transform} translate(-10.5 -13)` };
  return shape(HAND, "var(--skin)", "var(--bot-edge)", placed);
}

/** The color of a light, as bright as a person sees it. @param {readonly number[]} levels  red, green, blue: 0 to 32 */
export function lightColor(levels) {
  const shown = levels.map((level) => Math.round(255 * Math.sqrt(level / 32)));
  return `rgb(${shown.join(" ")})`;
}

/** Numbers with at most one digit after the point: pictures stay short. @param {number} value */
export const short = (value) => Math.round(value * 10) / 10;
