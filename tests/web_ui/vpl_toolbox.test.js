import assert from "node:assert/strict";
import { test } from "node:test";

import { WHOLE } from "../../web_ui/editor/toolbox_file.js";
import { NAMES, offered, offeredModes } from "../../web_ui/vpl/toolbox.js";

test("a teacher's file hides blocks and limits the modes", () => {
  const toolbox = { hide: ["clap", "sound", "category:loops"], modes: ["basic", "blockly"] };
  assert.deepEqual(offered(toolbox, "event", "basic"), ["button", "prox", "proxground", "acc"]);
  assert.deepEqual(offered(toolbox, "action", "basic"), ["move", "colortop", "colorbottom"]);
  assert.deepEqual(offeredModes(toolbox), ["basic"]);
});

test("without a file, or with one for another language, all blocks and modes are offered", () => {
  assert.deepEqual(offeredModes(WHOLE), ["basic", "advanced", "extended"]);
  assert.deepEqual(offeredModes({ hide: [], modes: ["scratch"] }), ["basic", "advanced", "extended"]);
  assert.equal(offered(WHOLE, "event", "basic").length, 5);
  assert.ok(NAMES.includes("timeout") && NAMES.includes("extended"));
});
