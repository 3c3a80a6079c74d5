import assert from "node:assert/strict";
import { test } from "node:test";

import { readAesl } from "../../web_ui/editor/aesl.js";
import { compareText } from "../../web_ui/vpl/compare.js";
import { changeBlock, insertRow } from "../../web_ui/vpl/edits.js";
import { VplError } from "../../web_ui/vpl/errors.js";
import { newVpl, readVpl, writeVpl } from "../../web_ui/vpl/file.js";
import { MODES } from "../../web_ui/vpl/kinds.js";
import { generate } from "../../web_ui/vpl/generator.js";
import { sameProgram } from "../../web_ui/vpl/program.js";
import { makeBlock } from "../../web_ui/vpl/blocks.js";
import { FILES, goldenPrograms, program, randomNumbers, randomProgram, vplFile } from "./vpl_programs.js";

/** @typedef {import("../../web_ui/vpl/program.js").Program} Program */

/** A file with this VPL part. @param {string} root @param {string} [code] */
const file = (root, code = "") =>
  `<network><node nodeId="1" name="thymio-II">${code}<toolsPlugins>${root}</toolsPlugins></node></network>`;
/** A file of format 1. @param {string} sets @param {string} [attributes] */
const sets = (sets, attributes = 'advanced_mode="0"') =>
  file(`<vplroot xml-format-version="1"><program ${attributes}>${sets}</program></vplroot>`);
/** A program in short. @param {Program} program */
const short = ({ rows }) =>
  rows.map(({ event, state, actions }) =>
    [event, state, ...actions].filter((each) => each !== null).map(({ name, values }) => [name, ...values].join(" ")),
  );
/** @param {string} text */
const textOf = (text) => generate(readVpl(text).program).source?.text ?? "";

test("a program of format 1 is read, whatever the order of attributes", () => {
  const { program, format, node, warnings } = readVpl(vplFile("settings.aesl"));
  assert.deepEqual(short(program), [
    ["timeout", "statefilter 0 0 0 0", "colortop 0 0 0"],
    ["button 0 0 0 0 1 0 0", "statefilter 2 0 0 0", "setstate 1 0 0 0", "timer 439"],
    ["statefilter 0 0 0 0"],
  ]);
  assert.deepEqual([program.mode, format, node, warnings], ["advanced", 1, 0, []]);
});

test("a program of format 0 becomes rows with several actions, near and far swap, and today's thresholds apply", () => {
  const { program, stored, format, warnings } = readVpl(vplFile("format0.aesl"));
  assert.deepEqual(short(program), [
    ["prox 0 0 1 0 0 0 0 1000 2000", "move -300 -300", "colortop 32 0 0"],
    ["proxground 2 2 400 450", "move 0 0"],
    ["acc 0 0", "colorbottom 0 0 32"],
    [],
  ]);
  assert.equal(stored.rows.length, 5);
  assert.deepEqual([program.mode, format, warnings], ["basic", 0, []]);
});

test("states of format 0 are two bits each, and its action statefilter sets the state", () => {
  const pairs =
    '<settings advanced-mode="true"/><buttonset event-name="clap" state="9" action-name="statefilter" ab1="2"/>';
  assert.deepEqual(short(readVpl(file(`<vplroot>${pairs}</vplroot>`)).program), [
    ["clap", "statefilter 1 2 0 0", "setstate 0 2 0 0"],
    ["statefilter 0 0 0 0"],
  ]);
});

test("a second action of one kind keeps its row in format 0", () => {
  const pair = '<buttonset event-name="clap" state="-1" action-name="move" ab0="50" ab1="50"/>';
  assert.deepEqual(short(readVpl(file(`<vplroot>${pair}${pair}</vplroot>`)).program), [
    ["clap", "move 50 50"],
    ["clap", "move 50 50"],
    [],
  ]);
});

test("missing values are the defaults, old values stay off the grid", () => {
  const set =
    '<set><block type="event" name="button" value2="1"/><block type="action" name="timer" value0="3995"/></set>';
  assert.deepEqual(short(readVpl(sets(set, 'advanced_mode="1"')).program)[0], [
    "button 0 0 1 0 0 0 0",
    "statefilter 0 0 0 0",
    "timer 3995",
  ]);
  const ground = '<set><block type="event" name="proxground" value2="229" value3="229"/></set>';
  assert.deepEqual(short(readVpl(sets(ground)).program)[0], ["proxground 0 0 229 229"]);
});

test("basic mode ignores the remote control", () => {
  const set = '<set><block type="event" name="button" value0="1" value5="1" value6="3"/></set>';
  assert.deepEqual(short(readVpl(sets(set)).program)[0], ["button 1 0 0 0 0 0 0"]);
});

test("what cannot be read is reported with its place", () => {
  const { program, warnings } = readVpl(
    sets(
      [
        "",
        '<set><block type="event" name="clap"/>',
        '<block type="action" name="fly"/><block type="action" name="move"/></set>',
        '<other/><set><block type="event" name="prox" value0="7"/>',
        '<block type="action" name="move" value0="123"/></set>',
        '<set><block type="event" name="clap"/><block type="action" name="setstate" value0="1"/></set>',
      ].join("\n"),
    ),
  );
  assert.deepEqual(short(program), [
    ["clap", "statefilter 0 0 0 0"],
    ["prox 0 0 0 0 0 0 0 1000 2000", "statefilter 0 0 0 0", "move 100 0"],
    ["clap", "statefilter 0 0 0 0", "setstate 1 0 0 0"],
    ["statefilter 0 0 0 0"],
  ]);
  assert.deepEqual(
    warnings.map(({ key, values: { line, ...values } }) => [key, line, values]),
    [
      ["load.advanced", 6, { column: 1 }],
      ["load.unknown", 3, { column: 1, found: "action fly" }],
      ["load.value", 4, { column: 14, name: "prox", found: "7", used: 0 }],
      ["load.value", 5, { column: 1, name: "move", found: "123", used: 100 }],
    ],
  );
});

test("a basic program with timers stays basic, and the file as it is", () => {
  const text = sets(
    '<set><block type="event" name="clap"/><block type="action" name="timer" value0="1500"/></set>' +
      '<set><block type="event" name="timeout"/><block type="action" name="move" value0="0" value1="0"/></set>',
  );
  const file = readVpl(text);
  assert.deepEqual([file.program.mode, file.warnings], ["basic", []]);
  assert.deepEqual(short(file.program), [["clap", "timer 1500"], ["timeout", "move 0 0"], []]);
  assert.equal(writeVpl(file, file.program, file.code), text);
});

test("another format is read with a warning", () => {
  const text = sets('<set><block type="event" name="clap"/></set>').replace('version="1"', 'version="2"');
  assert.deepEqual(
    readVpl(text).warnings.map(({ key, values }) => [key, values.found]),
    [["load.format", "2"]],
  );
  assert.deepEqual(short(readVpl(text).program), [["clap"], []]);
});

test("files that are no VPL are refused", () => {
  /** @param {string} text @param {string} key */
  const refused = (text, key) =>
    assert.throws(
      () => readVpl(text),
      (error) => error instanceof VplError && error.key === key,
    );
  refused("<network><node>a = 1</node></network>", "file.none");
  refused("<network/>", "file.none");
  refused("<network><node></network>", "file.xml");
  refused("var a", "file.xml");
  refused("", "file.xml");
});

test("without changes a file is written byte for byte", () => {
  for (const name of FILES) {
    for (const text of [vplFile(name), vplFile(name).replaceAll("\n", "\r\n")]) {
      const read = readVpl(text);
      assert.equal(writeVpl(read, read.program, read.code), text, name);
      assert.equal(writeVpl(read, read.program, read.code.trimEnd()), text, name);
    }
  }
});

test("a changed program is read back, and everything else stays", () => {
  for (const name of FILES) {
    const text = vplFile(name);
    const read = readVpl(text);
    const changed = changeBlock(insertRow(read.program, 0), { row: 1, slot: "event" }, makeBlock("prox", [2]));
    const { source } = generate(changed);
    assert.ok(source);
    const written = writeVpl(read, changed, source.text);
    const again = readVpl(written);
    assert.ok(sameProgram(again.program, changed), name);
    assert.equal(again.code.trimEnd(), source.text.trimEnd());
    assert.equal(again.format, 1);
    assert.deepEqual(
      readAesl(written).events.map((each) => [each.name, each.value]),
      [["pair_run", 1]],
    );
    assert.equal(readAesl(written).nodes.length, readAesl(text).nodes.length);
    const [start, end] = [text.indexOf("<vplroot"), text.indexOf("</vplroot>")];
    assert.ok(written.endsWith(text.slice(end)), name);
    assert.ok(start < 0 || written.includes("<vplroot xml-format-version"));
  }
});

test("a new text of a file of format 0 makes it one of format 1", () => {
  const read = readVpl(vplFile("format0.aesl"));
  const written = writeVpl(read, read.program, textOf(read.text));
  assert.equal(readVpl(written).format, 1);
  assert.equal(compareText(readVpl(written)).origin, "current");
});

test("values of format 0 that cannot be are reported", () => {
  const pair = '<buttonset event-name="prox" eb0="5" state="-1" action-name="move" ab0="777" ab1="50"/>';
  const { program, warnings } = readVpl(file(`<vplroot>${pair}</vplroot>`));
  assert.deepEqual(short(program)[0], ["prox 0 0 0 0 0 0 0 1000 2000", "move 500 50"]);
  assert.deepEqual(
    warnings.map(({ key, values: { name, found, used } }) => [key, name, found, used]),
    [
      ["load.value", "prox", "5", 0],
      ["load.value", "move", "777", 500],
    ],
  );
});

test("other plug-ins, nodes, constants and comments stay", () => {
  const text = vplFile("current.aesl");
  const read = readVpl(text);
  const written = writeVpl(read, insertRow(read.program, 0), "a = 1\n");
  for (const kept of [
    "<Notes><text>mine</text></Notes>",
    '<node nodeId="2" name="other">a = 1</node>',
    'name="LAPS"',
    "<!--list of constants-->",
  ])
    assert.ok(written.includes(kept), kept);
});

test("a text is written in front of the VPL part of a file without text", () => {
  const read = readVpl(sets('\n<set><block type="event" name="clap"/><block type="action" name="move"/></set>'));
  const written = writeVpl(read, read.program, "mic.threshold = 250\n");
  assert.match(written, /name="thymio-II">mic.threshold = 250\n<toolsPlugins>/);
});

test("the VPL part is found in the node that has one", () => {
  const text = sets('<set><block type="event" name="clap"/></set>').replace(
    "<network>",
    '<network><node name="a">b = 1</node>',
  );
  const read = readVpl(text);
  assert.equal(read.node, 1);
  assert.equal(readAesl(writeVpl(read, read.program, "c = 1")).nodes[0].code, "b = 1");
});

test("an extended program has an element of its own, and gives it up when it no longer needs it", () => {
  const text = vplFile("current.aesl");
  const read = readVpl(text);
  const extended = program("extended", [["init"], [["playstop"]]], [["clap"], [["move"]], [1, 0, 0, 0], [["prox", 1]]]);
  const written = writeVpl(read, extended, "a = 1\n");
  assert.doesNotMatch(written, /vplroot|ThymioVisualProgramming/);
  assert.ok(written.includes("<Notes><text>mine</text></Notes>"));
  const again = readVpl(written);
  assert.deepEqual([again.format, again.warnings], ["extended", []]);
  assert.ok(sameProgram(again.program, extended));
  assert.equal(writeVpl(again, again.program, again.code), written);
  const back = writeVpl(again, read.program, read.code);
  assert.ok(sameProgram(readVpl(back).program, read.program));
  assert.match(back, /<ThymioVisualProgramming>\s*<vplroot xml-format-version="1">/);
});

test("VPL of Aseba has no extended blocks: they are not read from its files", () => {
  const { program, warnings } = readVpl(sets('<set><block type="event" name="init"/></set>', 'advanced_mode="1"'));
  assert.deepEqual(short(program), [["statefilter 0 0 0 0"]]);
  assert.deepEqual(
    warnings.map(({ key }) => key),
    ["load.unknown"],
  );
});

test("a new file is read back", () => {
  const random = randomNumbers(11);
  const programs = [
    program("basic"),
    program("advanced"),
    ...goldenPrograms()
      .slice(0, 40)
      .map((each) => each.program),
  ];
  for (let count = 0; count < 40; count++) programs.push(randomProgram(random, MODES[count % 3]));
  for (const each of programs) {
    const { source } = generate(each);
    const read = readVpl(newVpl(each, source?.text));
    assert.ok(sameProgram(read.program, each));
    assert.deepEqual(read.warnings, []);
    assert.equal(textOf(read.text), source?.text ?? "");
    assert.equal(read.code.trimEnd(), (source?.text ?? "").trimEnd());
  }
});
