import assert from "node:assert/strict";
import { test } from "node:test";

import { newFile, readFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { importProject, importSb3 } from "../../web_ui/blockly/scratch/import_sb3.js";
import { ZipError, readZip } from "../../web_ui/blockly/scratch/zip.js";
import { zip } from "./blockly_support.js";

/** A project with one sprite. @param {Record<string, any>} blocks @param {Record<string, any>} [variables] */
const project = (blocks, variables = {}) => ({
  targets: [
    { isStage: true, name: "Stage", variables, blocks: {} },
    { isStage: false, name: "Thymio", variables: {}, blocks },
  ],
  extensions: ["thymio"],
  meta: { semver: "3.0.0", vm: "0.2.0" },
});

/** @param {string} menu @param {string | number} value */
const menu = (menu, value) => ({
  opcode: `thymio_menu_${menu}`,
  fields: { [menu]: [value, null] },
  shadow: true,
  inputs: {},
});
const FLAG = { opcode: "event_whenflagclicked", topLevel: true, next: "a", inputs: {}, fields: {}, x: 5, y: 6 };

/** @param {Record<string, any>} blocks @param {Record<string, any>} [variables] */
function imported(blocks, variables) {
  const { state, error, leftOut } = importProject(project(blocks, variables));
  assert.equal(error, null);
  return { code: generate(state).code, problems: generate(state).problems, leftOut, state };
}

const DRIVE = {
  hat: { opcode: "thymio_whenButton", topLevel: true, next: "a", inputs: { B: [1, "m0"] }, fields: {} },
  m0: menu("buttons", "front"),
  a: { opcode: "thymio_setMotor", next: null, inputs: { M: [1, "m1"], N: [1, [4, "100"]] }, fields: {} },
  m1: menu("leftrightall", "left"),
};
const DRIVE_CODE = "onevent button.forward\n\twhen button.forward == 1 do\n\t\tmotor.left.target = 320\n\tend\n";

test("menus and numbers of a project become fields and inputs", () => {
  const { code, leftOut } = imported(DRIVE);
  assert.equal(code, DRIVE_CODE);
  assert.deepEqual(leftOut, []);
});

test("a project is read from its archive, packed or not, in a folder or not", async () => {
  const text = JSON.stringify(project(DRIVE));
  for (const archive of [
    zip({ "project.json": text }),
    zip({ "a.svg": "<svg/>", "project.json": text }, false),
    zip({ "p/project.json": text }),
  ]) {
    const { state, error } = await importSb3(archive);
    assert.equal(error, null);
    assert.equal(generate(state).code, DRIVE_CODE);
  }
});

test("menus hold text, numbers, nothing, or a block", () => {
  /** @param {any} input @param {Record<string, any>} others */
  const withMenu = (input, others) =>
    imported({
      hat: { ...FLAG },
      a: {
        opcode: "data_setvariableto",
        next: null,
        inputs: { VALUE: [3, "p", [10, "0"]] },
        fields: { VARIABLE: ["v", "id"] },
      },
      p: { opcode: "thymio_proximity", inputs: { N: input }, fields: {} },
      ...others,
    });
  for (const value of ["1", 1]) {
    assert.match(withMenu([1, "m"], { m: menu("horizontalSensors", value) }).code, /v = prox.horizontal\[1\]/);
  }
  const empty = withMenu([1, "m"], { m: menu("horizontalSensors", "") });
  assert.match(empty.code, /v = prox.horizontal\[0\]/);
  assert.deepEqual(empty.leftOut, []);
  assert.match(withMenu([1, [10, "2"]], {}).code, /v = prox.horizontal\[2\]/);
  const variable = withMenu([3, [12, "which", "id2"], "m"], { m: menu("horizontalSensors", "3") });
  assert.deepEqual(
    variable.leftOut.map(({ key }) => key),
    ["leftOutMenu"],
  );
});

test("conditions, loops, operators and variables are imported", () => {
  const { code, problems, leftOut } = imported(
    {
      hat: { ...FLAG },
      a: { opcode: "control_forever", next: null, inputs: { SUBSTACK: [2, "if"] }, fields: {} },
      if: {
        opcode: "control_if_else",
        next: "c",
        inputs: { CONDITION: [2, "or"], SUBSTACK: [2, "b"], SUBSTACK2: [2, "s"] },
        fields: {},
      },
      or: { opcode: "operator_or", inputs: { OPERAND1: [2, "gt"], OPERAND2: [2, "not"] }, fields: {} },
      gt: { opcode: "operator_gt", inputs: { OPERAND1: [3, "g", [10, ""]], OPERAND2: [1, [10, "300"]] }, fields: {} },
      g: { opcode: "thymio_ground", inputs: { N: [1, "m"] }, fields: {} },
      m: menu("groundSensors", 1),
      not: { opcode: "operator_not", inputs: {}, fields: {} },
      b: { opcode: "thymio_moveWithTime", next: null, inputs: { N: [1, [4, "50"]], S: [1, [4, "0.5"]] }, fields: {} },
      s: { opcode: "thymio_stopMotors", next: null, inputs: {}, fields: {} },
      c: {
        opcode: "data_changevariableby",
        next: null,
        inputs: { VALUE: [3, [12, "step", "id3"], [4, "1"]] },
        fields: { VARIABLE: ["rounds", "id2"] },
      },
    },
    { id2: ["rounds", 0], id3: ["step", 2], id4: ["unused", 5] },
  );
  assert.deepEqual(problems, []);
  assert.match(code, /prox\.ground\.delta\[1\] > 300 or not 0 == 0/);
  assert.match(code, /move\.steps = 50\n/);
  assert.match(code, /rounds = rounds \+ step/);
  assert.deepEqual(leftOut, [{ key: "leftOutInitial", values: { name: "step", text: "2", count: 1 } }]);
});

test("inputs of blocks are found by name, in any order", () => {
  const { code, problems, leftOut } = imported({
    hat: { ...FLAG },
    a: { opcode: "thymio_arc", next: "b", inputs: { A: [1, [4, "90"]], R: [1, [4, "200"]] }, fields: {} },
    b: {
      opcode: "thymio_setOdomoter",
      next: "c",
      inputs: { P: [1, [4, "3"]], O: [1, [4, "2"]], N: [1, [4, "1"]] },
      fields: {},
    },
    c: { opcode: "thymio_nextDial", next: "d", inputs: {}, fields: { L: ["right", null] } },
    d: { opcode: "thymio_setLeds", next: null, inputs: { C: [1, [4, "66"]], L: [1, "m"] }, fields: {} },
    m: menu("light", "bottom-left"),
  });
  assert.deepEqual([problems, leftOut], [[], []]);
  for (const line of [
    "call math.max(move.longest, abs 200, 100)",
    "call math.muldiv(move.left, move.longest + 45, 90 * 10, 573)",
    "odo.direction = 1",
    "odo.x = 2",
    "odo.y = 3",
    "dial.number = dial.number + 1",
    "color.number[1] = 66",
    "color.lights = 2",
  ])
    assert.ok(code.includes(`${line}\n`), line);
});

test("a button is a condition, and the imported program can be shown", async () => {
  const blocks = {
    hat: { ...FLAG },
    a: { opcode: "control_if", next: null, inputs: { CONDITION: [2, "b"], SUBSTACK: [2, "s"] }, fields: {} },
    b: { opcode: "thymio_valButton", inputs: { B: [1, "m"] }, fields: {} },
    m: menu("buttons", "back"),
    s: { opcode: "thymio_stopMotors", next: null, inputs: {}, fields: {} },
  };
  const { state, code } = imported(blocks);
  assert.match(code, /button\.backward != 0/);
  assert.deepEqual(readFile(newFile(state, code)).problems, []);
});

test("a report of all sensors at once is listed", () => {
  const value = { VALUE: [3, "p", [10, "0"]] };
  const { leftOut } = imported({
    hat: { ...FLAG },
    a: { opcode: "data_setvariableto", next: null, inputs: value, fields: { VARIABLE: ["v", "id"] } },
    p: { opcode: "thymio_proxHorizontal", inputs: {}, fields: {} },
  });
  assert.deepEqual(leftOut, [{ key: "leftOutBlock", values: { opcode: "thymio_proxHorizontal", count: 1 } }]);
});

test("what the robot cannot do is listed with how often it occurs", () => {
  const { leftOut, code } = imported({
    hat: { ...FLAG },
    a: { opcode: "looks_say", next: "b", inputs: { MESSAGE: [1, [10, "Hi"]] }, fields: {} },
    b: { opcode: "looks_say", next: "c", inputs: { MESSAGE: [1, [10, "Ho"]] }, fields: {} },
    c: { opcode: "thymio_move", next: "d", inputs: { N: [1, [4, "far"]] }, fields: {} },
    d: { opcode: "thymio_move", next: "e", inputs: { N: [1, [4, "10.5"]] }, fields: {} },
    e: { opcode: "thymio_distance", next: null, inputs: {}, fields: {} },
    key: {
      opcode: "event_whenkeypressed",
      topLevel: true,
      next: null,
      inputs: {},
      fields: { KEY_OPTION: ["space", null] },
    },
    loose: { opcode: "thymio_stopMotors", topLevel: true, next: null, inputs: {}, fields: {} },
    alone: [12, "v", "id", 10, 20],
  });
  assert.deepEqual(leftOut, [
    { key: "leftOutBlock", values: { opcode: "looks_say", count: 2 } },
    { key: "leftOutText", values: { text: "far", count: 1 } },
    { key: "leftOutFraction", values: { text: "10.5", used: 10, count: 1 } },
    { key: "leftOutBlock", values: { opcode: "thymio_distance", count: 1 } },
    { key: "leftOutHat", values: { opcode: "event_whenkeypressed", count: 1 } },
    { key: "leftOutLoose", values: { count: 1 } },
  ]);
  assert.match(code, /move\.left = 10\n/);
});

test("messages start other scripts, also of other sprites", () => {
  const two = project({
    hat: { ...FLAG },
    a: { opcode: "event_broadcast", next: null, inputs: { BROADCAST_INPUT: [1, [11, "go", "id"]] }, fields: {} },
  });
  two.targets.push({
    isStage: false,
    name: "Second",
    variables: {},
    blocks: {
      hat: {
        opcode: "event_whenbroadcastreceived",
        topLevel: true,
        next: "a",
        inputs: {},
        fields: { BROADCAST_OPTION: ["go", "id"] },
      },
      a: { opcode: "control_wait", next: null, inputs: { DURATION: [1, [5, "1"]] }, fields: {} },
    },
  });
  const { state } = importProject(two);
  const ids = state.blocks?.blocks.map(({ id }) => id);
  assert.deepEqual(ids, ["hat", "1.hat"]);
  assert.match(generate(state).code, /^script = 1$/m);
});

test("a message that a block computes is listed, and the name under the block is used", () => {
  const { state, leftOut } = importProject(
    project({
      hat: { ...FLAG },
      a: { opcode: "event_broadcast", next: null, inputs: { BROADCAST_INPUT: [3, [12, "n", "v"], [11, "go", "id"]] } },
    }),
  );
  assert.deepEqual(leftOut, [{ key: "leftOutMenu", values: { opcode: "event_broadcast", used: "go", count: 1 } }]);
  assert.equal(state.blocks?.blocks[0].next?.block?.fields?.MESSAGE, "go");
});

test("variables of two sprites with one name stay two", () => {
  /** @param {string} id @param {string} value */
  const sets = (id, value) => ({
    hat: { ...FLAG },
    a: {
      opcode: "data_setvariableto",
      next: null,
      inputs: { VALUE: [1, [10, value]] },
      fields: { VARIABLE: ["Speed", id] },
    },
  });
  const two = project(sets("one", "1"));
  two.targets.push({ isStage: false, name: "Second", variables: {}, blocks: sets("two", "2") });
  assert.match(generate(importProject(two).state).code, /Speed = 1\nSpeed_2 = 2\n$/);
});

test("a block inside itself is left out", () => {
  const { leftOut } = imported({
    hat: { ...FLAG },
    a: { opcode: "control_forever", next: null, inputs: { SUBSTACK: [2, "a"] }, fields: {} },
  });
  assert.deepEqual(leftOut, []);
});

test("a division is imported, and its fractions are listed", () => {
  const { code, leftOut } = imported({
    hat: { ...FLAG },
    a: { opcode: "thymio_move", next: null, inputs: { N: [3, "d", [4, "50"]] }, fields: {} },
    d: { opcode: "operator_divide", inputs: { NUM1: [1, [4, "7"]], NUM2: [1, [4, "2"]] }, fields: {} },
  });
  assert.match(code, /move\.left = 7 \/ 2/);
  assert.deepEqual(leftOut, [{ key: "leftOutDivision", values: { count: 1 } }]);
});

test("a project with wrong parts is read without an internal error", () => {
  const text = JSON.stringify(project(DRIVE, { id: ["v", 1] }));
  const values = ["null", "5", '"x"', "[]", "{}", "[1]", "[null]", "true"];
  for (const match of text.matchAll(/(?<=[:,[])("[^"]*"|\d+|null|true|\[[^[\]]*\]|\{[^{}]*\})/g)) {
    for (const value of values) {
      const changed = text.slice(0, match.index) + value + text.slice(match.index + match[0].length);
      let data;
      try {
        data = JSON.parse(changed);
      } catch {
        continue; // the name of an entry
      }
      generate(importProject(data).state);
    }
  }
});

test("a circle of blocks in a damaged project ends", () => {
  const { code } = imported({
    hat: { ...FLAG },
    a: { opcode: "thymio_stopMotors", next: "a", inputs: {}, fields: {} },
  });
  assert.equal(code.match(/motor.left/g)?.length, 1);
});

test("older and other files are refused with a reason", async () => {
  const key = async (/** @type {Uint8Array} */ archive) => (await importSb3(archive)).error?.key;
  assert.equal(await key(new Uint8Array(5)), "notZip");
  assert.equal(await key(zip({ "other.json": "{}" })), "notZip");
  assert.equal(await key(zip({ "project.json": "{" })), "notZip");
  assert.equal(await key(zip({ "project.json": "{}" })), "notZip");
  assert.equal(await key(zip({ "project.json": '{"objName": "Stage"}' })), "olderScratch");
});

test("a damaged archive is refused", async () => {
  const good = zip({ "project.json": JSON.stringify(project(DRIVE)) });
  for (let size = 0; size < good.length; size += 7) {
    await assert.rejects(readZip(good.subarray(0, size), "project.json"), ZipError);
  }
  for (let at = 0; at < good.length; at += 11) {
    const damaged = good.slice();
    damaged[at] ^= 0x55;
    await importSb3(damaged); // reads it or says why not, and throws nothing
  }
});
