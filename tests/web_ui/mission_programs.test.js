// The programs of the shipped missions that are made of blocks: files that the page opens, with the text that it generates.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { difference } from "../../web_ui/blockly/compare.js";
import { readFile } from "../../web_ui/blockly/file.js";
import { BLOCKS } from "../../web_ui/blockly/language.js";
import { NAMES as BLOCK_NAMES, lookOf } from "../../web_ui/blockly/looks.js";
import { allBlocks } from "../../web_ui/blockly/state.js";
import { CATEGORIES } from "../../web_ui/blockly/toolbox.js";
import { compareText } from "../../web_ui/vpl/compare.js";
import { readVpl } from "../../web_ui/vpl/file.js";
import { holdsVpl } from "../../web_ui/vpl/holds.js";
import { NAMES as VPL_NAMES } from "../../web_ui/vpl/toolbox.js";

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

/** Types of blocks of a program. @param {string} text @returns {string[]} */
function typesIn(text) {
  if (!holdsVpl(text)) return [...allBlocks(readFile(text).state)].map(({ type }) => type);
  const blocks = readVpl(text).program.rows.flatMap(({ event, actions }) => [event, ...actions]);
  return blocks.flatMap((block) => (block === null ? [] : [block.name]));
}

for (const name of NAMES.filter((each) => /^\d-\w+.\w+\.json$/.test(each))) {
  const mission = JSON.parse(readFileSync(new URL(name, MISSIONS), "utf8"));
  if (mission.toolbox === undefined) continue;
  test(`${name} hides blocks that there are, and none that its solutions need`, () => {
    const { hide, modes = [] } = mission.toolbox;
    const known = [...VPL_NAMES, ...BLOCK_NAMES];
    assert.deepEqual(
      [...hide, ...modes].filter((each) => !known.includes(each)),
      [],
    );
    for (const [language, file] of Object.entries(mission.solutions)) {
      const look = language === "scratch" ? "scratch" : "blockly";
      const categories = CATEGORIES[look].filter((each) => hide.includes(`category:${each.name}`));
      const hidden = [...hide, ...(language === "vpl" ? [] : categories.flatMap(({ types }) => types))];
      const text = readFileSync(new URL(file, new URL(name, MISSIONS)), "utf8");
      const shadows = ["math_number"]; // a number stands in its block
      const needed = language === "text" ? [] : typesIn(text).filter((type) => !shadows.includes(type));
      assert.deepEqual(
        needed.filter((type) => hidden.includes(type)),
        [],
        language,
      );
    }
  });
}
