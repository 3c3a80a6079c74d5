import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { run } from "../../web_ui/vpl/cli.js";
import { readVpl } from "../../web_ui/vpl/file.js";
import { generate } from "../../web_ui/vpl/generator.js";
import { vplFile } from "./vpl_programs.js";

const CURRENT = vplFile("current.aesl");
/** @param {string} text @param {string[]} options */
const answer = (text, ...options) => run([...options, "a.aesl"], () => text);

test("the command prints the text that is generated for a file", () => {
  const path = fileURLToPath(new URL("../data/web/vpl/format0.aesl", import.meta.url));
  const command = fileURLToPath(new URL("../../web_ui/vpl/cli.js", import.meta.url));
  const output = execFileSync(process.execPath, [command, path], { encoding: "utf8" });
  assert.equal(output, generate(readVpl(vplFile("format0.aesl")).program).source?.text);
});

test("a program with an error has exit code 1, in the wanted language", () => {
  const broken = CURRENT.replace(/<block type="action" name="move" value0="0".*\n.*\n/, "");
  const message = "a.aesl: Ligne 2\u00a0: il manque une action. Que doit faire le robot\u202f?\n";
  assert.deepEqual(answer(broken.replace("<set/>", '<set><block type="event" name="clap"/></set>'), "--lang", "fr"), {
    output: "",
    errors: message,
    exit: 1,
  });
});

test("a block in which nothing is chosen is a warning, as on the page", () => {
  const open = CURRENT.replace('name="prox" value0="0" value1="0" value2="1"', 'name="prox" value0="0" value1="0" value2="0"');
  const { output, errors, exit } = answer(open);
  assert.equal(errors, "a.aesl: Row 2: no sensor is chosen, so this happens all the time.\n");
  assert.deepEqual([exit, output === ""], [0, false]);
  assert.equal(answer(CURRENT).errors, "");
});

test("a file without VPL, a missing file and wrong usage have exit code 2", () => {
  assert.match(answer("<network/>").errors, /^a.aesl: This file has no VPL program/);
  assert.equal(answer("<network/>").exit, 2);
  assert.equal(run(["/nowhere.aesl"]).exit, 2);
  for (const wrong of [[], ["a", "b"], ["--wrong", "a"], ["--lang", "xx", "a"]]) assert.equal(run(wrong).exit, 2);
  assert.match(run(["--help"]).output, /^usage: /);
});

test("the command compares text and picture", () => {
  const { output } = answer(vplFile("settings.aesl"), "--compare");
  assert.deepEqual(output.split("\n").length, 6);
  assert.match(output, /an older VPL \(2014-02 – 2015-06\)/);
});
