import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { run } from "../../web_ui/blockly/cli.js";
import { newFile } from "../../web_ui/blockly/file.js";
import { FOLDER, golden, stateOf } from "./blockly_support.js";

const read = (/** @type {string} */ path) => readFileSync(new URL(path, FOLDER));
/** @param {string} text */
const reading = (text) => () => new TextEncoder().encode(text);

test("the command prints the program of the blocks of a file", async () => {
  assert.deepEqual(await run(["follow_line.xml"], read), { output: golden("follow_line.aseba"), errors: "", exit: 0 });
  const file = newFile(stateOf(golden("follow_line.xml")), "call sound.system(0)");
  assert.equal((await run(["a.aesl"], reading(file))).output, golden("follow_line.aseba"));
});

test("it compares the program with the text of the file", async () => {
  const state = stateOf(golden("follow_line.xml"));
  const same = newFile(state, golden("follow_line.aseba"));
  assert.deepEqual(await run(["--compare", "a.aesl"], reading(same)), { output: "", errors: "", exit: 0 });
  const other = newFile(state, "call sound.system(0)");
  const { output } = await run(["--compare", "a.aesl"], reading(other));
  assert.equal(output, "1: call sound.system(0) | call leds.top(0,32,0)\n");
});

test("problems of blocks and files have an exit code and a text in the language", async () => {
  const call = '<xml><block type="procedures_callnoreturn"><mutation name="away"></mutation></block></xml>';
  const answer = await run(["--lang", "de", "a.xml"], reading(call));
  assert.equal(answer.exit, 1);
  assert.match(answer.errors, /^a\.xml: Es gibt kein Unterprogramm away\./);
  const unknown = await run(["a.xml"], reading('<xml>\n<block type="text_print"/></xml>'));
  assert.deepEqual([unknown.exit, unknown.output], [2, ""]);
  assert.match(unknown.errors, /^a\.xml:2:1: Found a block "text_print"/);
  assert.equal((await run(["a.aesl"], reading("<network/>"))).exit, 2);
  assert.equal((await run(["a.sb3"], reading("PK"))).exit, 2);
  assert.equal((await run(["missing.xml"], read)).exit, 2);
});

test("it prints a file with blocks for a text, for a workspace, and for a file of VPL", async () => {
  const text = "onevent button.left\n\twhen button.left == 1 do\n\t\tcall prox.comm.enable(1)\n\tend\n";
  const { output, errors, exit } = await run(["--blocks", "a.aseba"], reading(text));
  assert.deepEqual([errors, exit], ["", 0]);
  assert.equal((await run(["a.aesl"], reading(output))).output, text);
  assert.equal((await run(["--blocks", "b.aesl"], reading(output))).output, output);
  const workspace = await run(["--blocks", "follow_line.xml"], read);
  assert.equal((await run(["a.aesl"], reading(workspace.output))).output, golden("follow_line.aseba"));
  const vpl = await run(["--blocks", "../vpl/avoid.aesl"], read);
  assert.deepEqual([vpl.errors, vpl.exit], ["", 0]);
  assert.match((await run(["a.aesl"], reading(vpl.output))).output, /onevent prox/);
});

test("a text without blocks is refused with the line and the text of it", async () => {
  const answer = await run(["--blocks", "a.aseba"], reading("var a\ncall math.rand(a)\n"));
  assert.deepEqual(answer, { output: "", errors: "a.aseba: Line 2 of the text has no block: call math.rand(a)\n", exit: 1 });
  assert.equal((await run(["--blocks", "a.aesl"], reading("<network>"))).exit, 2);
  assert.equal((await run(["--blocks", "a.sb3"], reading("PK"))).exit, 2);
});

test("wrong usage is explained", async () => {
  for (const command of [[], ["a", "b"], ["--wrong", "a"], ["--lang", "xx", "a"], ["--compare", "--blocks", "a"]]) {
    assert.equal((await run(command, read)).exit, 2);
  }
  assert.match((await run(["--help"], read)).output, /^usage:/);
});
