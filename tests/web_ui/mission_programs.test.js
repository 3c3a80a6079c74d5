// The programs of the shipped missions that are made of blocks: files that the page opens, with the text that it generates.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { difference } from "../../web_ui/blockly/compare.js";
import { readFile } from "../../web_ui/blockly/file.js";
import { BLOCKS } from "../../web_ui/blockly/language.js";
import { lookOf } from "../../web_ui/blockly/looks.js";
import { compareText } from "../../web_ui/vpl/compare.js";
import { readVpl } from "../../web_ui/vpl/file.js";
import { holdsVpl } from "../../web_ui/vpl/holds.js";

const MISSIONS = new URL("../../playgrounds/missions/", import.meta.url);
const NAMES = readdirSync(MISSIONS, { recursive: true }).map(String);

/** @param {string} language */
const programsIn = (language) =>
  NAMES.filter((name) => name.endsWith(`.${language}.aesl`)).map((name) => ({
    name,
    text: readFileSync(new URL(name, MISSIONS), "utf8"),
  }));

test("there are programs of each language", () => {
  for (const language of ["vpl", "blocks", "scratch", "text"]) assert.ok(programsIn(language).length > 5, language);
});

for (const { name, text } of programsIn("vpl")) {
  test(`${name} opens as VPL, and its text is that of its rows`, () => {
    assert.ok(holdsVpl(text));
    const file = readVpl(text);
    assert.deepEqual(file.warnings, []);
    assert.equal(compareText(file).message.key, "text.current");
  });
}

for (const look of ["blocks", "scratch"]) {
  for (const { name, text } of programsIn(look)) {
    test(`${name} opens as blocks of its look, and its text is that of its blocks`, () => {
      assert.ok(BLOCKS.holds(text));
      const file = readFile(text);
      assert.deepEqual(file.problems, []);
      assert.equal(difference(file), null);
      assert.equal(lookOf(file.state) === "scratch", look === "scratch");
    });
  }
}

for (const { name, text } of programsIn("text")) {
  test(`${name} opens as text`, () => {
    assert.ok(!holdsVpl(text));
    assert.ok(!BLOCKS.holds(text));
  });
}
