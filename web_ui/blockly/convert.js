// Command: converts a file of blocks, a Scratch 3 project or a workspace as XML, on the standard input to an .aesl file.
// It prints what `importFile` returns, as JSON. `thymio_sim_ros/device/programs/blocks.py` runs it.

import { argv, stdin, stdout } from "node:process";

import { LANGUAGES, translator } from "../i18n/index.js";
import texts from "../i18n/blockly.texts.js";
import { importFile } from "./import.js";

const [, , language = "en"] = argv;
/** @type {Uint8Array[]} */ const parts = [];
for await (const part of stdin) parts.push(part);
const size = parts.reduce((sum, part) => sum + part.length, 0);
const bytes = new Uint8Array(size);
let at = 0;
for (const part of parts) {
  bytes.set(part, at);
  at += part.length;
}
const found = await importFile(bytes, translator(language in LANGUAGES ? language : "en", texts));
stdout.write(JSON.stringify(found));
