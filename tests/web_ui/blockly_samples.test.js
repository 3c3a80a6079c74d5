import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { BLOCKS } from "../../web_ui/blockly/language.js";
import { difference } from "../../web_ui/blockly/compare.js";
import { readFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { lookOf } from "../../web_ui/blockly/looks.js";
import { sampleText } from "../../web_ui/blockly/samples/index.js";
import { allBlocks } from "../../web_ui/blockly/state.js";
import { CATEGORIES } from "../../web_ui/blockly/toolbox.js";
import editorTexts from "../../web_ui/i18n/editor.texts.js";

const GOLDEN = new URL("../data/web/blockly_samples/", import.meta.url);
const SAMPLES = [...BLOCKS.samples, ...(BLOCKS.more ?? [])];

test("every file of the samples is offered once, with a title", () => {
  const files = readdirSync(new URL("../../web_ui/blockly/samples/", import.meta.url)).filter((name) => name.endsWith(".xml"));
  assert.deepEqual(SAMPLES.map(({ name }) => `${name}.xml`).sort(), files.sort());
  for (const { key } of SAMPLES) assert.ok(`new.${key}` in editorTexts.en, key);
  for (const { key } of BLOCKS.samples) assert.ok(`new.${key}.text` in editorTexts.en, key);
});

for (const { name } of SAMPLES) {
  test(`the sample ${name} is a file of blocks with their program`, () => {
    const text = sampleText(name);
    assert.ok(BLOCKS.holds(text));
    const file = readFile(text);
    assert.deepEqual(file.problems, []);
    assert.equal(difference(file), null);
    assert.deepEqual(generate(file.state).problems, []);
    assert.equal(file.code, readFileSync(new URL(`${name}.aseba`, GOLDEN), "utf8"));
    const look = lookOf(file.state);
    if (name !== "empty") assert.equal(look ?? "scratch", name.startsWith("scratch") ? "scratch" : "blockly");
  });
}

test("each family of blocks has a sample, which uses its blocks", () => {
  for (const [look, categories] of Object.entries(CATEGORIES)) {
    for (const { name, types } of categories) {
      const sample = look === "scratch" ? `scratch_${name}` : name;
      const used = [...allBlocks(readFile(sampleText(sample)).state)].map(({ type }) => type);
      assert.ok(used.some((type) => types.includes(type)), sample);
    }
  }
});
