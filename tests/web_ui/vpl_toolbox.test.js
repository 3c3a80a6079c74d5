import assert from "node:assert/strict";
import { test } from "node:test";

import { VplError } from "../../web_ui/vpl/errors.js";
import { offered, readToolbox, WHOLE, writeToolbox } from "../../web_ui/vpl/toolbox.js";

test("a list hides blocks and chooses a mode", () => {
  const toolbox = readToolbox('{ "vpl-toolbox": 1, "modes": ["basic"], "hidden": ["clap", "sound"] }');
  assert.deepEqual(offered(toolbox, "event", "basic"), ["button", "prox", "proxground", "acc"]);
  assert.deepEqual(offered(toolbox, "action", "basic"), ["move", "colortop", "colorbottom"]);
  assert.deepEqual(toolbox.modes, ["basic"]);
});

test("without entries everything is shown; a list is written and read back", () => {
  assert.deepEqual(readToolbox('{ "vpl-toolbox": 1 }'), WHOLE);
  const toolbox = /** @type {const} */ ({ modes: ["advanced", "extended"], hidden: ["timer", "init"] });
  assert.deepEqual(readToolbox(writeToolbox(toolbox)), toolbox);
});

for (const [text, key, found] of [
  ["{", "toolbox.json", undefined],
  ["[]", "toolbox.format", "–"],
  ["{}", "toolbox.format", "–"],
  ['{ "vpl-toolbox": 2 }', "toolbox.format", "2"],
  ['{ "vpl-toolbox": 1, "hide": [] }', "toolbox.entry", "hide"],
  ['{ "vpl-toolbox": 1, "modes": "easy" }', "toolbox.mode", '"easy"'],
  ['{ "vpl-toolbox": 1, "modes": [] }', "toolbox.mode", "[]"],
  ['{ "vpl-toolbox": 1, "hidden": "sound" }', "toolbox.block", '"sound"'],
  ['{ "vpl-toolbox": 1, "hidden": ["fly"] }', "toolbox.block", '"fly"'],
  ['{ "vpl-toolbox": 1, "hidden": ["button", "prox", "proxground", "acc", "clap"] }', "toolbox.noEvent", undefined],
  ['{ "vpl-toolbox": 1, "hidden": ["move", "colortop", "colorbottom", "sound"] }', "toolbox.noAction", undefined],
]) {
  test(`refused: ${text}`, () => {
    assert.throws(
      () => readToolbox(String(text)),
      (error) => error instanceof VplError && error.key === key && error.values.found === found,
    );
  });
}
