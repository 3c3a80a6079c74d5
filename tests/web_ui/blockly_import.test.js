import assert from "node:assert/strict";
import { test } from "node:test";

import { difference } from "../../web_ui/blockly/compare.js";
import { readFile } from "../../web_ui/blockly/file.js";
import { importFile } from "../../web_ui/blockly/import.js";
import { BLOCKS, looksLikeBlocks } from "../../web_ui/blockly/language.js";
import texts from "../../web_ui/i18n/blockly.texts.js";
import { translator } from "../../web_ui/i18n/index.js";
import { golden, zip } from "./blockly_support.js";

const t = translator("en", texts);
const bytesOf = (/** @type {string} */ text) => new TextEncoder().encode(text);

/** A project of one script. @param {string} opcode  of a block below the flag */
const project = (opcode) =>
  zip({
    "project.json": JSON.stringify({
      targets: [
        {
          isStage: false,
          blocks: {
            hat: { opcode: "event_whenflagclicked", next: "block", parent: null, inputs: {}, fields: {}, topLevel: true },
            block: { opcode, next: null, parent: "hat", inputs: {}, fields: {}, topLevel: false },
          },
        },
      ],
    }),
  });

test("a workspace alone becomes a file with its program", async () => {
  const { text, problem, leftOut } = await importFile(bytesOf(golden("follow_line.xml")), t);
  assert.deepEqual([problem, leftOut], ["", []]);
  const file = readFile(text);
  assert.equal(file.code, golden("follow_line.aseba"));
  assert.equal(difference(file), null);
});

test("a Scratch project becomes a file, and what was left out is listed", async () => {
  const { text, problem, leftOut } = await importFile(project("thymio_stopMotors"), t);
  assert.deepEqual([problem, leftOut], ["", []]);
  assert.match(readFile(text).code ?? "", /motor\.left\.target = 0/);
  assert.deepEqual((await importFile(project("looks_sayforsecs"), t)).leftOut, ["left out: looks_sayforsecs (1 times)"]);
});

test("other files are refused with their reason", async () => {
  const reason = async (/** @type {Uint8Array} */ bytes) => (await importFile(bytes, t)).problem;
  assert.match(await reason(bytesOf("PK")), /not a Scratch project/);
  assert.match(await reason(bytesOf("hello")), /not a file of blocks/);
  assert.match(await reason(Uint8Array.of(0xff, 0x00, 0x80)), /not a file of blocks/);
  assert.match(await reason(bytesOf('<xml>\n<block type="fly"></block>\n</xml>')), /Line 2.*"fly"/);
});

test("a workspace is not taken for a playground", () => {
  for (const text of ["<xml></xml>", '<?xml version="1.0"?>\n<xml xmlns="x">', "\uFEFF<b:xml>"]) assert.ok(looksLikeBlocks(bytesOf(text)), text);
  for (const text of ["<aseba-playground>", '<?xml version="1.0"?><playground/>', "{}"]) assert.ok(!looksLikeBlocks(bytesOf(text)), text);
});

test("a file with blocks belongs to the language, any other does not", () => {
  for (const element of ["<ThymioBlockly>", "<ThymioBlockly/>", '<tb:ThymioBlockly a="b">']) assert.ok(BLOCKS.holds(`<network>${element}`), element);
  for (const element of ["ThymioBlockly", "<ThymioBlocklyOld>", "<ThymioVPL/>"]) assert.ok(!BLOCKS.holds(element), element);
});
