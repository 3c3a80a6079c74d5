// A block in words: the name of its button, for screen readers and tooltips. Pure.

import { ARROWS, BUTTONS, nameKey, TAP } from "../blocks.js";
import { LENGTH_UNIT, SILENCE } from "../kinds.js";
import { buttonKey } from "./controls.js";
import { KEYPAD_LABELS } from "./events.js";

/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../../i18n/index.js").Translate} Translate */

const DEGREES_PER_STEP = 15;

/**
 * The parts of a block that are set, such as "left near".
 *
 * @param {readonly number[]} values
 * @param {(index: number) => string} part    text of the name of a part
 * @param {string} states                     texts of states
 * @param {Translate} t
 */
function parts(values, part, states, t) {
  return values.flatMap((value, index) => (value > 0 ? [t(`${states}.state.${value}`, { part: t(part(index)) })] : []));
}

/** @type {Record<string, (values: readonly number[], t: Translate) => string[]>} */
const WORDS = {
  button: (values, t) => {
    const [mode, key] = [values[5], values[6]];
    if (mode === BUTTONS) return values.slice(0, 5).flatMap((value, index) => (value > 0 ? [t(buttonKey(index))] : []));
    const name = mode === ARROWS ? t(buttonKey(key)) : t("part.key", { key: KEYPAD_LABELS[key] });
    return [t(`button.mode.${mode}`), name];
  },
  prox: (values, t) => parts(values.slice(0, 7), (index) => `part.sensor.${index}`, "prox", t),
  proxground: (values, t) => parts(values.slice(0, 2), (index) => `part.ground.${index}`, "proxground", t),
  acc: ([mode, orientation], t) =>
    mode === TAP
      ? [t("acc.mode.0")]
      : [t(`acc.mode.${mode}`), t("value.degrees", { degrees: orientation * DEGREES_PER_STEP })],
  posture: ([which], t) => [t(`posture.${which}`)],
  groundmean: ([which], t) => [t(`groundmean.${which}`)],
  statefilter: (values, t) => parts(values, (index) => `part.quarter.${index}`, "statefilter", t),
  setstate: (values, t) => parts(values, (index) => `part.quarter.${index}`, "setstate", t),
  counter: ([comparison, value], t) => [t(`counter.${comparison}`), String(value)],
  setcounter: ([operation, value], t) => [t(`setcounter.${operation}`), String(value)],
  move: ([left, right], t) => [`${t("move.left")} ${left}`, `${t("move.right")} ${right}`],
  colortop: (levels, t) => colorWords(levels, t),
  colorbottom: (levels, t) => colorWords(levels, t),
  sound: (values, t) =>
    values.map((value) => {
      const note = value % LENGTH_UNIT;
      if (note === SILENCE) return t("note.rest");
      return value >= 2 * LENGTH_UNIT ? t("note.long", { note: note + 1 }) : String(note + 1);
    }),
  timer: ([milliseconds], t) => [t("value.seconds", { seconds: milliseconds / 1000 })],
  play: ([number]) => [String(number)],
};

/** @param {readonly number[]} levels @param {Translate} t */
const colorWords = ([red, green, blue], t) => [
  `${t("color.red")} ${red}`,
  `${t("color.green")} ${green}`,
  `${t("color.blue")} ${blue}`,
];

/** A block in words. @param {Block} block @param {Translate} t */
export function sentence(block, t) {
  const name = t(nameKey(block));
  const words = WORDS[block.name]?.(block.values, t) ?? [];
  return words.length === 0 ? name : t("block.words", { name, words: words.join(", ") });
}
