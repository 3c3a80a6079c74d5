import assert from "node:assert/strict";
import { test } from "node:test";

import { blocksOfText } from "../../web_ui/blockly/from_text.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { THYMIO } from "../../web_ui/blockly/blocks/index.js";
import { allBlocks } from "../../web_ui/blockly/state.js";
import { newBlock } from "../../web_ui/blockly/toolbox.js";
import { readVpl } from "../../web_ui/vpl/file.js";
import { asBlocks } from "../../web_ui/blockly/as_blocks.js";
import { sampleText } from "../../web_ui/vpl/view/samples.js";
import { readFile } from "../../web_ui/blockly/file.js";
import { golden } from "./blockly_support.js";

/** The program of the blocks of a text. @param {string} code */
function again(code) {
  const { state, unknown } = blocksOfText(code);
  if (state === null) return unknown;
  const { code: text, problems } = generate(state);
  assert.deepEqual(problems, []);
  return text;
}

/** The declarations, whose order does not matter, and the statements. @param {any} code */
function parts(code) {
  const lines = String(code)
    .split("\n")
    .filter((line) => line !== "");
  const [declared, others] = [true, false].map((is) => lines.filter((line) => line.startsWith("var ") === is));
  return [declared.sort(), others];
}

const TEXTS = ["actuators", "avoid_obstacles", "events", "follow_line", "leds", "logic", "loops", "math", "robot_names"];
for (const name of [...TEXTS, "sensors", "subroutines", "variables", "vpl_tilt"]) {
  test(`the blocks of the text of ${name} give that text`, () => {
    const code = golden(`${name}.aseba`).replace(/^\s*#.*\n/gm, "");
    assert.deepEqual(parts(again(code)), parts(code));
  });
}

/** A program that uses a block. @param {import("../../web_ui/blockly/state.js").BlockState} block @param {string} shape */
function programWith(block, shape) {
  const plugged = { inputs: { [shape === "Number" ? "VALUE" : "WHEN"]: { block } } };
  const top = {
    Number: { type: "thymio_set_array", fields: { VAR: { id: "l" } }, ...plugged },
    Boolean: { type: "thymio_when", ...plugged },
  }[shape];
  return { blocks: { languageVersion: 0, blocks: [top ?? block] }, variables: [{ id: "l", name: "l" }] };
}

const CANNOT_STAND_ALONE = ["procedures_callnoreturn"];
const THYMIO_BLOCKS = THYMIO.filter(({ type }) => !CANNOT_STAND_ALONE.includes(type));
for (const { type, shape, args } of THYMIO_BLOCKS) {
  test(`the text of ${type} becomes blocks with that text, whatever is chosen in it`, () => {
    const choices = args.filter(({ kind }) => kind === "choice");
    const all = choices.reduce(
      (some, { name, options = [] }) => some.flatMap((one) => options.map(([, value]) => ({ ...one, [name]: value }))),
      [{}],
    );
    for (const chosen of all) {
      const block = newBlock(type);
      const { code } = generate(programWith({ ...block, fields: { ...block.fields, ...chosen } }, shape));
      assert.equal(again(code), code.replace("= -0", "= 0"), JSON.stringify(chosen));
    }
  });
}

test("every statement and operator that has blocks becomes them", () => {
  const code = `var b[3]
var a


a = -5
b[0] = abs a
while a < 3 or not a == 1 do
	a = a + 1
end
for a in -2:5 do
	b[1] = ~b[0] << 2
end
if a > 1 and button.left == 1 then
	call sound.system(2)
elseif temperature != 20 then
	prox.comm.tx = mic.intensity
else
	call leds.rc(b[a])
end
`;
  assert.equal(again(code), code);
  assert.equal(again("var a = 1\na += 2\na++\na--\n"), "var a\n\n\na = 1\na = a + 2\na = a + 1\na = a - 1\n");
  const copy = "var a[2] = [1, 2]\nvar b[2]\ncall math.copy(b, a)\ncall math.copy(b[1:1], [7])\n";
  assert.equal(again(copy), "var a[2]\nvar b[2]\n\n\na[0] = 1\na[1] = 2\nb[0] = a[0]\nb[1] = a[1]\nb[1] = 7\n");
});

for (const [code, line] of /** @type {[string, number][]} */ ([
  ["var a\nemit other", 2],
  ["var a\n\n# comment\nsd.present = 1", 4],
  ["call math.rand(a)", 1],
  ["call prox.comm.enable(2)", 1],
  ["onevent button.left\ncall leds.rc(1)", 2],
  ["onevent button.left\nwhen button.right == 1 do\nend", 2],
  ["var a\nfor a in 0:9 step -1 do\nend", 2],
  ["onevent other\nmotor.left.target = 1", 1],
  ["var a[3]\na = [1, 2, 3]", 2],
  ["var a[4]\ncall math.copy(a[1:3], a[0:2])", 2],
  ["var a\nfor a in 0:9 step 2 do\nend", 2],
  ["var a\nmotor.left.target = prox.horizontal[a]", 2],
  ["var a\na = (1", 2],
  ["return", 1],
])) {
  test(`no block stands for line ${line} of ${JSON.stringify(code)}`, () => {
    assert.deepEqual(again(code), { line, text: code.split("\n")[line - 1] });
  });
}

for (const name of ["empty", "avoid", "line", "buttons", "music", "timer", "states", "remote", "tilt", "counter"]) {
  test(`the sample ${name} of VPL is a file of blocks without mistakes`, () => {
    const { text } = asBlocks(readVpl(sampleText(name)).code);
    const file = readFile(text ?? "");
    assert.deepEqual(file.problems, []);
    assert.equal(file.hasWorkspace, true);
    const { code, problems } = generate(file.state);
    assert.deepEqual(problems, []);
    assert.equal(code.trim(), file.code?.trim());
    assert.equal([...allBlocks(file.state)].length > 0, name !== "empty");
    assert.doesNotMatch(code, /emit/);
  });
}
