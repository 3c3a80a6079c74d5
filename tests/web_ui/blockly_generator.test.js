import assert from "node:assert/strict";
import { test } from "node:test";

import { BLOCKS } from "../../web_ui/blockly/blocks/index.js";
import { generate, linesOfBlock } from "../../web_ui/blockly/generator.js";
import { allowedName } from "../../web_ui/blockly/names.js";
import { newBlock } from "../../web_ui/blockly/toolbox.js";
import { allBlocks } from "../../web_ui/blockly/state.js";
import { PROGRAMS, golden, number, problemsOf, program, stack, stateOf, workspace } from "./blockly_support.js";

/** @typedef {import("../../web_ui/blockly/state.js").BlockState} BlockState */

/** @type {BlockState} */ const STOP = { type: "thymio_motors_stop", id: "stop" };
const sensor = { type: "thymio_sensor_prox", fields: { SENSOR: "prox.horizontal[2]" } };

for (const name of PROGRAMS) {
  test(`the golden program ${name} is generated word by word`, () => {
    assert.equal(generate(stateOf(golden(`${name}.xml`))).code, golden(`${name}.aseba`));
  });
}

test("every block is in a golden program", () => {
  const used = new Set(
    PROGRAMS.flatMap((name) => [...allBlocks(stateOf(golden(`${name}.xml`)))].map(({ type }) => type)),
  );
  assert.deepEqual(
    [...BLOCKS.keys()].filter((type) => !used.has(type)),
    [],
  );
});

test("every option of every block gives a program of its own", () => {
  for (const spec of BLOCKS.values()) {
    for (const { kind, name, options = [] } of spec.args) {
      if (kind !== "choice" || spec.shape === "hat" || spec.step !== undefined || spec.type === "math_arithmetic")
        continue;
      const codes = options.map(([, value]) => {
        const block = newBlock(spec.type);
        block.fields = { ...block.fields, [name]: value };
        if (spec.shape === "Number")
          return program({ type: "variables_set", fields: { VAR: "x" }, inputs: { VALUE: { block } } }).code;
        return program(spec.shape === "Boolean" ? { type: "thymio_when", inputs: { WHEN: { block } } } : block).code;
      });
      assert.equal(codes.includes(""), false, spec.type);
      const same = spec.type === "thymio_prox_ground_check" && name === "MODE" ? 2 : 0; // white is near, black is far
      if (spec.type !== "logic_operation") assert.equal(new Set(codes).size, options.length - same, spec.type);
    }
  }
});

test("hats of one event become one handler in the order of the workspace", () => {
  /** @param {number} y @param {string} type @param {number} value */
  const hat = (y, type, value) => ({
    type,
    y,
    inputs: { HANDLER: { block: { type: "thymio_actuator_mic", inputs: { VALUE: { shadow: number(value) } } } } },
  });
  const { code } = program(
    hat(300, "thymio_event_shock", 3),
    hat(100, "thymio_event_shock", 1),
    hat(200, "thymio_event_timer", 2),
  );
  assert.equal(
    code,
    "onevent tap\n\tmic.threshold = 1\n\n\tmic.threshold = 3\n\nonevent timer0\n\tmic.threshold = 2\n",
  );
});

test("the plugged block counts, else the shadow, else 0", () => {
  /** @param {BlockState["inputs"]} inputs */
  const code = (inputs) => program({ type: "thymio_actuator_mic", inputs }).code;
  assert.equal(code({ VALUE: { shadow: number(1), block: number(2) } }), "mic.threshold = 2\n");
  assert.equal(code({ VALUE: { shadow: number(1) } }), "mic.threshold = 1\n");
  assert.equal(code({}), "mic.threshold = 0\n");
});

test("each line has the id of its block, and a block all lines inside", () => {
  const state = workspace({
    type: "thymio_event_button",
    id: "hat",
    inputs: { HANDLER: { block: stack({ ...STOP, id: "first" }, { type: "thymio_sound_stop", id: "second" }) } },
  });
  const generated = generate(state);
  assert.deepEqual(generated.blocks, ["hat", "hat", "first", "first", "second", "hat"]);
  assert.equal(generated.code.split("\n").length - 1, generated.blocks.length);
  assert.deepEqual(linesOfBlock(generated.blocks, state, "first"), { first: 2, last: 3 });
  assert.deepEqual(linesOfBlock(generated.blocks, state, "hat"), { first: 0, last: 5 });
  assert.equal(linesOfBlock(generated.blocks, state, "missing"), null);
});

test("a field that is missing or has no valid option is that of a new block", () => {
  for (const fields of [undefined, { SOUND: "99" }]) {
    assert.equal(program({ type: "thymio_sound_system", fields }).code, "call sound.system(0)\n");
  }
  assert.equal(program({ type: "thymio_motors_start", fields: { COMMAND: "constructor" } }).code.split("\n").length, 3);
});

test("a disabled block is left out, what is below it stays", () => {
  const disabled = { ...STOP, disabledReasons: ["MANUALLY_DISABLED"] };
  assert.equal(program(stack(disabled, { type: "thymio_sound_stop" })).code, "call sound.system(-1)\n");
  assert.equal(program({ ...disabled, enabled: false, disabledReasons: [] }).code, "");
});

test("an empty workspace is an empty program", () => {
  assert.deepEqual(generate({}), { code: "", blocks: [], problems: [] });
});

test("names become ones that Aseba accepts", () => {
  const names = {
    "my speed": "my_speed",
    "2nd": "_2nd",
    ".a": "a",
    ça: "ça",
    "x+y": "x_y",
    "": "unnamed",
    "a.b": "a.b",
  };
  for (const [name, allowed] of Object.entries(names)) assert.equal(allowedName(name), allowed);
});

test("names that differ only in case are one variable", () => {
  /** @param {string} VAR */
  const set = (VAR) => ({ type: "variables_set", fields: { VAR }, inputs: { VALUE: { shadow: number(1) } } });
  assert.equal(program(stack(set("Speed"), set("speed"))).code, "var Speed\n\n\nSpeed = 1\nSpeed = 1\n");
});

test("names of constants are avoided", () => {
  const set = { type: "variables_set", fields: { VAR: "SPEED" }, inputs: { VALUE: { shadow: number(1) } } };
  assert.match(generate(workspace(set), { reserved: ["SPEED"] }).code, /^var SPEED2\n/);
});

test("what cannot work is a problem with its block", () => {
  /** @param {string} name */
  const call = (name) => ({ type: "procedures_callnoreturn", extraState: { name } });
  /** @param {string} name @param {BlockState} [inside] @returns {BlockState} */
  const define = (name, inside) => ({
    type: "procedures_defnoreturn",
    fields: { NAME: name },
    inputs: inside ? { STACK: { block: inside } } : {},
  });
  assert.deepEqual(problemsOf(call("away")), ["error noSubroutine"]);
  assert.deepEqual(problemsOf(define("a", call("b")), define("b", call("A"))), ["error recursion"]);
  assert.deepEqual(problemsOf(define("a", call("a"))), ["error recursion"]);
  assert.deepEqual(problemsOf(define("a"), { ...define("A"), id: "2" }), ["error subroutineTwice"]);
  assert.deepEqual(problemsOf({ ...define("a"), extraState: { params: [{ name: "x" }] } }), ["error parameters"]);
  assert.deepEqual(problemsOf(number(1)), ["warning looseValue"]);
  assert.deepEqual(problemsOf({ type: "from_elsewhere" }), ["error unknownBlock"]);
  assert.deepEqual(problemsOf({ type: "thymio_actuator_mic", inputs: { VALUE: { block: number(40000) } } }), [
    "error numberRange",
  ]);
  const near = { type: "thymio_compare", fields: { OP: "LT" }, inputs: { A: { block: sensor } } };
  assert.deepEqual(problemsOf({ type: "controls_whileUntil", inputs: { BOOL: { block: near } } }), [
    "warning loopOnSensor",
  ]);
  const wait = { type: "control_wait" };
  assert.deepEqual(problemsOf({ type: "thymio_event_shock", inputs: { HANDLER: { block: wait } } }), [
    "error needsScript",
  ]);
  const timer = { type: "thymio_event_timer", inputs: { HANDLER: { block: STOP } } };
  assert.deepEqual(problemsOf(timer, stack({ type: "event_whenflagclicked" }, wait)), ["error timerInUse"]);
});

test("a loop on a variable gets no warning", () => {
  const x = { type: "variables_get", fields: { VAR: "x" } };
  const less = { type: "thymio_compare", fields: { OP: "LT" }, inputs: { A: { block: x } } };
  assert.deepEqual(problemsOf({ type: "controls_whileUntil", inputs: { BOOL: { block: less } } }), []);
});

test("a script that takes no time needs no timer", () => {
  const { code } = program(stack({ type: "thymio_whenButton", fields: { B: "front" } }, { type: "thymio_stopMotors" }));
  assert.equal(
    code,
    "onevent button.forward\n\twhen button.forward == 1 do\n\t\tmotor.left.target = 0\n\t\tmotor.right.target = 0\n\tend\n",
  );
});
