// The controls of the editor of a block: what can be pressed in its picture, its sliders, its choices. Pure; labels are
// keys of texts.

import { ARROWS, BUTTONS, kindOf, TAP } from "../blocks.js";
import { LENGTH_UNIT } from "../kinds.js";
import { press, withBlockMode, withKey, withNote, withNumber, withValue } from "../parameters.js";
import { keyAt, KEYPAD_LABELS, SENSORS } from "./events.js";

/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../kinds.js").Mode} Mode */
/** @typedef {{ key: string, values?: Record<string, string | number> }} Words */
/** @typedef {{ x: number, y: number, width: number, height: number }} Area   in the picture */
/**
 * - `press`: a part of the picture with several states; `key`: one of several parts
 * - `slider`: its value is one of `stops`
 * - `choice`: one of few
 * - `notes`: the melody, columns with five lines
 *
 * @typedef {{ kind: "press", index: number, area: Area, words: Words, isOn: boolean }} PressControl
 * @typedef {{ kind: "key", key: number, area: Area, words: Words, isOn: boolean }} KeyControl
 * @typedef {{ kind: "slider", index: number, value: number, words: Words }
 *   & { stops: number[], look: string, shown: Words }} SliderControl
 * @typedef {{ kind: "choice", index: number, value: number, words: Words }
 *   & { options: { value: number, words: Words }[] }} ChoiceControl
 * @typedef {{ kind: "notes", values: readonly number[] }} NotesControl
 * @typedef {PressControl | KeyControl | SliderControl | ChoiceControl | NotesControl} Control
 */

const BUTTON_NAMES = ["forward", "left", "backward", "right", "center"];
/** The text of the name of a button, or of an arrow of the remote control. @param {number} index */
export function buttonKey(index) {
  const name = BUTTON_NAMES[index];
  return `part.${name}`;
}
const QUARTER_SIZE = 24;

/** @param {number} x @param {number} y  the middle @param {number} width @param {number} [height] @returns {Area} */
const around = (x, y, width, height = width) => ({ x: x - width / 2, y: y - height / 2, width, height });

/** Middles of the five buttons, and of the five keys of the remote control. */
const BUTTONS_AT = [
  [35, 23],
  [21, 37],
  [35, 51],
  [49, 37],
  [35, 37],
];
const ARROWS_AT = [
  [35, 17],
  [16, 36],
  [35, 55],
  [54, 36],
  [35, 36],
];

/**
 * The values that a slider can have: those on the grid of the editor, and the present one.
 *
 * @param {Block} block
 * @param {number} index
 */
export function stopsOf(block, index) {
  const { least, greatest, step } = kindOf(block).parameters[index];
  const stops = new Set([block.values[index]]);
  // Only some values are on the grid of the distances: those that an editor of VPL can set.
  const stride = step > 0 ? step : 5;
  for (let value = least; value <= greatest; value += stride) stops.add(withNumber(block, index, value).values[index]);
  return [...stops].sort((a, b) => a - b);
}

/**
 * @param {Block} block @param {number} index @param {string} look
 * @param {Words} words @param {Words} [shown]   how the value is read
 * @returns {SliderControl}
 */
function slider(block, index, look, words, shown = { key: "value.number", values: { number: block.values[index] } }) {
  return { kind: "slider", index, stops: stopsOf(block, index), value: block.values[index], look, words, shown };
}

/**
 * @param {Block} block
 * @param {number} index
 * @param {string} name  of the texts
 * @param {number} from
 * @param {number} to
 * @returns {ChoiceControl}
 */
function choice(block, index, name, from, to) {
  const options = [];
  for (let value = from; value <= to; value += 1) options.push({ value, words: { key: `${name}.${value}` } });
  return { kind: "choice", index, value: block.values[index], words: { key: name }, options };
}

/**
 * @param {Block} block @param {number} index @param {Area} area @param {string} part  text of its name
 * @param {string} states   texts of its states
 * @returns {PressControl}
 */
function pressed(block, index, area, part, states) {
  const value = block.values[index];
  return { kind: "press", index, area, words: { key: `${states}.state.${value}`, values: { part } }, isOn: value > 0 };
}

/** @param {Block} block @param {boolean} advanced @returns {Control[]} */
function buttonControls(block, advanced) {
  const [mode, key] = [block.values[5], block.values[6]];
  const modes = advanced || mode !== BUTTONS ? [choice(block, 5, "button.mode", 0, 2)] : [];
  if (mode === BUTTONS) {
    const parts = BUTTONS_AT.map(([x, y], index) =>
      pressed(block, index, around(x, y, 13.5), buttonKey(index), "button"),
    );
    return [...modes, ...parts];
  }
  /** @param {number} each @param {Area} area @param {Words} words @returns {KeyControl} */
  const keyOf = (each, area, words) => ({ kind: "key", key: each, area, words, isOn: each === key });
  if (mode === ARROWS) {
    return [
      ...modes,
      ...ARROWS_AT.map(([x, y], each) => keyOf(each, around(x, y, 16), { key: buttonKey(each) })),
    ];
  }
  return [
    ...modes,
    ...KEYPAD_LABELS.map((label, each) => {
      const { x, y } = keyAt(each);
      return keyOf(each, { x: x - 1, y: y - 1, width: 15, height: 14.5 }, { key: "part.key", values: { key: label } });
    }),
  ];
}

/**
 * @param {Block} block
 * @param {boolean} advanced
 * @param {number} low  index of the lower threshold
 * @returns {Control[]}
 */
function thresholds(block, advanced, low) {
  if (!advanced) return [];
  return [
    slider(block, low, "limit", { key: `${block.name}.low` }),
    slider(block, low + 1, "limit", { key: `${block.name}.high` }),
  ];
}

/** @param {Block} block @param {string} states @returns {Control[]} */
function quarterControls(block, states) {
  return [0, 1, 2, 3].map((index) => {
    const area = around(index % 2 === 0 ? 23 : 49, index < 2 ? 23 : 49, QUARTER_SIZE);
    return pressed(block, index, area, `part.quarter.${index}`, states);
  });
}

/** @param {Block} block @returns {Control[]} */
function colorControls(block) {
  return ["red", "green", "blue"].map((color, index) => slider(block, index, color, { key: `color.${color}` }));
}

/** @type {Record<string, (block: Block, advanced: boolean) => Control[]>} */
const CONTROLS = {
  button: buttonControls,
  prox: (block, advanced) => [
    ...SENSORS.map(([x, y], index) => pressed(block, index, around(x, y, 12), `part.sensor.${index}`, "prox")),
    ...thresholds(block, advanced, 7),
  ],
  proxground: (block, advanced) => [
    ...[26, 44].map((x, index) =>
      pressed(block, index, around(x, 50, 17, 30), `part.ground.${index}`, "proxground"),
    ),
    ...thresholds(block, advanced, 2),
  ],
  acc: (block, advanced) => {
    const [mode, orientation] = block.values;
    const modes = advanced || mode !== TAP ? [choice(block, 0, "acc.mode", 0, 2)] : [];
    const degrees = { key: "value.degrees", values: { degrees: orientation * 15 } };
    return mode === TAP ? modes : [...modes, slider(block, 1, "angle", { key: "acc.angle" }, degrees)];
  },
  posture: (block) => [choice(block, 0, "posture", 1, 3)],
  groundmean: (block) => [choice(block, 0, "groundmean", 1, 2)],
  statefilter: (block) => quarterControls(block, "statefilter"),
  setstate: (block) => quarterControls(block, "setstate"),
  counter: (block) => [choice(block, 0, "counter", 1, 5), slider(block, 1, "count", { key: "counter.value" })],
  setcounter: (block) => [choice(block, 0, "setcounter", 1, 3), slider(block, 1, "count", { key: "counter.value" })],
  move: (block) => [
    slider(block, 0, "left", { key: "move.left" }),
    slider(block, 1, "right", { key: "move.right" }),
  ],
  colortop: colorControls,
  colorbottom: colorControls,
  sound: ({ values }) => [{ kind: "notes", values }],
  timer: (block) => {
    const seconds = { key: "value.seconds", values: { seconds: block.values[0] / 1000 } };
    return [slider(block, 0, "time", { key: "timer.value" }, seconds)];
  },
  play: (block) => [slider(block, 0, "count", { key: "play.value" })],
}; // prettier-ignore

/**
 * The controls of a block in a mode; none: there is nothing to choose.
 *
 * @param {Block} block
 * @param {Mode} mode
 */
export function controlsOf(block, mode) {
  return CONTROLS[block.name]?.(block, mode !== "basic") ?? [];
}

/**
 * The block after a control was used.
 *
 * @param {Block} block
 * @param {Control} control
 * @param {Mode} mode
 * @param {number} [value]   of a slider or a choice; of notes: 5 · column + line
 */
export function used(block, control, mode, value = 0) {
  switch (control.kind) {
    case "press":
      return press(block, control.index, mode !== "basic");
    case "key":
      return withKey(block, control.key);
    case "choice":
      if (control.words.key.endsWith(".mode")) return withBlockMode(block, value);
      return withValue(block, control.index, value);
    case "notes":
      return withNote(block, Math.floor(value / NOTES), value % NOTES);
    default:
      // A present value beside the grid stays until the slider moves.
      return value === block.values[control.index] ? block : withNumber(block, control.index, value);
  }
}

export const NOTES = 5;
export const COLUMNS = 6;

/**
 * What a column of the melody has on a line.
 *
 * @param {number} value
 * @param {number} note
 * @returns {"" | "short" | "long"}
 */
export function lengthAt(value, note) {
  if (value % LENGTH_UNIT !== note) return "";
  return value >= 2 * LENGTH_UNIT ? "long" : "short";
}
