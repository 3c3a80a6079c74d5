// All keys of the page, as the list in "?" shows them. Texts are those of keys.json.
//
// A key is a `KeyboardEvent.key`; keys of one group are pressed together ("Shift", "ArrowUp") or are alternatives.

import { HAND_KEYS } from "./hand_keys.js";

/**
 * @typedef {object} KeyRow
 * @property {readonly string[]} [held]   held while a key is pressed: "Control" or "Shift"
 * @property {readonly string[]} keys     alternatives, or the same for several directions
 * @property {string} text                what they do
 */
/** @typedef {{ name: string, note?: string, rows: readonly KeyRow[] }} KeyGroup   texts of its title and of a note */

const ARROWS = ["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"];
const SHIFT = ["Shift"];
const CONTROL = ["Control"];

/** @type {readonly KeyGroup[]} */
export const KEY_TABLE = [
  {
    name: "view",
    note: "view.note",
    rows: [
      { keys: [...ARROWS, "Enter"], text: "view.buttons" },
      { held: SHIFT, keys: ARROWS, text: "view.turn" },
      { keys: ["+", "-"], text: "view.zoom" },
      { keys: ["Home"], text: "view.home" },
      { keys: ["t"], text: "view.top" },
      { keys: ["f"], text: "view.follow" },
      { keys: ["e"], text: "view.eye" },
      { keys: ["b"], text: "view.beams" },
      { keys: ["m"], text: "view.move" },
      { keys: ["Space"], text: "view.pause" },
      { keys: Object.values(HAND_KEYS).map((key) => key.toLowerCase()), text: "view.hands" },
    ],
  },
  {
    name: "move",
    rows: [
      { keys: ARROWS, text: "move.push" },
      { keys: [",", "."], text: "move.turn" },
      { keys: ["n"], text: "move.next" },
      { keys: ["Enter"], text: "move.drop" },
      { keys: ["Escape"], text: "move.end" },
    ],
  },
  {
    name: "page",
    rows: [
      { keys: ["Escape"], text: "page.stop" },
      { keys: SHIFT, text: "page.press" },
    ],
  },
  {
    name: "program",
    rows: [
      { keys: ["F9"], text: "program.run" },
      { held: CONTROL, keys: ["Enter"], text: "program.load" },
      { keys: ["F10"], text: "program.halt" },
      { keys: ["F7"], text: "program.line" },
      { keys: ["F8"], text: "program.restart" },
      { held: CONTROL, keys: ["b"], text: "program.mark" },
      { held: CONTROL, keys: ["Space"], text: "program.complete" },
      { held: CONTROL, keys: ["f"], text: "program.find" },
      { keys: ["F12"], text: "program.definition" },
      { keys: ["F2"], text: "program.rename" },
      { held: ["Control", "Shift"], keys: ["o"], text: "program.outline" },
      { held: CONTROL, keys: ["s"], text: "program.save" },
      { keys: ["Escape"], text: "program.leave" },
    ],
  },
  {
    name: "blocks",
    note: "blocks.note",
    rows: [
      { keys: ["t"], text: "blocks.toolbox" },
      { keys: ["w"], text: "blocks.workspace" },
      { keys: ARROWS, text: "blocks.go" },
      { keys: ["Enter"], text: "blocks.change" },
      { keys: ["m"], text: "blocks.move" },
      { keys: ["x"], text: "blocks.detach" },
      { keys: ["d"], text: "blocks.copy" },
      { keys: ["n", "b"], text: "blocks.stack" },
      { keys: ["Delete"], text: "blocks.remove" },
      { held: CONTROL, keys: ["z"], text: "blocks.undo" },
      { held: CONTROL, keys: ["y"], text: "blocks.redo" },
    ],
  },
  {
    name: "build",
    rows: [
      { keys: ["Enter"], text: "build.place" },
      { keys: [",", "."], text: "build.turn" },
      { keys: ["n"], text: "build.next" },
      { held: CONTROL, keys: ["d"], text: "build.copy" },
      { keys: ["Delete"], text: "build.remove" },
      { held: CONTROL, keys: ["z"], text: "build.undo" },
      { held: CONTROL, keys: ["y"], text: "build.redo" },
    ],
  },
];

const SYMBOLS = /** @type {Readonly<Record<string, string>>} */ ({
  ArrowUp: "↑",
  ArrowDown: "↓",
  ArrowLeft: "←",
  ArrowRight: "→",
  "-": "−",
});

/**
 * How a key is shown: a symbol, its name in the language, or its letter.
 *
 * @param {string} key
 * @param {import("../i18n/index.js").Translate} keysText
 */
export function keyLabel(key, keysText) {
  const name = keysText(`key.${key}`);
  return SYMBOLS[key] ?? (name === `key.${key}` ? key.toUpperCase() : name);
}
