import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { readAesl } from "../../web_ui/editor/aesl.js";
import { aseba, INDENT } from "../../web_ui/editor/language.js";
import { outline } from "../../web_ui/editor/outline.js";
import { parser } from "../../web_ui/editor/parser.js";
import {
  foldable,
  getIndentation,
  indentUnit,
  syntaxTree,
} from "../../web_ui/node_modules/@codemirror/language/dist/index.js";
import { EditorState } from "../../web_ui/node_modules/@codemirror/state/dist/index.js";
import { buildParserFile } from "../../web_ui/node_modules/@lezer/generator/dist/index.js";

const ROOT = new URL("../../", import.meta.url);

/** @param {string} folder @param {string} ending */
function files(folder, ending) {
  const base = new URL(folder, ROOT);
  return readdirSync(base)
    .filter((name) => name.endsWith(ending))
    .map((name) => /** @type {const} */ ([name, readFileSync(new URL(name, base), "utf8")]));
}

/** Where the parser stumbled. @param {string} text */
function stumbles(text) {
  /** @type {string[]} */ const found = [];
  parser.parse(text).iterate({
    enter({ type, from, to }) {
      if (type.isError) found.push(`${from}: ${text.slice(Math.max(0, from - 20), to + 10)}`);
    },
  });
  return found;
}

/** A state whose first, time-limited look at the text has seen all of it. @param {string} doc @returns {EditorState} */
function stateOf(doc) {
  const state = EditorState.create({ doc, extensions: [aseba(), indentUnit.of(INDENT), EditorState.tabSize.of(4)] });
  return syntaxTree(state).length === doc.length ? state : stateOf(doc);
}

test("parser.js is generated from the grammar", () => {
  const grammar = readFileSync(new URL("web_ui/editor/aseba.grammar", ROOT), "utf8");
  const { parser: generated } = buildParserFile(grammar);
  assert.equal(readFileSync(new URL("web_ui/editor/parser.js", ROOT), "utf8").trim(), generated.trim());
});

for (const folder of ["language", "events", "natives", "faults", "warnings"]) {
  for (const [name, text] of files(`tests/data/programs/${folder}/`, ".aseba")) {
    test(`${folder}/${name} is parsed without an error`, () => assert.deepEqual(stumbles(text), []));
  }
}

for (const [name, text] of [
  ...files("thymio_sim_ros/device/firmware/behaviors/", ".aesl"),
  ...files("tests/data/programs/events/", ".aesl"),
]) {
  test(`${name} is parsed without an error`, () => {
    for (const { code } of readAesl(text).nodes) assert.deepEqual(stumbles(code), []);
  });
}

test("an event without values is distinguished from the following statement", () => {
  assert.deepEqual(stumbles("emit ping\na = 1\nemit ping a\nb[1] = 2\nemit ping [1, 2]\nemit ping -a"), []);
});

test("a name may start with a keyword", () => assert.deepEqual(stumbles("if.x = 1 ende = 2 _emit_ = 3"), []));

test("blocks are indented, and their ends are not", () => {
  const doc = [
    "onevent prox",
    "if a == 1 then",
    "b = 2",
    "elseif c then",
    "d = 1",
    "else",
    "e = 1",
    "end",
    "sub x",
    "return",
  ];
  const levels = [0, 1, 2, 1, 2, 1, 2, 1, 0, 1];
  let text = doc.join("\n");
  for (let index = 0; index < doc.length; index++) {
    const state = stateOf(text);
    const line = state.doc.line(index + 1);
    const columns = getIndentation(state, line.from) ?? -1;
    assert.equal(columns, 4 * levels[index], `line ${index + 1}: ${doc[index]}`);
    text = text.slice(0, line.from) + INDENT.repeat(levels[index]) + text.slice(line.from);
  }
});

for (const [before, level] of /** @type {[string, number][]} */ ([
  ["var a", 0],
  ["onevent prox", 1],
  ["sub turn", 1],
  ["onevent prox\n\ta = 1", 1],
  ["onevent prox\n\tif a > 1 then", 2],
  ["onevent prox\n\tif a > 1 then\n\t\tb = 1\n\tend", 1],
  ["onevent prox\n\ta = 1\n", 1],
  ["if a then\n\tb = 1\nend", 0],
])) {
  test(`the line that is begun behind ${JSON.stringify(before)} is indented ${level} times`, () => {
    const state = stateOf(`${before}\n`);
    assert.equal(getIndentation(state, state.doc.length), 4 * level);
  });
}

test("handlers and blocks can be folded", () => {
  const state = stateOf("onevent prox\n\tif a then\n\t\tb = 1\n\tend\n\nsub x\n\treturn\n");
  assert.deepEqual(foldable(state, 0, 12), { from: 12, to: 36 });
  const { from, to } = state.doc.line(2);
  assert.deepEqual(foldable(state, from, to), { from: to, to: state.doc.line(3).to });
});

test("the outline lists the names that a program defines, even if it is incomplete", () => {
  const text = "const A = 1\nvar b[3]\nonevent prox\n\tif b[ then\nsub turn\n";
  const found = outline(parser.parse(text), (from, to) => text.slice(from, to)).map(
    ({ kind, name }) => `${kind} ${name}`,
  );
  assert.deepEqual(found, ["constant A", "variable b", "event prox", "subroutine turn"]);
});
