// The programs of docs/course that are made of blocks: files that the page opens, with the text that it generates.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { difference } from "../../web_ui/blockly/compare.js";
import { readFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { BLOCKS } from "../../web_ui/blockly/language.js";
import { compareText } from "../../web_ui/vpl/compare.js";
import { readVpl } from "../../web_ui/vpl/file.js";
import { generate as generateVpl } from "../../web_ui/vpl/generator.js";
import { holdsVpl } from "../../web_ui/vpl/holds.js";

const COURSE = new URL("../../docs/course/", import.meta.url);
const PROGRAMS = ["start", "mistake", "solution"];

/** @param {string} lesson @param {string} name */
const textOf = (lesson, name) => readFileSync(new URL(`${lesson}/programs/${name}.aesl`, COURSE), "utf8");

test("every lesson has the same three programs", () => {
  for (const lesson of readdirSync(COURSE).filter((name) => /^\d/.test(name))) {
    const names = readdirSync(new URL(`${lesson}/programs/`, COURSE)).map((name) => name.replace(/\.\w+$/, ""));
    assert.deepEqual(names.sort(), [...PROGRAMS].sort(), lesson);
  }
});

for (const lesson of ["1-buttons", "2-sensors"]) {
  for (const name of PROGRAMS) {
    test(`${lesson}: ${name} opens as VPL, and its text is that of its rows`, () => {
      const text = textOf(lesson, name);
      assert.ok(holdsVpl(text));
      const file = readVpl(text);
      assert.deepEqual(file.warnings, []);
      assert.equal(compareText(file).message.key, "text.current");
      const { source } = generateVpl(file.program);
      assert.ok(source !== null && text.includes(escaped(source.text)));
    });
  }
}

for (const name of PROGRAMS) {
  test(`3-blocks: ${name} opens as blocks, and its text is that of its blocks`, () => {
    const text = textOf("3-blocks", name);
    assert.ok(BLOCKS.holds(text));
    const file = readFile(text);
    assert.deepEqual(file.problems, []);
    assert.equal(difference(file), null);
    const { code, problems } = generate(file.state);
    assert.deepEqual(problems, []);
    assert.equal(file.code, code);
  });
}

/** A text as it stands in a file. @param {string} text */
function escaped(text) {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
}
