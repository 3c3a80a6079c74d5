import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import texts from "../../web_ui/i18n/vpl.texts.js";
import { nameKey } from "../../web_ui/vpl/blocks.js";
import { BLOCKS } from "../../web_ui/vpl/kinds.js";

const FOLDER = new URL("../../web_ui/vpl/", import.meta.url);
const PREFIXES = new Set(Object.keys(texts.en).map((key) => key.split(".")[0]));

/** The keys that the modules name, as strings or as templates. */
function named() {
  const source = readdirSync(FOLDER)
    .filter((name) => name.endsWith(".js"))
    .map((name) => readFileSync(new URL(name, FOLDER), "utf8"))
    .join("\n");
  const keys = [...source.matchAll(/"(\w+(?:\.\w+)+)"/g)]
    .map(([, key]) => key)
    .filter((key) => PREFIXES.has(key.split(".")[0]));
  const templates = [...source.matchAll(/`(\w+\.[^`\n]*)`/g)]
    .map(([, template]) => template)
    .filter((each) => PREFIXES.has(each.split(".")[0]));
  return { keys, templates };
}

test("every text that a module names exists, and every text is named", () => {
  const { keys, templates } = named();
  assert.deepEqual(
    keys.filter((key) => !(key in texts.en)),
    [],
  );
  const fitting = templates.map(
    (each) => new RegExp(`^${each.replaceAll(".", "\\.").replace(/\$\{[^}]*\}/g, "\\w+")}$`),
  );
  const unused = Object.keys(texts.en).filter((key) => !keys.includes(key) && !fitting.some((each) => each.test(key)));
  assert.deepEqual(unused, []);
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
