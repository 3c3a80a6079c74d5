import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { chooseLanguage, LANGUAGES, translator } from "../../web_ui/i18n/index.js";

const ROOT = new URL("../../web_ui/", import.meta.url);

for (const [language, table] of Object.entries(LANGUAGES)) {
  test(`${language} has exactly the texts of the English table`, () => {
    assert.deepEqual(Object.keys(table), Object.keys(LANGUAGES.en));
  });

  test(`${language} fills in the same values as English`, () => {
    /** @param {string} text */
    const values = (text) => [...text.matchAll(/\{\w+\}/g)].map(([name]) => name).sort();
    for (const [key, text] of Object.entries(LANGUAGES.en)) assert.deepEqual(values(table[key]), values(text), key);
  });
}

test("every text key used by the page exists", () => {
  const files = ["main.js", "input/actions.js", ...readdirSync(new URL("panels/", ROOT)).map((name) => `panels/${name}`)];
  for (const file of files) {
    const source = readFileSync(new URL(file, ROOT), "utf8");
    for (const [, key] of source.matchAll(/\bt\("([^"]+)"/g)) assert.ok(key in LANGUAGES.en, `${file}: ${key}`);
  }
});

test("the first available language is chosen", () => {
  assert.equal(chooseLanguage(["", "pt-BR", "fr-CH", "de"]), "fr");
  assert.equal(chooseLanguage(["pt"]), "en");
});

test("values are filled in", () => {
  assert.equal(
    translator("en")("program.refusedAt", { name: "a", line: 1, column: 2 }),
    "a was not loaded: line 1, column 2",
  );
});
