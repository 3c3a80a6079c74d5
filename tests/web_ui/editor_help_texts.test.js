import assert from "node:assert/strict";
import { test } from "node:test";

import { readLoaded } from "../../web_ui/input/check_service.js";
import { HelpTexts } from "../../web_ui/editor/help_texts.js";
import { RuntimeClient } from "../../web_ui/input/runtime_client.js";

const TARGET = /** @type {any} */ ({
  variables: [{ name: "acc", size: 3, address: 0, hidden: false, help: "accelerometer" }],
  events: [{ name: "acc", help: "was read" }],
  natives: [{ name: "own.native", parameters: [], hidden: false, help: "of a plug-in" }],
  keywords: [],
  limits: {},
});
const GERMAN = { ...TARGET, variables: [{ ...TARGET.variables[0], help: "Beschleunigung" }], natives: [] };

/** @param {any} reason */
function answering(reason) {
  /** @type {any[]} */ const asked = [];
  const value = { result: { successful: true, reason: JSON.stringify(reason) } };
  const call = async (/** @type {any[]} */ ...given) => (asked.push(given), { ok: true, message: "", value });
  return { asked, runtime: new RuntimeClient(/** @type {any} */ ({ call })) };
}

test("help is requested once, in the language of the page, and replaces the target's", async () => {
  const helpTexts = new HelpTexts("de");
  const { asked, runtime } = answering({ target: GERMAN });
  assert.equal(helpTexts.translate(null), null);
  assert.equal(helpTexts.translate(TARGET).variables[0].help, "accelerometer");
  let changes = 0;
  for (let round = 0; round < 3; round++) await helpTexts.load(runtime, () => changes++);
  assert.deepEqual([asked.length, changes], [1, 1]);
  assert.equal(asked[0][1].parameters.find((/** @type {any} */ each) => each.name === "language").value.string_value, "de");
  const translated = helpTexts.translate(TARGET);
  assert.equal(translated.variables[0].help, "Beschleunigung");
  assert.equal(translated.events[0].help, "was read");
  assert.equal(translated.natives[0].help, "of a plug-in");
  assert.equal(helpTexts.translate(TARGET), translated);
});

test("without translated help the target's help is kept", async () => {
  const helpTexts = new HelpTexts("de");
  await helpTexts.load(new RuntimeClient(/** @type {any} */ ({ call: async () => ({ ok: false, message: "gone" }) })), () => {});
  assert.equal(helpTexts.translate(TARGET).variables[0].help, "accelerometer");
});

test("the first error is reported, but not a failed check", () => {
  /** @param {string} kind */
  const answer = (kind) => ({
    result: {
      successful: false,
      reason: JSON.stringify({ errors: [{ line: 2, column: 3, length: 1, message: "falsch", kind, node: "" }] }),
    },
  });
  assert.deepEqual(readLoaded(answer("unknown-variable")).fault, { text: "falsch", line: 2, column: 3 });
  assert.equal(readLoaded(answer("request")).fault, null);
  assert.equal(readLoaded(answer("request")).message, "falsch");
});
