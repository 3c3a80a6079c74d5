import assert from "node:assert/strict";
import { test } from "node:test";

import { compareText } from "../../web_ui/vpl/compare.js";
import { newVpl, readVpl } from "../../web_ui/vpl/file.js";
import { MODES } from "../../web_ui/vpl/kinds.js";
import { generateSource } from "../../web_ui/vpl/generator.js";
import { VERSIONS } from "../../web_ui/vpl/versions.js";
import { goldenPrograms, program, randomNumbers, randomProgram, vplFile } from "./vpl_programs.js";
import { check } from "../../web_ui/vpl/check.js";

/** @typedef {import("../../web_ui/vpl/program.js").Program} Program */

/** What is said about a file. @param {string} text */
function about(text) {
  const { origin, message, versions, changes } = compareText(readVpl(text));
  return {
    origin,
    message,
    ids: versions.map(({ id }) => id),
    changes: changes.map(({ key }) => key.replace("change.", "")),
  };
}

/** A file whose text an older version generated. @param {Program} program @param {string} id */
function by(program, id) {
  const version = VERSIONS.find((each) => each.id === id);
  return newVpl(program, generateSource(program, version?.generator).text);
}

test("the text of the current version belongs to its blocks", () => {
  const { origin, ids, changes } = about(vplFile("current.aesl"));
  assert.deepEqual([origin, changes, ids[0]], ["current", [], "G10"]);
});

test("a file of 1.3 lists what changes, with its thresholds", () => {
  const file = readVpl(vplFile("format0.aesl"));
  const { message, changes } = compareText(file);
  assert.deepEqual(message, { key: "text.older", values: { version: "1.3.3, 2014" } });
  assert.deepEqual(changes.find(({ key }) => key === "change.distance")?.values, { low: 1500, high: 2500 });
  assert.deepEqual(about(vplFile("format0.aesl")).changes, ["edge", "distance", "ground", "report", "merged"]);
});

test("a file of 2014 to 2015 is of several versions", () => {
  const { origin, ids, changes } = about(vplFile("settings.aesl"));
  assert.deepEqual([origin, ids], ["older", ["G4", "G3", "G3"]]);
  assert.deepEqual(changes, ["edge", "remember", "report", "state"]);
});

test("each version is recognized, and only what concerns the program is listed", () => {
  const distance = program("basic", [["prox", 1], [["move", 50, 50]]]);
  /** @type {[string, Program, string[]][]} */
  const cases = [
    ["G3", distance, ["edge", "swapped", "strict", "report"]],
    ["G4", distance, ["edge", "strict", "report"]],
    ["G5", program("basic", [["button", 1], [["sound"]]]), ["melody", "report"]],
    ["G6", distance, ["strict", "report"]],
    ["G7", program("advanced", [["clap"], [["move"]]]), ["remember"]],
    ["G8", program("advanced", [["button", 0, 0, 0, 0, 0, 1, 4], [["move"]]]), ["center"]],
    ["G9", program("advanced", [["acc", 2, 3], [["move"]]]), ["angle"]],
  ];
  for (const [id, made, expected] of cases) {
    const { origin, ids, changes } = about(by(made, id));
    assert.equal(origin, "older", id);
    assert.ok(ids.includes(id), `${id}: ${ids.join(" ")}`);
    assert.deepEqual(changes, expected, id);
  }
});

test("what any version generated is recognized", () => {
  const random = randomNumbers(5);
  const programs = goldenPrograms()
    .slice(0, 60)
    .map((each) => each.program);
  for (let count = 0; count < 60; count++) programs.push(randomProgram(random, MODES[count % 2]));
  for (const made of programs.filter((each) => check(each) === null)) {
    for (const { format, generator } of VERSIONS) {
      if (format === 0) continue;
      const { origin, versions } = compareText(readVpl(newVpl(made, generateSource(made, generator).text)));
      if (generateSource(made, generator).text === "") assert.equal(origin, "empty");
      else assert.ok(versions.some((each) => each.generator === generator));
    }
  }
});

test("a text that was edited by hand is recognized", () => {
  const text = vplFile("current.aesl");
  assert.deepEqual(about(text.replace("target = 200", "target = 220")).origin, "edited");
  assert.deepEqual(about(text.replace("# reset outputs", "# my robot")).changes, ["comments"]);
  assert.deepEqual(about(text.replaceAll("\t", "  ")).changes, []);
});

test("the rows of a stored text are known where it is equal", () => {
  /** @param {string} text */
  const rows = (text) => compareText(readVpl(text)).source?.rows ?? null;
  assert.deepEqual(rows(vplFile("settings.aesl")), [{ first: 20, last: 20 }, { first: 26, last: 29 }, null]);
  assert.equal(rows(vplFile("current.aesl").replaceAll("\t", "  ")), null);
  assert.equal(rows(vplFile("format0.aesl")), null);
});

test("a file without text, and one with an error in the picture", () => {
  const broken = vplFile("current.aesl").replace(/<block type="action" name="move" value0="0".*\n.*\n/, "");
  const { origin, message, ids } = about(broken);
  assert.deepEqual([origin, message.values], ["broken", { row: 2 }]);
  assert.deepEqual(ids, []);
  assert.equal(about(newVpl(program("basic", [["clap"], [["move"]]]))).origin, "empty");
});

test("the text of a picture with an error may come from its first rows", () => {
  const first = program("basic", [["button", 1], [["move", 50, 50]]]);
  const made = program("basic", [["button", 1], [["move", 50, 50]]], [["clap"], []]);
  const { origin, ids } = about(
    newVpl(made, generateSource(first, VERSIONS.find(({ id }) => id === "G4")?.generator).text),
  );
  assert.deepEqual([origin, ids], ["broken", ["G4", "G3", "G3"]]);
});

test("statements of the debugging option do not count", () => {
  const text = vplFile("current.aesl").replace("emit pair_run 1\n", "emit pair_run 1\n\t\t_emit debug_log [0x1, 0]\n");
  const { origin, changes } = about(text);
  assert.deepEqual([origin, changes], ["current", ["debugging"]]);
});
