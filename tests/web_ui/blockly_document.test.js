import assert from "node:assert/strict";
import { test } from "node:test";

import { newFile, readFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { emptyState } from "../../web_ui/blockly/state.js";
import { BlocksDocument } from "../../web_ui/blockly/view/document.js";
import { number, workspace } from "./blockly_support.js";

/** @typedef {import("../../web_ui/blockly/state.js").BlockState} BlockState */

/** @type {BlockState} */ const STOP = { type: "thymio_motors_stop", id: "stop", x: 0, y: 0 };
const NOISE = (/** @type {number} */ value) => ({
  type: "thymio_actuator_mic",
  id: "noise",
  x: 0,
  y: 90,
  inputs: { VALUE: { shadow: number(value) } },
});
const CALL = { type: "procedures_callnoreturn", id: "call", x: 0, y: 200, extraState: { name: "nowhere" } };
const STATE = workspace(STOP, NOISE(40));
const { code: CODE } = generate(STATE);

/** A document as the editor has it once Blockly has loaded the blocks. @param {string} text @param {any} state */
function opened(text, state = STATE) {
  const document = new BlocksDocument(text);
  document.loaded(state);
  return document;
}

test("a file of which nothing changes stays byte for byte, also when a change is taken back", () => {
  const text = newFile(STATE, CODE.replaceAll("\n", "\n\n").replaceAll(" = ", "="));
  const document = opened(text);
  assert.equal(document.difference, null);
  assert.notEqual(document.change(workspace(STOP, NOISE(50))), text);
  assert.equal(document.change(STATE), text);
  assert.equal(document.code, readFile(text).code);
});

test("a change of the blocks makes the program of the file", () => {
  const document = opened(newFile(STATE, CODE));
  const text = document.change(workspace(STOP, NOISE(50)));
  assert.match(text, /mic\.threshold = 50/);
  assert.equal(document.code, readFile(text).code);
  assert.deepEqual(new BlocksDocument(text).difference, null);
});

test("blocks with an error are stored, and the last program without one stays", () => {
  const document = opened(newFile(STATE, CODE));
  document.change(workspace(STOP, NOISE(50)));
  const text = document.change(workspace(STOP, NOISE(60), CALL));
  assert.deepEqual(document.errors.map(({ key, id }) => [key, id]), [["noSubroutine", "call"]]);
  assert.match(text, /mic\.threshold = 50/);
  assert.equal(readFile(text).state.blocks?.blocks.length, 3);
});

test("a program that was edited stays until the user decides", () => {
  const text = newFile(STATE, "call sound.system(3)\n");
  const document = opened(text);
  assert.deepEqual(document.difference, { line: 1, stored: "call sound.system(3)", generated: "motor.left.target=0" });
  assert.ok(document.hasOwnText);
  assert.deepEqual(document.blocks, []);
  assert.match(document.change(workspace(STOP, NOISE(50))), /sound\.system\(3\)/);
  assert.equal(document.change(STATE), text);
  assert.match(document.adopt(), /mic\.threshold = 40/);
  assert.equal(document.code, CODE);
  assert.equal(document.hasOwnText, false);
});

test("comments of the text are noticed before they are lost", () => {
  assert.equal(opened(newFile(STATE, CODE)).hasOwnText, false);
  assert.equal(opened(newFile(STATE, `# drive\n${CODE}`)).hasOwnText, true);
});

test("lines and blocks are known also where the file has other blanks", () => {
  for (const code of [CODE, `\n# first\n${CODE.replaceAll("\n", "\n\n")}`]) {
    const document = opened(newFile(STATE, code));
    const lines = code.split("\n");
    const row = lines.findIndex((line) => line.includes("right"));
    assert.equal(document.blocks[row], "stop");
    const { first, last } = /** @type {{ first: number, last: number }} */ (document.linesOf("stop"));
    assert.match(lines[first], /left/);
    assert.match(lines[last], /right/);
    assert.equal(document.linesOf("missing"), null);
  }
});

test("names of the file's constants are not those of variables", () => {
  const state = workspace({ type: "variables_set", id: "set", x: 0, y: 0, fields: { VAR: { name: "speed" } }, inputs: { VALUE: { shadow: number(1) } } });
  const text = newFile(state, "").replace("<!--list of constants-->", '<!--list of constants-->\n<constant value="3" name="speed"/>');
  const document = opened(text, state);
  assert.equal(document.generated.code, "var speed2\n\n\nspeed2 = 1\n");
});

test("a file with something unknown in it cannot be edited as blocks, and is not changed", () => {
  const text = newFile(STATE, CODE).replace("thymio_motors_stop", "thymio_fly");
  const document = new BlocksDocument(text);
  assert.equal(document.canEdit, false);
  assert.equal(document.text, text);
});

test("a new file of blocks is an empty program", () => {
  const document = opened(newFile(emptyState(), ""), emptyState());
  assert.deepEqual([document.code, document.errors, document.difference], ["", [], null]);
  assert.match(document.change(workspace(STOP)), /motor\.left\.target = 0/);
});
