// The pictures of actions.

import { LENGTH_UNIT, SILENCE } from "../kinds.js";
import { quarters } from "./events.js";
import { fromAbove, fromSide, lightColor, line, shape, short, tag } from "./shapes.js";

const ACT = "var(--act)";
const EDGE = "var(--bot-edge)";
const FASTEST = 500;
const BRIGHTEST = 32;
const LIGHTS = ["var(--light-red)", "var(--light-green)", "var(--light-blue)"];

/** The slider of a wheel. @param {number} x  of its middle @param {number} speed */
function wheelSlider(x, speed) {
  const at = 36 - (speed / FASTEST) * 20;
  const track = { fill: "var(--bot)", stroke: "var(--act-line)", "stroke-width": 1.5 };
  const bar = { y: short(Math.min(at, 36)), height: short(Math.abs(at - 36)), fill: "var(--act-fill)" };
  return (
    tag("rect", { x: x - 4, y: 10, width: 8, height: 52, rx: 4, ...track }) +
    tag("rect", { x: x - 4, width: 8, ...bar }) +
    line(`M${x - 4} 36h8`, "var(--act-line)", 1.2) +
    tag("rect", { x: x - 8, y: short(at - 4), width: 16, height: 8, rx: 4, fill: ACT })
  );
}

/** The way that the robot takes with these speeds. @param {number} left @param {number} right */
function way(left, right) {
  if (left === 0 && right === 0) return tag("rect", { x: 31, y: 37, width: 10, height: 10, rx: 2.5, fill: ACT });
  const speed = (left + right) / 2;
  const turn = (left - right) / (2 * FASTEST); // of one half turn
  if (Math.abs(speed) < Math.abs(left - right) / 8) {
    const side = turn > 0 ? 1 : -1;
    return tag(
      "g",
      { transform: `translate(36 42) scale(${side} 1)` },
      line("M-8 3A8 8 0 1 1 6 5", ACT, 3) + line("M9 -1L6 6L-1 4", ACT, 3),
    );
  }
  const points = Array.from({ length: 9 }, (_, index) => {
    const part = index / 8;
    const angle = turn * 2.2 * part;
    const forward = speed / FASTEST;
    const reach = 9 + 9 * Math.abs(forward);
    const x = (Math.sign(speed) * reach * (1 - Math.cos(angle))) / (turn === 0 ? 1 : turn * 2.2);
    const y = (Math.sign(speed) * reach * Math.sin(angle)) / (turn === 0 ? 1 : turn * 2.2);
    return turn === 0 ? [0, Math.sign(speed) * reach * part] : [x, y];
  });
  const [endX, endY] = points[8];
  const [beforeX, beforeY] = points[6];
  const heading = (Math.atan2(endX - beforeX, endY - beforeY) * 180) / Math.PI;
  const start = 42 + Math.sign(speed) * 7;
  const path = points.map(([x, y]) => `${short(36 + x)} ${short(start - y)}`).join("L");
  const head = { transform: `translate(${short(36 + endX)} ${short(start - endY)}) rotate(${short(heading)})` };
  return line(`M${path}`, ACT, 3) + line("M-5.5 5.5L0 0L5.5 5.5", ACT, 3, head);
}

/** @param {readonly number[]} values */
function move([left, right]) {
  return fromAbove(36, 40, 0.72) + way(left, right) + wheelSlider(11, left) + wheelSlider(61, right);
}

/** @param {readonly number[]} levels */
function levelLines(levels) {
  return levels
    .map((level, index) => {
      const y = 48 + 7 * index;
      const x = short(12 + (46 * level) / BRIGHTEST);
      const knob = { cx: x, cy: y, r: 3.6, fill: LIGHTS[index], stroke: "var(--bot)", "stroke-width": 1.5 };
      return line(`M12 ${y}H58`, LIGHTS[index], 3, { "stroke-opacity": 0.35 }) + tag("circle", knob);
    })
    .join("");
}

/** @param {readonly number[]} levels */
const isLit = (levels) => levels.some((level) => level > 0);

/** @param {readonly number[]} levels */
function colortop(levels) {
  const color = lightColor(levels);
  const glow = isLit(levels) ? tag("ellipse", { cx: 35, cy: 20, rx: 29, ry: 17, fill: color, opacity: 0.25 }) : "";
  return glow + fromSide(35, 26, { lamp: "top", ...(isLit(levels) ? { top: color } : {}) }) + levelLines(levels);
}

/** @param {readonly number[]} levels */
function colorbottom(levels) {
  const color = lightColor(levels);
  const glow = isLit(levels) ? tag("ellipse", { cx: 35, cy: 38, rx: 30, ry: 6, fill: color, opacity: 0.55 }) : "";
  return glow + fromSide(35, 24, { lamp: "bottom", ...(isLit(levels) ? { bottom: color } : {}) }) + levelLines(levels);
}

/** @param {readonly number[]} values */
function sound(values) {
  const faint = { "stroke-opacity": 0.5 };
  const staff = [20, 28.5, 37, 45.5, 54].map((y) => line(`M8 ${y}H64`, "var(--act-line)", 1.5, faint));
  const notes = values.map((value, column) => {
    const note = value % LENGTH_UNIT;
    const cx = 13 + 9.2 * column;
    if (note === SILENCE) return line(`M${short(cx - 2)} 62h4`, ACT, 1.8, { "stroke-opacity": 0.6 });
    const isLong = value >= 2 * LENGTH_UNIT;
    const look = isLong ? { rx: 4.5, fill: "var(--bot)" } : { rx: 3.7, fill: ACT };
    return tag("ellipse", { cx: short(cx), cy: 54 - 8.5 * note, ry: 3.4, stroke: ACT, "stroke-width": 1.8, ...look });
  });
  return staff.join("") + notes.join("");
}

const LONGEST_MS = 4000;

/** A clock of four seconds. @param {readonly number[]} values */
function timer([milliseconds]) {
  const part = Math.min(Math.max(milliseconds / LONGEST_MS, 0), 1);
  const angle = 2 * Math.PI * part;
  const end = `${short(36 + 19 * Math.sin(angle))} ${short(40 - 19 * Math.cos(angle))}`;
  const piece =
    part >= 1
      ? tag("circle", { cx: 36, cy: 40, r: 19, fill: "var(--act-fill)" })
      : tag("path", { d: `M36 40V21A19 19 0 ${part > 0.5 ? 1 : 0} 1 ${end}Z`, fill: "var(--act-fill)" });
  return (
    line("M31 8h10M36 8v8M53 21l4-4", EDGE, 3) +
    tag("circle", { cx: 36, cy: 40, r: 22.5, fill: "var(--bot)", stroke: EDGE, "stroke-width": 2 }) +
    piece +
    line(`M36 40V21M36 40L${end}`, ACT)
  );
}

/** @param {string} text @param {number} y @param {number} size */
const words = (text, y, size) =>
  tag("text", { x: 36, y, "font-size": size, "text-anchor": "middle", "font-weight": 700, fill: "var(--ink)" }, text);

const OPERATIONS = ["", "=", "+", "−"];

/** @param {readonly number[]} values */
function setcounter([operation, value]) {
  return words(`№ ${OPERATIONS[operation]}`, 31, 22) + words(String(value), 57, 24);
}

const DISC = "M36 14a17 17 0 1 1-.1 0Z";

/** @param {readonly number[]} values */
function play([number]) {
  return shape(DISC, "var(--bot)") + tag("path", { d: "M31 23v16l13-8z", fill: ACT }) + words(String(number), 64, 15);
}

function playstop() {
  return shape(DISC, "var(--bot)") + tag("rect", { x: 29.5, y: 24.5, width: 13, height: 13, rx: 2, fill: ACT });
}

/** @type {Record<string, (values: readonly number[]) => string>} */
export const ACTION_PICTURES = {
  move,
  colortop,
  colorbottom,
  sound,
  timer,
  setstate: quarters,
  setcounter,
  play,
  playstop,
};
