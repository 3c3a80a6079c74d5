import assert from "node:assert/strict";
import { test } from "node:test";

import { isOnlyChoice, isWritten } from "../../web_ui/editor/completion_keys.js";

const events = [{ label: "prox" }, { label: "prox.comm" }];

test("Enter breaks the line after a word that is one of the completions", () => {
  assert.ok(isWritten("prox", events, 0));
  assert.ok(isWritten("prox.comm", events, 0));
  assert.ok(isWritten("end", [{ label: "END" }, { label: "end" }], 0));
});

test("Enter takes a completion that the text lacks", () => {
  assert.ok(!isWritten("pro", events, 0));
  assert.ok(!isWritten("Prox", events, 0), "the completion corrects the letters");
  assert.ok(!isWritten("prox", events, 1), "chosen with the arrows");
  assert.ok(!isWritten("leds.top", [{ label: "leds.top", apply: () => {} }], 0), "its values are missing");
  assert.ok(!isWritten("prox", [], null));
});

test("arrows move the cursor where there is nothing to choose", () => {
  assert.ok(isOnlyChoice("end", [{ label: "end" }], 0));
  assert.ok(!isOnlyChoice("prox", events, 0));
  assert.ok(!isOnlyChoice("en", [{ label: "end" }], 0));
});
