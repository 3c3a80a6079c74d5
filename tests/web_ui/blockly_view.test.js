import assert from "node:assert/strict";
import { test } from "node:test";

import { newFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { BlocksDocument } from "../../web_ui/blockly/view/document.js";
import { blockMistakes, summary } from "../../web_ui/blockly/view/mistakes.js";
import texts from "../../web_ui/i18n/blockly.texts.js";
import { translator } from "../../web_ui/i18n/index.js";
import { number, workspace } from "./blockly_support.js";

const t = translator("en", texts);
const note = { type: "thymio_sound_note", id: "note", x: 0, y: 0, inputs: { FREQ: { shadow: number(440) }, DURATION: { shadow: number(10) } } };
const call = { type: "procedures_callnoreturn", id: "call", x: 0, y: 90, extraState: { name: "nowhere" } };
const loose = { ...number(3), id: "loose", x: 0, y: 200 };

/** @param {any[]} blocks @param {string} [code] */
function documentOf(blocks, code) {
  const state = workspace(...blocks);
  const document = new BlocksDocument(newFile(state, code ?? generate(state).code));
  document.loaded(state);
  return document;
}

/** What the compiler says. @param {number | null} line */
const verdict = (line) => ({ errors: [{ line, column: 1, kind: "division", message: "division by zero" }], warnings: [], use: null, variables: [] });

test("a mistake of the blocks is at its block, errors before warnings", () => {
  const found = blockMistakes(documentOf([loose, call, note]), null, t);
  assert.deepEqual(found.map(({ id, isError }) => [id, isError]), [["call", true], ["loose", false]]);
  assert.match(summary(found, t), /^1 mistake: There is no subroutine called nowhere/);
});

test("a mistake that the compiler finds is at the block of its line", () => {
  const found = blockMistakes(documentOf([note]), verdict(1), t);
  assert.deepEqual(found, [{ id: "note", text: "Division by zero.", isError: true }]);
  assert.equal(blockMistakes(documentOf([note]), verdict(null), t)[0].id, "note");
  assert.equal(blockMistakes(documentOf([note]), verdict(9), t)[0].id, null);
});

test("the compiler's mistakes wait while the blocks are no program: it saw an older one", () => {
  const found = blockMistakes(documentOf([call]), verdict(1), t);
  assert.deepEqual(found.map(({ id }) => id), ["call"]);
});

test("a program that is not that of the blocks can run whatever is wrong with them", () => {
  const document = documentOf([call], "call sound.system(9)\n");
  assert.deepEqual(blockMistakes(document, null, t).map(({ id, isError }) => [id, isError]), [["call", false]]);
  const found = blockMistakes(document, verdict(1), t);
  assert.deepEqual(found.map(({ id, isError }) => [id, isError]), [[null, true], ["call", false]]);
});

test("several mistakes are counted; without one there is nothing to say", () => {
  const other = { ...call, id: "other", extraState: { name: "elsewhere" } };
  assert.match(summary(blockMistakes(documentOf([call, other]), null, t), t), /^2 mistakes\. The first: /);
  assert.match(summary(blockMistakes(documentOf([loose]), null, t), t), /^This block does nothing here/);
  assert.equal(summary(blockMistakes(documentOf([note]), null, t), t), "");
});
