import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { test } from "node:test";

import programTexts from "../../web_ui/i18n/program.texts.js";
import { chooseLanguage, LANGUAGES, translator } from "../../web_ui/i18n/index.js";

const FOLDER = new URL("../../aseba_vm/languages/", import.meta.url);

test("the page offers every language that has a folder, by its own name, English first", () => {
  const folders = readdirSync(FOLDER, { withFileTypes: true }).filter((entry) => entry.isDirectory());
  const codes = folders.map(({ name }) => name).filter((name) => /^[a-z]{2}$/.test(name));
  assert.deepEqual(Object.keys(LANGUAGES), ["en", ...codes.filter((code) => code !== "en").sort()]);
  assert.equal(LANGUAGES.de, "Deutsch");
});

test("the first available language is chosen", () => {
  assert.equal(chooseLanguage(["", "pt-BR", "fr-CH", "de"]), "fr");
  assert.equal(chooseLanguage(["pt"]), "en");
});

test("values are filled in", () => {
  assert.equal(
    translator("en", programTexts)("program.refusedAt", { name: "a", line: 1, column: 2, message: "no" }),
    "a was not loaded: line 1, column 2: no",
  );
});

test("a text that a language lacks is in English, and an unknown key is shown as it is", () => {
  const tables = { en: { stop: "Stop", run: "Run" }, eo: { run: "Ruli" } };
  const t = translator("eo", tables);
  assert.deepEqual([t("run"), t("stop"), t("none")], ["Ruli", "Stop", "none"]);
  assert.equal(translator("xx", tables)("run"), "Run");
});
