import assert from "node:assert/strict";
import { test } from "node:test";

import { kindOf, sentenceOf } from "../../web_ui/browser/foreign_files.js";

/** @param {string} letters  a byte each */
const bytes = (letters) => Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
/** @param {string} text */
const utf16 = (text) => bytes([...text].map((letter) => `${letter}\0`).join(""));

const FILES = {
  scratch: ["PK\x03\x04\x14 project.json", "ScratchV02"],
  document: ["PK\x03\x04\x14 word/document.xml", "\xd0\xcf\x11\xe0\xa1", "{\\rtf1"],
  archive: ["PK\x03\x04\x14 a.playground", "\x1f\x8b\x08"],
  pdf: ["%PDF-1.7"],
  picture: ["\x89PNG\r\n", "\xff\xd8\xff\xe0", '<?xml version="1.0"?><!-- a -->\n<svg/>'],
  "web-page": ["<!DOCTYPE html>\n<html>"],
  playground: ["<!DOCTYPE aseba-playground>\n<aseba-playground/>", '{"format": 1, "shapes": []}'],
  blocks: ['<xml xmlns="https://developers.google.com/blockly/xml"></xml>'],
  vpl3: ['{"advanced": false, "program": [{"blocks": []}]}'],
  notebook: ['{"cells": [{"cell_type": "code"}]}'],
  json: ['{"a": 1}'],
  ros: ["import rclpy\n"],
  tdmclient: ["@onevent\ndef prox():\n    pass\n"],
  python: ["import time\n", 'print("a")\n'],
  program: ["<!DOCTYPE aesl-source>\n<network/>", "<network></network>"],
  "": ["", "var a = 1", "# import rclpy\nvar a", "onevent prox\nif a == 1:\nend", "# gr\xf6\xdfer", "BM"],
};

test("a file of another program is recognized by its content", () => {
  for (const [kind, files] of Object.entries(FILES)) {
    for (const file of files) assert.equal(kindOf(bytes(file)), kind, file);
  }
});

test("so is one in UTF-16 without a mark", () => {
  assert.equal(kindOf(utf16("import rclpy\n")), "ros");
  assert.equal(kindOf(utf16("<network/>")), "program");
});

test("each kind has a sentence in each language", () => {
  for (const kind of Object.keys(FILES).filter((each) => each !== "")) {
    const sentences = new Set(["en", "de", "fr", "it"].map((language) => sentenceOf(kind, language)));
    assert.equal(sentences.size, 4, kind);
    assert.ok(![...sentences].some((text) => text.startsWith("foreign-")), kind);
  }
});
