import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { newAesl, readAesl } from "../../web_ui/editor/aesl.js";
import { BLOCKS } from "../../web_ui/blockly/blocks/index.js";
import { difference } from "../../web_ui/blockly/compare.js";
import { newFile, readFile, withoutBlocks, writeFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { emptyState, sameWorkspace } from "../../web_ui/blockly/state.js";
import { writeWorkspace } from "../../web_ui/blockly/write_workspace.js";
import { FOLDER, PROGRAMS, golden, stateOf } from "./blockly_support.js";

const XHTML = ' xmlns="http://www.w3.org/1999/xhtml"';

/** A file as Studio saves it. @param {string} workspace @param {string} [code] */
const aesl = (workspace, code = "call sound.system(-1)\n") => `<!DOCTYPE aesl-source>
<network>


<!--list of global events-->


<!--keywords state-->
<keywords flag="true"/>


<!--node thymio-II-->
<node nodeId="51938" name="thymio-II">${code}
<toolsPlugins>
<ThymioBlockly>
${workspace}
</ThymioBlockly>
</toolsPlugins>
</node>


</network>
`;

/** @param {string} inside @param {string} [namespace] */
const xml = (inside, namespace = "") => `<xml${namespace}>\n${inside}\n</xml>`;

const SHADOWS = `  <block y="20" type="thymio_variable_set" x="10">
    <field name="VAR">speed</field>
    <value name="VALUE">
      <shadow type="math_number"><field name="NUM">0</field></shadow>
      <block type="variables_get"><field name="VAR">Speed</field></block>
    </value>
    <next><block type="thymio_actuator_mic"><value name="VALUE"><shadow type="math_number"><field name="NUM">7</field></shadow></value></block></next>
  </block>`;

/** Problems as `key line:column`. @param {string} text */
const problemsOf = (text) => readFile(text).problems.map(({ key, line, column }) => `${key} ${line}:${column}`);

test("a workspace is read with and without namespace, with shadows and both vocabularies", () => {
  for (const namespace of ["", XHTML]) {
    const file = readFile(aesl(xml(SHADOWS, namespace)));
    assert.deepEqual(file.problems, []);
    assert.equal(file.hasWorkspace, true);
    assert.equal(file.code, "call sound.system(-1)\n\n\n");
    assert.equal(generate(file.state).code, "var speed\n\n\nspeed = speed\nmic.threshold = 7\n");
  }
});

test("prefixes and the tags of the oldest files are read", () => {
  const old =
    '<b:xml xmlns:b="x"><b:block type="thymio_event_timer"><b:title name="EVENT">timer1</b:title></b:block></b:xml>';
  assert.equal(generate(stateOf(old)).code, "onevent timer1\n");
});

test("ids and the list of variables of new Blockly are read", () => {
  const text = `<xml xmlns="https://developers.google.com/blockly/xml"><variables><variable id="k1">a b</variable></variables>
    <block type="variables_set" id="q" x="1" y="2"><field name="VAR" id="k1">a b</field></block></xml>`;
  const state = stateOf(text);
  assert.deepEqual(state.variables, [{ id: "k1", name: "a b" }]);
  assert.deepEqual(state.blocks?.blocks, [
    { type: "variables_set", id: "q", fields: { VAR: { id: "k1" } }, x: 1, y: 2 },
  ]);
});

test("nothing changes in a file if nothing has changed", () => {
  const texts = [
    aesl(xml(SHADOWS)),
    aesl(xml(SHADOWS, XHTML)).replaceAll("\n", "\r\n"),
    xml(SHADOWS),
    newAesl("a = 1"),
    aesl("<xml/>"),
  ];
  for (const text of texts) {
    const file = readFile(text);
    assert.equal(writeFile(file, structuredClone(file.state)), text);
    assert.equal(writeFile(file, file.state, file.code), text);
  }
});

test("only the workspace and the code are replaced", () => {
  const file = readFile(aesl(xml(SHADOWS)));
  const state = structuredClone(file.state);
  state.blocks?.blocks.push({ type: "thymio_sound_stop", x: 10, y: 200 });
  const written = writeFile(file, state, "a = 1\n");
  const read = readFile(written);
  assert.equal(sameWorkspace(read.state, state), true);
  assert.equal(read.code, "a = 1\n");
  for (const edge of ["<node ", "</xml>"]) {
    const part = edge === "</xml>" ? 1 : 0;
    assert.equal(written.split(edge)[part], file.text.split(edge)[part]);
  }
  assert.match(written, /<xml>\n {2}<block type="thymio_variable_set" x="10" y="20">/);
});

test("a file without a workspace gets one, and other plug-ins stay", () => {
  const state = stateOf(xml(SHADOWS));
  const other = "<toolsPlugins><Other/></toolsPlugins>";
  for (const node of [
    '<node name="a"/>',
    '<node name="a">x = 1</node>',
    `<node name="a">x = 1${other}</node>`,
    '<node name="a">x = 1<toolsPlugins/></node>',
  ]) {
    const file = readFile(`<network>${node}</network>`);
    assert.equal(file.hasWorkspace, false);
    const written = writeFile(file, state);
    assert.equal(sameWorkspace(readFile(written).state, state), true);
    assert.equal(readAesl(written).nodes[0].code, file.code);
    if (node.includes("Other")) assert.match(written, /<Other\/>/);
  }
});

test("an empty workspace is stored in a file of blocks, so that it stays one", () => {
  const written = writeFile(readFile(aesl(xml(SHADOWS))), emptyState());
  assert.match(written, /<ThymioBlockly>\s*<xml>\s*<\/xml>\s*<\/ThymioBlockly>/);
  const fresh = newFile(emptyState(), "");
  assert.equal(readFile(fresh).hasWorkspace, true);
  assert.deepEqual(readFile(fresh).problems, []);
  const plain = newAesl("a = 1");
  assert.equal(writeFile(readFile(plain), emptyState()), plain);
});

test("blocks can leave a file: its program, other tools and everything else stay", () => {
  const without = withoutBlocks(aesl(xml(SHADOWS)));
  assert.doesNotMatch(without, /toolsPlugins|Blockly/);
  assert.equal(readAesl(without).nodes[0].code, readFile(aesl(xml(SHADOWS))).code);
  const other = aesl(xml(SHADOWS)).replace("<ThymioBlockly>", "<Other/><ThymioBlockly>");
  assert.match(withoutBlocks(other), /<toolsPlugins>\s*<Other\/>\s*<\/toolsPlugins>/);
  const plain = newAesl("a = 1");
  assert.equal(withoutBlocks(plain), plain);
});

test("the workspace is that of the first node that has one", () => {
  const second = aesl(xml(SHADOWS)).replace("<!--node thymio-II-->", '<node name="first">b = 2</node>');
  const file = readFile(second);
  assert.equal(file.node, 1);
  assert.equal(
    readAesl(writeFile(file, file.state, "c = 3"))
      .nodes.map(({ code }) => code)
      .join(),
    "b = 2,c = 3",
  );
});

test("a new file has the code and the workspace", () => {
  const state = stateOf(xml(SHADOWS));
  const file = readFile(newFile(state, "a = 1 < 2"));
  assert.equal(file.code, "a = 1 < 2");
  assert.equal(sameWorkspace(file.state, state), true);
});

for (const name of PROGRAMS) {
  test(`${name} is the same program after it was written and read`, () => {
    const state = stateOf(golden(`${name}.xml`));
    const again = stateOf(writeWorkspace(state));
    assert.equal(sameWorkspace(again, state), true);
    assert.equal(generate(again).code, golden(`${name}.aseba`));
    assert.equal(`${writeWorkspace(state)}\n`, golden(`${name}.xml`));
  });
}

const ORIGINAL = JSON.parse(readFileSync(new URL("../original_blocks.json", FOLDER), "utf8"));

for (const [type, expected] of Object.entries(ORIGINAL)) {
  test(`${type} has the names, options and defaults that the original program writes`, () => {
    const args = BLOCKS.get(type)?.args ?? [];
    const found = args.map(({ kind, name, options, shadow, initial }) => {
      if (kind === "choice") return [name, { options: options?.map(([, value]) => value), initial }];
      return [name, kind === "value" ? (shadow ?? null) : kind === "body" ? kind : initial];
    });
    assert.deepEqual(Object.fromEntries(found), expected);
  });
}

test("the operand of an operator with one side is VALUE, and A in files of earlier versions", () => {
  const block = (/** @type {string} */ name) =>
    `<xml><block type="thymio_variable_set"><field name="VAR">v</field><value name="VALUE"><block type="thymio_unary">
    <field name="OP">abs</field><value name="${name}"><block type="thymio_unary"><field name="OP">~</field>
    <value name="${name}"><block type="math_number"><field name="NUM">5</field></block></value></block></value></block></value></block></xml>`;
  for (const name of ["VALUE", "A"]) {
    const state = stateOf(block(name));
    assert.equal(generate(state).code, "var v\n\n\nv = abs ~5\n");
    assert.equal(writeWorkspace(state).match(/name="VALUE"/g)?.length, 3);
    assert.doesNotMatch(writeWorkspace(state), /name="A"/);
  }
});

test("inputs and fields of Scratch blocks have their former names in files of earlier versions", () => {
  const older = `<xml><block type="thymio_setOdomoter"><value name="D"><block type="math_number"><field name="NUM">1</field></block></value>
    <value name="X"><block type="math_number"><field name="NUM">2</field></block></value>
    <value name="Y"><block type="math_number"><field name="NUM">3</field></block></value>
    <next><block type="thymio_nextDial"><field name="D">right</field></block></next></block></xml>`;
  const { code } = generate(stateOf(older));
  for (const line of ["odo.direction = 1", "odo.x = 2", "odo.y = 3", "dial.number = dial.number + 1"])
    assert.ok(code.includes(line), line);
});

test("flags, comments, data and comments of the workspace are kept", () => {
  const inside = `  <comment x="1" y="2" h="30" w="40">Note &amp; more</comment>
  <block type="thymio_led_rgb" inline="false" collapsed="true" disabled="true" deletable="false" movable="false" editable="false" x="5" y="6">
    <field name="LED">leds.top</field>
    <comment pinned="true" h="80" w="160">a &lt; b</comment>
    <data>kept</data>
  </block>`;
  assert.equal(writeWorkspace(stateOf(xml(inside, XHTML))), xml(inside, XHTML));
});

test("an if without a count of its branches gets it from its inputs", () => {
  const text = xml(
    '<block type="controls_if"><statement name="DO1"><block type="thymio_sound_stop"/></statement><statement name="ELSE"></statement></block>',
  );
  assert.deepEqual(stateOf(text).blocks?.blocks[0].extraState, { elseIfCount: 1, hasElse: true });
});

test("what the editor does not have is an error with its place", () => {
  assert.deepEqual(problemsOf("<network"), ["notXml 1:1"]);
  assert.deepEqual(problemsOf(""), ["notXml 1:1"]);
  assert.deepEqual(problemsOf(xml('<block type="text_print"></block>')), ["unknownBlock 2:1"]);
  assert.deepEqual(problemsOf(xml('<block type="thymio_led_off">\n <field name="LED">leds.none</field></block>')), [
    "unknownOption 3:2",
  ]);
  assert.deepEqual(problemsOf(xml('<block type="math_number"><field name="NUM">many</field></block>')), [
    "notANumber 2:27",
  ]);
  assert.deepEqual(problemsOf(xml('<block type="thymio_led"><field name="COLOR">red</field></block>')), [
    "notAColor 2:26",
  ]);
  assert.deepEqual(problemsOf(xml('<block type="thymio_led"><field name="HUE">1</field></block>')), [
    "unknownField 2:26",
  ]);
  assert.deepEqual(problemsOf(xml('<block type="thymio_led"><value name="X"></value></block>')), ["unknownInput 2:26"]);
  const inSocket = (/** @type {string} */ tag, /** @type {string} */ type) =>
    problemsOf(xml(`<block type="controls_if">\n<${tag}><block type="${type}"/></${tag.split(" ")[0]}></block>`)).map(
      (each) => each.split(" ")[0],
    );
  assert.deepEqual(inSocket('value name="IF1"', "math_number"), ["wrongPlace"]);
  assert.deepEqual(inSocket('value name="IF1"', "thymio_variable_get"), []);
  assert.deepEqual(inSocket('statement name="DO0"', "logic_boolean"), ["wrongPlace"]);
  assert.deepEqual(inSocket('statement name="ELSE"', "thymio_event_shock"), ["wrongPlace"]);
  assert.deepEqual(inSocket("next", "math_number"), ["wrongPlace"]);
  assert.deepEqual(problemsOf(xml("<circle/>")), ["unknownElement 2:1"]);
  assert.deepEqual(
    problemsOf(xml('<block type="procedures_defnoreturn"><mutation><arg name="x"/></mutation></block>')),
    ["parameters 2:38"],
  );
});

test("a long program is read, and one that is nested too deeply is refused", () => {
  const start = '<block type="thymio_sound_stop"><next>';
  const nested = (/** @type {number} */ count) =>
    xml(`${start.repeat(count)}<block type="thymio_sound_stop"/>${"</next></block>".repeat(count)}`);
  assert.equal(generate(stateOf(nested(500))).code.split("\n").length, 502);
  assert.deepEqual(problemsOf(nested(50_000)), ["tooDeep 1:1"]);
});

test("an error of a file leaves the file and its program as they are", () => {
  const text = aesl(xml('<block type="text_print"></block>'));
  const file = readFile(text);
  assert.deepEqual([file.text, file.code], [text, "call sound.system(-1)\n\n\n"]);
  assert.equal(file.problems[0].severity, "error");
});

test("a damaged file is read or refused, and never changed by that", () => {
  const text = aesl(xml(golden("subroutines.xml").replace(/<\/?xml[^>]*>/g, "")));
  assert.deepEqual(readFile(text).problems, []);
  for (let at = 0; at < text.length; at += 3) {
    const damaged = [
      text.slice(0, at) + text.slice(at + 5),
      text.slice(0, at) + '"<' + text.slice(at),
      text.slice(0, at),
    ];
    for (const each of damaged) {
      const file = readFile(each);
      if (file.problems.length === 0) assert.equal(writeFile(file, file.state), each);
    }
  }
});

test("a stored program is compared with that of the blocks", () => {
  const current = generate(stateOf(xml(SHADOWS))).code;
  assert.equal(difference(readFile(aesl(xml(SHADOWS), current))), null);
  const spaced = current.replaceAll("\n", "\r\n\r\n\t").replace(" = ", "=").replace(/$/, "# end");
  assert.equal(difference(readFile(aesl(xml(SHADOWS), spaced))), null);
  assert.deepEqual(difference(readFile(aesl(xml(SHADOWS), current.replace("= 7", "= 8")))), {
    line: 3,
    stored: "mic.threshold=8",
    generated: "mic.threshold=7",
  });
  assert.deepEqual(difference(readFile(aesl(xml(SHADOWS), `${current}a = 1`)))?.generated, "");
});
