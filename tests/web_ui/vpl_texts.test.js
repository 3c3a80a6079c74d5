import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import texts from "../../web_ui/i18n/vpl.texts.js";
import { nameKey } from "../../web_ui/vpl/blocks.js";
import { BLOCKS } from "../../web_ui/vpl/kinds.js";

const FOLDER = new URL("../../web_ui/vpl/", import.meta.url);
/** Names of the robot's variables look like keys, too. */
const VARIABLES = /^(?:prox|acc|button|timer|sound)\.(?:horizontal|ground|\d|period|wave)/;
const PREFIXES = new Set(Object.keys(texts.en).map((key) => key.split(".")[0]));

/** The keys that the modules name as strings. That every text is named is tested by tests/test_languages.py. */
function named() {
  const source = readdirSync(FOLDER, { recursive: true })
    .map(String)
    .filter((name) => name.endsWith(".js"))
    .map((name) => readFileSync(new URL(name, FOLDER), "utf8"))
    .join("\n");
  return [...source.matchAll(/"(\w+(?:\.\w+)+)"/g)]
    .map(([, key]) => key)
    .filter((key) => PREFIXES.has(key.split(".")[0]) && !VARIABLES.test(key));
}

test("every text that a module names exists", () => {
  const keys = named();
  assert.ok(keys.length > 50);
  assert.deepEqual(
    keys.filter((key) => !(key in texts.en)),
    [],
  );
});

test("every block has a name", () => {
  assert.deepEqual(
    [...BLOCKS.keys()].filter((name) => !(nameKey(name) in texts.en)),
    [],
  );
});

test("leaving a mode has a text for each block that it removes", () => {
  for (const { name, type, mode } of BLOCKS.values()) {
    if (mode !== "basic" && (type === "event" || type === "action"))
      assert.ok(`mode.removed.${name}` in texts.en, name);
  }
});
