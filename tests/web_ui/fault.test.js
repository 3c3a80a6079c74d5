import assert from "node:assert/strict";
import { test } from "node:test";

import { LANGUAGES, translator } from "../../web_ui/i18n/index.js";
import playgroundTexts from "../../web_ui/i18n/playground.texts.js";
import { faultText, isForeign, refusalOf } from "../../web_ui/playground_tab/refusal.js";
import { locate } from "../../web_ui/state/index.js";

/** What the simulator's readers answer to files of another kind. */
const FOREIGN = [
  "a.json: line 1, column 1: found 'hello', expected JSON (Expecting value)",
  "a.json: line 1, column 14: found the end of the text, expected JSON (Expecting property name enclosed in double quotes)",
  "a.json: found [], expected an object",
  "a.json: format: found None, expected 1",
  "a.json: found an invalid byte at offset 0, expected UTF-8 text",
  "a.json: line 1: found <html>, expected <aseba-playground>",
  "a.json: found a damaged zip archive, expected a complete zip archive",
  "a.json: line 1: found no element found, expected XML",
];

for (const message of FOREIGN) {
  test(`'${message}' is shown in plain words, in every language`, () => {
    const fault = locate(`/simulator.playground: ${message}`, "a.json");
    for (const language of Object.keys(LANGUAGES)) {
      const said = faultText(translator(language, playgroundTexts), fault);
      assert.equal(said, playgroundTexts[language]["fault.notPlayground"] ?? playgroundTexts.en["fault.notPlayground"]);
      assert.ok(!/Expecting|JSON|None|byte/.test(said));
    }
  });
}

test("an error in a playground is reported with its details", () => {
  for (const text of [
    "shapes[0].x_m: found 'far', expected a number of m",
    "shapes[0]: found 3, expected an object",
    "title: found nothing, expected one line of text, at most 2000 characters",
  ]) {
    assert.equal(isForeign(refusalOf(text)), false, text);
    assert.equal(faultText(translator("en"), locate(text)), text);
  }
  assert.equal(isForeign(null), false);
});
