// The stop button says which robots it stops.

import assert from "node:assert/strict";
import { test } from "node:test";

import { robotNames } from "../../web_ui/browser/robot_names.js";
import { wordOf } from "../../web_ui/header/stop.js";
import { translator } from "../../web_ui/i18n/index.js";

const t = translator("en");
/** @param {string[]} names @param {{ selected?: string, toAll?: boolean }} [choice] */
const state = (names, { selected = names[0], toAll = false } = {}) => ({
  robots: /** @type {any} */ (Object.fromEntries(names.map((name) => [name, {}]))),
  selected,
  toAll,
});

test("one robot needs no name", () => {
  assert.equal(wordOf(state([""]), t), "Stop robot");
  assert.equal(wordOf(state([], { selected: "" }), t), "Stop robot");
});

test("of several, the chosen one is named, as its class calls it, or all are counted", () => {
  assert.equal(wordOf(state(["a", "b"], { selected: "b" }), t), "Stop b");
  robotNames.set("b", "Mia");
  assert.equal(wordOf(state(["a", "b"], { selected: "b" }), t), "Stop Mia");
  robotNames.set("b", "");
  assert.equal(wordOf(state(["a", "b"], { toAll: true }), t), "Stop all 2");
});
