// Every parser of the page accepts or refuses any file: changed files, each with one to four changes. With
// THYMIO_SIM_FUZZ=100000 it is a campaign (docs/reliability.md).

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";

import { readFile } from "../../web_ui/blockly/file.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { decoded } from "../../web_ui/browser/text_file.js";
import { AeslError, readAesl } from "../../web_ui/editor/aesl.js";
import { parse } from "../../web_ui/playground/document.js";
import { Fault } from "../../web_ui/playground/rules.js";
import { readToolbox } from "../../web_ui/editor/toolbox_file.js";
import { CdrError, decode } from "../../web_ui/protocol/cdr.js";
import { FrameError, parseFrame } from "../../web_ui/protocol/frames.js";
import { parseSchema, SchemaError } from "../../web_ui/protocol/ros2msg.js";
import { importProject, importSb3 } from "../../web_ui/blockly/scratch/import_sb3.js";
import { VplError } from "../../web_ui/vpl/errors.js";
import { readVpl } from "../../web_ui/vpl/file.js";
import { zip } from "./blockly_support.js";
import { bytes, CAPTURED, view } from "./support.js";

const INPUTS = Number(process.env.THYMIO_SIM_FUZZ ?? 300);
const ODD = ["<", "&#", "]]>", "<!DOCTYPE x [", '"', "{", "[[[[", "null", "-1", "1e999", "__proto__", "\u0000", "\ud800", "é"];
const VALUES = [null, true, -1, 0, 1e300, "", "__proto__", "constructor", [], [[]], {}, { a: 1 }];

const root = new URL("../../", import.meta.url);
/** @param {string} folder @param {string} ending */
const texts = (folder, ending) =>
  readdirSync(new URL(folder, root))
    .filter((name) => name.endsWith(ending))
    .map((name) => readFileSync(new URL(`${folder}/${name}`, root), "utf8"));

const PROJECT = {
  targets: [
    { isStage: true, name: "Stage", variables: { v: ["speed", 5] }, lists: {}, blocks: {} },
    {
      isStage: false,
      name: "Thymio",
      variables: {},
      blocks: {
        hat: { opcode: "event_whenflagclicked", topLevel: true, next: "a", inputs: {}, fields: {}, x: 5, y: 6 },
        a: { opcode: "control_if", next: "b", parent: "hat", inputs: { CONDITION: [2, "c"], SUBSTACK: [2, "d"] }, fields: {} },
        b: { opcode: "data_setvariableto", next: null, inputs: { VALUE: [1, [10, "7"]] }, fields: { VARIABLE: ["speed", "v"] } },
        c: { opcode: "operator_gt", next: null, inputs: { OPERAND1: [3, [12, "speed", "v"], [10, ""]], OPERAND2: [1, [10, "5"]] }, fields: {} },
        d: { opcode: "control_wait", next: null, inputs: { DURATION: [1, [5, "1"]] }, fields: {} },
      },
    },
  ],
};

/** @type {[name: string, refusals: any[], seeds: any[], change: Function, run: (input: any) => unknown][]} */
const TARGETS = [
  ["VPL", [VplError, AeslError], texts("tests/data/web/vpl", ".aesl"), changedText, readVpl],
  ["Blockly", [], texts("tests/data/web/blockly", ".xml"), changedText, blockly],
  [".aesl", [AeslError], texts("tests/data/web/vpl", ".aesl"), changedText, readAesl],
  ["playground as text", [Fault], texts("playgrounds", "k.json"), changedText, parse],
  ["playground", [Fault], texts("playgrounds", "e.json").map((text) => JSON.parse(text)), changedValue, (data) => parse(JSON.stringify(data))],
  ["toolbox", [], [{ toolbox: 1, hide: ["a"], modes: ["b"] }], changedValue, (data) => readToolbox(JSON.stringify(data))],
  ["Scratch project", [], [PROJECT], changedValue, scratch],
  ["Scratch file", [], [zip({ "project.json": JSON.stringify(PROJECT) })], changedBytes, importSb3],
  ["text file", [TypeError, RangeError], ["<?xml version='1.0' encoding='utf-16'?><a/>"].map((text) => new TextEncoder().encode(text)), changedBytes, decoded],
  ["frame", [FrameError], CAPTURED.map(({ hex }) => bytes(`0105000000ffffffffffffffff${hex}`)), changedBytes, (data) => parseFrame(data.slice().buffer)],
  ["schema", [SchemaError], CAPTURED.filter(({ schemaName }) => schemaName.startsWith("geometry_msgs/")).map(({ schema }) => schema), changedText, (text) => parseSchema("geometry_msgs/msg/Any", text)],
  ...CAPTURED.slice(0, 6).map(({ schemaName, schema, hex }) => {
    const definition = parseSchema(schemaName, schema);
    return /** @type {any} */ ([schemaName, [CdrError], [bytes(hex)], changedBytes, (/** @type {Uint8Array} */ data) => decode(definition, view(data))]);
  }),
];

/** Numbers from 0 to 1, the same for the same name (mulberry32). @param {string} name */
function random(name) {
  let state = [...name].reduce((sum, character) => (sum * 31 + character.charCodeAt(0)) | 0, 7);
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), 1 | state);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
}

/** @param {string} text */
function blockly(text) {
  const file = readFile(text);
  if (file.hasWorkspace && file.problems.length === 0) generate(file.state);
}

/** @param {any} project */
function scratch(project) {
  const { state, error } = importProject(project);
  if (error === null) generate(state);
}

for (const [name, refusals, seeds, change, run] of TARGETS) {
  test(`${name}: any input is read or refused`, async () => {
    const next = random(name);
    assert.ok(seeds.length > 0);
    for (const seed of seeds) await run(seed);
    for (let number = 0; number < INPUTS; number++) {
      let input = seeds[Math.floor(next() * seeds.length)];
      for (let left = 1 + Math.floor(next() * 4); left > 0; left--) input = change(input, next);
      try {
        await run(input);
      } catch (error) {
        const shown = input instanceof Uint8Array ? Buffer.from(input).toString("hex") : JSON.stringify(input);
        assert.ok(refusals.some((kind) => error instanceof kind), `${error instanceof Error ? error.stack : error}\n${shown}`);
      }
    }
  });
}

/** @param {string} text @param {() => number} next */
function changedText(text, next) {
  const at = Math.floor(next() * (text.length + 1));
  const size = Math.floor(next() * 12);
  switch (Math.floor(next() * 4)) {
    case 0:
      return text.slice(0, at) + text.slice(at + size);
    case 1:
      return text.slice(0, at) + ODD[Math.floor(next() * ODD.length)] + text.slice(at);
    case 2:
      return text.slice(0, at) + text.slice(at - size * 9, at) + text.slice(at);
    default:
      return text.slice(0, at);
  }
}

/** @param {Uint8Array} data @param {() => number} next */
function changedBytes(data, next) {
  const at = Math.floor(next() * data.length);
  if (next() < 0.2) return data.slice(0, at);
  const changed = data.slice();
  if (data.length > 0) changed[at] = next() < 0.5 ? 255 : changed[at] ^ (1 << Math.floor(next() * 8));
  return changed;
}

/** A copy of JSON data with one value replaced or left out. @param {any} data @param {() => number} next */
function changedValue(data, next) {
  const copy = structuredClone(data);
  /** @type {[any, string][]} */ const places = [];
  /** @param {any} value */
  const collect = (value) => {
    if (typeof value !== "object" || value === null) return;
    for (const key of Object.keys(value)) {
      places.push([value, key]);
      collect(value[key]);
    }
  };
  collect(copy);
  if (places.length === 0) return copy;
  const [owner, key] = places[Math.floor(next() * places.length)];
  if (next() < 0.2) delete owner[key];
  else owner[key] = VALUES[Math.floor(next() * VALUES.length)];
  return copy;
}
