import assert from "node:assert/strict";
import { test } from "node:test";

import editorTexts from "../../web_ui/i18n/editor.texts.js";
import {
  looksLikeToolbox,
  readToolbox,
  unknownNames,
  WHOLE,
  writeToolbox,
} from "../../web_ui/editor/toolbox_file.js";

test("a file hides blocks and limits modes, and is written and read back", () => {
  const text = '{ "toolbox": 1, "hide": ["sound", "category:loops"], "modes": ["basic"] }';
  const { toolbox } = readToolbox(text);
  assert.deepEqual(toolbox, { hide: ["sound", "category:loops"], modes: ["basic"] });
  assert.deepEqual(readToolbox(writeToolbox(/** @type {NonNullable<typeof toolbox>} */ (toolbox))).toolbox, toolbox);
  assert.deepEqual(readToolbox(`\uFEFF${text}`).toolbox, toolbox);
});

test("without entries nothing is limited", () => {
  assert.deepEqual(readToolbox('{ "toolbox": 1 }').toolbox, WHOLE);
  assert.deepEqual(readToolbox(writeToolbox(WHOLE)).toolbox, WHOLE);
});

test("names that no language has are reported", () => {
  assert.deepEqual(unknownNames({ hide: ["sound", "fly"], modes: ["easy"] }, ["sound", "basic"]), ["fly", "easy"]);
});

test("only a list of blocks looks like one", () => {
  assert.ok(looksLikeToolbox('\n{ "hide": [], "toolbox" : 2 }'));
  assert.ok(!looksLikeToolbox('{ "objects": [] }') && !looksLikeToolbox("var toolbox = 1"));
});

for (const [text, key, values] of /** @type {const} */ ([
  ["{", "json", null],
  ["[]", "format", { found: "–" }],
  ["null", "format", { found: "–" }],
  ['{ "toolbox": 2 }', "format", { found: "2" }],
  ['{ "toolbox": 1, "hidden": [] }', "entry", { found: "hidden", known: "hide, modes" }],
  ['{ "toolbox": 1, "hide": "sound" }', "list", { name: "hide", found: '"sound"' }],
  ['{ "toolbox": 1, "modes": [1] }', "list", { name: "modes", found: "[1]" }],
])) {
  test(`refused: ${text}`, () => {
    const { toolbox, problem } = readToolbox(text);
    assert.equal(toolbox, null);
    assert.equal(problem?.key, `toolbox.${key}`);
    assert.ok(`toolbox.${key}` in editorTexts.en);
    if (values !== null) assert.deepEqual(problem?.values, values);
  });
}
