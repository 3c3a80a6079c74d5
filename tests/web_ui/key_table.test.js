// The list of keys in "?": complete texts, and every key of the view does something there.

import assert from "node:assert/strict";
import { test } from "node:test";

import { translator } from "../../web_ui/i18n/index.js";
import keyTexts from "../../web_ui/i18n/keys.texts.js";
import { watchKeyboard } from "../../web_ui/input/keyboard.js";
import { KEY_TABLE, keyLabel } from "../../web_ui/input/key_table.js";

/** Press a key on the view; returns whether the view has used it. @param {string} key @param {boolean} shiftKey @param {boolean} moves */
function press(key, shiftKey, moves) {
  /** @type {Record<string, (event: any) => void>} */ const listeners = {};
  const element = { addEventListener: (/** @type {string} */ name, /** @type {any} */ listener) => void (listeners[name] = listener) };
  const scene = { camera: { turn() {} }, zoom() {}, setView() {}, setSensors() {} };
  const dragController = { mode: moves, setMode() {}, nudge() {}, drop: async () => {}, next() {} };
  let isUsed = false;
  const event = { key: key === "Space" ? " " : key, shiftKey, repeat: false, stopPropagation() {}, preventDefault: () => void (isUsed = true) };
  watchKeyboard(/** @type {any} */ (element), /** @type {any} */ (scene), /** @type {any} */ (dragController), () => {});
  listeners.keydown(event);
  return isUsed;
}

test("every group and row has its text in every language", () => {
  for (const [language, texts] of Object.entries(keyTexts)) {
    for (const { name, note, rows } of KEY_TABLE) {
      for (const text of [name, ...(note === undefined ? [] : [note]), ...rows.map((row) => row.text)]) {
        assert.ok(texts[text], `${language} ${text}`);
      }
    }
  }
});

test("the view uses every key that the list has for it", () => {
  for (const name of ["view", "move"]) {
    const group = KEY_TABLE.find((each) => each.name === name);
    for (const { keys, held = [] } of group?.rows ?? []) {
      for (const key of keys) assert.ok(press(key, held.includes("Shift"), name === "move"), `${name} ${key}`);
    }
  }
  assert.equal(press("q", false, false), false);
});

test("keys are shown by symbols, by their names in the language, or by their letters", () => {
  const t = translator("de", keyTexts);
  assert.deepEqual(["ArrowUp", "Home", "t", "F9", ",", "Control"].map((key) => keyLabel(key, t)), ["↑", "Pos1", "T", "F9", ",", "Strg"]); // prettier-ignore
});
