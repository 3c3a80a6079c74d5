// The pictures of events, further conditions and states.

import { ARROWS, BUTTONS, ROLL, TAP } from "../blocks.js";
import { fromAbove, fromBehind, fromSide, hand, line, shape, short, tag } from "./shapes.js";

const SENSE = "var(--sense)";
const MARK = "var(--bot-mark)";
const EDGE = "var(--bot-edge)";
const SET = "var(--sense-fill)";
const DARK = "var(--tyre)";
const LEFT_OUT = "var(--bot-2)";

/** Turns of the four arrows, in the order of the values. */
const TURNS = [0, 270, 180, 90];
/** Places of the distance sensors, with their turns. */
export const SENSORS = /** @type {const} */ ([
  [13.8, 31.3, -62],
  [22.6, 21.6, -31],
  [35, 18, 0],
  [47.4, 21.6, 31],
  [56.2, 31.3, 62],
  [25, 64.5, 180],
  [45, 64.5, 180],
]);
/** The keys of the remote control, row by row. */
export const KEYPAD_LABELS = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "−", "0", "+"];
/** The place of a key of the keypad. @param {number} key */
export const keyAt = (key) => ({ x: 13 + (key % 3) * 15.5, y: 7 + Math.floor(key / 3) * 15 });

/** @param {string} d @param {boolean} isSet @param {Record<string, string | number>} [more] */
const part = (d, isSet, more) => shape(d, isSet ? SET : LEFT_OUT, isSet ? SENSE : MARK, { "stroke-width": 1.6, ...more });

/** @param {readonly number[]} values */
function button(values) {
  const [mode, key] = [values[5], values[6]];
  if (mode === BUTTONS) {
    const arrows = TURNS.map((turn, index) =>
      part("M0 -17.5L6 -9H-6Z", values[index] === 1, { transform: `translate(35 37) rotate(${turn})` }),
    );
    return fromAbove(35, 38, 1.25) + arrows.join("") + part("M30 37a5 5 0 1 1 10 0a5 5 0 1 1-10 0Z", values[4] === 1);
  }
  if (mode === ARROWS) {
    const pieces = TURNS.map((turn, index) =>
      part("M-8.5 -11.5A14 14 0 0 1 8.5 -11.5L18 -21A27 27 0 0 0 -18 -21Z", key === index, {
        transform: `translate(35 36) rotate(${turn})`,
      }),
    );
    return pieces.join("") + part("M27 36a8 8 0 1 1 16 0a8 8 0 1 1-16 0Z", key === 4);
  }
  const keys = KEYPAD_LABELS.map((label, index) => {
    const { x, y } = keyAt(index);
    const isSet = index === key;
    const frame = tag("rect", {
      x, y, width: 13, height: 12.5, rx: 3,
      fill: isSet ? SET : LEFT_OUT, stroke: isSet ? SENSE : MARK, "stroke-width": 1.6,
    }); // prettier-ignore
    const font = { "font-size": 9, "font-weight": 700, "text-anchor": "middle", fill: isSet ? DARK : EDGE };
    return frame + tag("text", { x: x + 6.5, y: y + 9.5, ...font }, label);
  });
  return keys.join("");
}

/** What a sensor waits for: left out, near, far, between. @param {number} state */
const sensorFill = (state) => ["var(--bot)", SET, DARK, "var(--paper-gray)"][state];

/** @param {readonly number[]} values */
function prox(values) {
  const sensors = SENSORS.map(([x, y, turn], index) => {
    const state = values[index];
    const [width, height] = index < 5 ? [11, 8] : [10, 7];
    const edge = state === 0 || state === 2 ? MARK : SENSE;
    const square = tag("rect", {
      x: -width / 2, y: -height / 2, width, height, rx: 3, transform: `translate(${x} ${y}) rotate(${turn})`,
      fill: sensorFill(state), stroke: edge, "stroke-width": 1.6,
    }); // prettier-ignore
    if (state === 0) return square;
    const beam = state === 2 ? "M-3 -7.5h6" : "M-5.5 -7.5h11";
    return square + (index < 5 ? line(beam, edge, 2.2, { transform: `translate(${x} ${y}) rotate(${turn})` }) : "");
  });
  return fromAbove(35, 45, 0.72) + sensors.join("");
}

/** @param {readonly number[]} values */
function proxground(values) {
  const eyes = [0, 1].map((index) => {
    const state = values[index];
    const x = index === 0 ? 20 : 38;
    const seen = ["none", "var(--paper)", "var(--tape)", "var(--paper-gray)"][state];
    const eye = { x, y: 38, width: 12, height: 9, rx: 3, "stroke-width": 2 };
    if (state === 0) return tag("rect", { ...eye, fill: LEFT_OUT, stroke: MARK });
    return (
      tag("path", { d: `M${x} 44h12l2 12h-16z`, fill: SET, opacity: 0.45 }) +
      tag("rect", { ...eye, fill: seen, stroke: SENSE }) +
      tag("rect", { x: x - 2, y: 57, width: 16, height: 7, rx: 1.5, fill: seen, stroke: EDGE, "stroke-width": 1.5 })
    );
  });
  const wheel = (/** @type {number} */ x) => tag("rect", { x, y: 34, width: 6, height: 20, rx: 3, fill: DARK });
  const body = "M13 44V22c0-7 9-12 22-12s22 5 22 12V44a4 4 0 0 1-4 4H17a4 4 0 0 1-4-4Z";
  return line("M6 58H64", EDGE, 2) + shape(body, "var(--bot)") + wheel(8) + wheel(56) + eyes.join("");
}

const DEGREES_PER_STEP = 15;

/** @param {readonly number[]} values */
function acc([mode, orientation]) {
  if (mode === TAP) {
    const finger = "M36 34.5a4.5 4.5 0 0 1-4.5-4.5V12c0-4 3-7 7-7h12v17l-7 2h-3V30a4.5 4.5 0 0 1-4.500 4.500Z";
    return (
      fromSide(34, 50) +
      shape(finger, "var(--skin)") +
      line("M44 29v-5M50 28.5v-5", EDGE, 1.6) +
      line("M22 32l-5-3M26 26.5 23 22M14 37l-5-.5", SENSE)
    );
  }
  const turn = -orientation * DEGREES_PER_STEP;
  const scale = Array.from({ length: 13 }, (_, step) => {
    const angle = ((step - 6) * DEGREES_PER_STEP * Math.PI) / 180;
    const at = (/** @type {number} */ r) => `${short(35 + r * Math.sin(angle))} ${short(44 - r * Math.cos(angle))}`;
    return `M${at(30)}L${at(step % 3 === 0 ? 25 : 27.5)}`;
  });
  const needle = tag("path", { d: "M35 10l-5-8h10z", fill: SENSE, transform: `rotate(${turn} 35 44)` });
  const robot = mode === ROLL ? fromBehind(35, 46, turn) : fromSide(35, 46, { turn });
  return line(scale.join(""), MARK, 1.6) + needle + robot;
}

function clap() {
  const hands = hand("translate(22 46) rotate(16) scale(-1.7 1.7)") + hand("translate(48 46) rotate(-16) scale(1.7 1.7)");
  return hands + line("M35 17V7M24 19.5 18.5 11M46 19.5 51.5 11", SENSE, 2.8);
}

function timeout() {
  return (
    tag("circle", { cx: 35, cy: 39, r: 21, fill: "var(--bot)", stroke: EDGE, "stroke-width": 2 }) +
    line("M35 39V26M35 39l8 6", SENSE, 3) +
    line("M15 19l7-6M55 19l-7-6M22 57l-4 6M48 57l4 6", EDGE, 3)
  );
}

function init() {
  return fromAbove(35, 42, 0.95) + tag("path", { d: "M29 30v21l17-10.500z", fill: SET, stroke: SENSE, "stroke-width": 2 });
}

/** @param {readonly number[]} values */
function posture([which]) {
  const ground = line("M6 62H64", EDGE, 2);
  if (which === 1) return ground + fromBehind(35, 41, 90);
  if (which === 2) return ground + fromSide(35, 48, { turn: 180 });
  return ground + fromSide(35, 28, { turn: -14 }) + line("M18 46v8M35 48v8M52 46v8", SENSE);
}

/** @param {readonly number[]} values */
function groundmean([presence]) {
  const seen = presence === 1 ? "var(--paper)" : "var(--tape)";
  return (
    fromSide(35, 32) +
    tag("path", { d: "M38 44h14l4 12H34z", fill: SET, opacity: 0.45 }) +
    tag("rect", { x: 8, y: 56, width: 54, height: 8, rx: 2, fill: seen, stroke: EDGE, "stroke-width": 1.5 })
  );
}

const QUARTERS = [
  "M34 34V12A22 22 0 0 0 12 34Z",
  "M38 34V12A22 22 0 0 1 60 34Z",
  "M34 38V60A22 22 0 0 1 12 38Z",
  "M38 38V60A22 22 0 0 0 60 38Z",
];

/** Four quarters: left out (dashed), on (orange), off (white). @param {readonly number[]} values */
export function quarters(values) {
  return QUARTERS.map((d, index) => {
    if (values[index] === 0) return shape(d, LEFT_OUT, MARK, { "stroke-dasharray": "3 3" });
    return shape(d, values[index] === 1 ? "var(--ring)" : "var(--bot)", EDGE);
  }).join("");
}

const COMPARISONS = ["", "≤", "&lt;", "=", "&gt;", "≥"];

/** @param {readonly number[]} values */
function counter([comparison, value]) {
  const font = { "text-anchor": "middle", "font-weight": 700, fill: "var(--ink)" };
  return (
    tag("text", { x: 35, y: 31, "font-size": 22, ...font }, `№ ${COMPARISONS[comparison]}`) +
    tag("text", { x: 35, y: 57, "font-size": 24, ...font }, String(value))
  );
}

/** @type {Record<string, (values: readonly number[]) => string>} */
export const EVENT_PICTURES = {
  button,
  prox,
  proxground,
  acc,
  clap,
  timeout,
  init,
  posture,
  groundmean,
  statefilter: quarters,
  counter,
};
