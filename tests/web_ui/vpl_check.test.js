import assert from "node:assert/strict";
import { test } from "node:test";

import { buttonBlock, makeBlock } from "../../web_ui/vpl/blocks.js";
import { warningOf } from "../../web_ui/vpl/check.js";

/** @param {import("../../web_ui/vpl/blocks.js").Block | null} event @param {import("../../web_ui/vpl/blocks.js").Block[]} conditions */
const warned = (event, ...conditions) => warningOf({ event, conditions });

test("a block in which nothing is chosen has a warning", () => {
  assert.equal(warned(makeBlock("button")), "check.any.button");
  assert.equal(warned(makeBlock("prox")), "check.any.sensor");
  assert.equal(warned(makeBlock("proxground")), "check.any.sensor");
  assert.equal(warned(makeBlock("clap"), makeBlock("prox")), "check.any.sensor");
});

test("a block with a choice, and one that needs none, have no warning", () => {
  assert.equal(warned(makeBlock("button", [0, 1, 0, 0, 0, 0, 0])), null);
  assert.equal(warned(makeBlock("prox", [0, 0, 2, 0, 0, 0, 0, 1000, 2000])), null);
  for (const mode of [1, 2]) assert.equal(warned(buttonBlock(mode)), null);
  for (const name of ["clap", "timeout", "acc", "init"]) assert.equal(warned(makeBlock(name)), null);
  assert.equal(warned(null), null);
});
