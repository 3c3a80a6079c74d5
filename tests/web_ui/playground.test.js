import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { parse, write } from "../../web_ui/playground/document.js";
import { containsPoint, overlap, placed, rectangle } from "../../web_ui/playground/geometry.js";
import { blockerOf, isOnGround, findProblem } from "../../web_ui/playground/validation.js";
import { ROBOT, SHAPES } from "../../web_ui/playground/kinds/index.js";
import { Markers } from "../../web_ui/playground/markers.js";
import { partsOf } from "../../web_ui/playground/parts.js";
import { Fault, needed } from "../../web_ui/playground/rules.js";
import { worldOf } from "../../web_ui/playground/world.js";

/** @typedef {import("../../web_ui/playground/rules.js").Fields} Fields */
/** @typedef {import("../../web_ui/playground/rules.js").Rule} Rule */

const FOLDER = new URL("../../playgrounds/", import.meta.url);
const SCHEMA = JSON.parse(readFileSync(new URL("playground.schema.json", FOLDER), "utf8"));
const NAME = { type: "string", pattern: "^([A-Za-z](_?[A-Za-z0-9])*)$", maxLength: 60 };

/** A rule as the published schema tells it, without its words. @param {Rule} rule @returns {any} */
function schemaOf({ type, low, high, pattern, longest, fewest, fields }) {
  if (type === "number") return { type: "number", minimum: low, maximum: high };
  if (type === "text") return { type: "string", pattern: pattern?.source, maxLength: longest };
  if (type === "image") return { type: "string", minLength: 5, maxLength: longest };
  if (type === "flag") return { type: "boolean" };
  const item = { type: "array", items: { type: "number", minimum: -100, maximum: 100 }, minItems: 2, maxItems: 2 };
  if (type === "points") return { type: "array", items: item, minItems: fewest, maxItems: 1000 };
  return objectOf(fields ?? {}, {});
}

/** @param {Fields} fields @param {Record<string, any>} extra */
function objectOf(fields, extra) {
  const properties = Object.fromEntries(
    Object.entries(fields).map(([key, { rule, defaultValue }]) => {
      const hasDefault = defaultValue !== undefined && defaultValue !== null;
      return [key, { ...schemaOf(rule), ...(hasDefault ? { default: defaultValue } : {}) }];
    }),
  );
  const required = Object.entries(fields)
    .filter(([, { required }]) => required)
    .map(([key]) => key);
  return { type: "object", properties: { ...extra, ...properties }, required };
}

/** The schema without words, without the null that what may be left out may be, and in one order. @param {any} schema @returns {any} */
function bare(schema) {
  if (Array.isArray(schema)) return schema.map(bare);
  if (typeof schema !== "object" || schema === null) return schema;
  if (schema.anyOf?.[1]?.type === "null") return bare(schema.anyOf[0]);
  const { description: _words, additionalProperties: _closed, ...rest } = schema;
  if (rest.default === null) delete rest.default;
  if (rest.required?.length === 0) delete rest.required;
  const entries = Object.entries(rest).map(([key, value]) => [
    key,
    key === "properties" ? members(value) : bare(value),
  ]);
  if (Array.isArray(rest.required)) rest.required.sort();
  return Object.fromEntries(entries.sort(([one], [other]) => (one < other ? -1 : 1)));
}

/** @param {Record<string, any>} properties */
function members(properties) {
  return Object.fromEntries(
    Object.keys(properties)
      .sort()
      .map((key) => [key, bare(properties[key])]),
  );
}

for (const kind of SHAPES) {
  test(`a ${kind.name} has the fields of the published schema`, () => {
    const forms = SCHEMA.properties.shapes.items.oneOf;
    const published = forms.find((/** @type {any} */ form) => form.properties.kind.const === kind.name);
    const own = objectOf(kind.fields, { kind: { const: kind.name }, name: NAME });
    assert.deepEqual(bare(own).properties, bare(published).properties);
    assert.deepEqual(new Set(published.required), new Set(["kind", ...own.required]));
  });
}

test("the page knows every shape of the published schema, and a robot's fields", () => {
  const kinds = SCHEMA.properties.shapes.items.oneOf.map((/** @type {any} */ form) => form.properties.kind.const);
  assert.deepEqual(SHAPES.map(({ name }) => name).sort(), kinds.sort());
  assert.deepEqual(bare(objectOf(ROBOT.fields, {})).properties, bare(SCHEMA.properties.robots.items).properties);
});

for (const file of readdirSync(FOLDER).filter((name) => name.endsWith(".json") && !name.includes("schema"))) {
  test(`${file} is read, drawn and written back as it is`, () => {
    const text = readFileSync(new URL(file, FOLDER), "utf8").replace("line_gradient.svg", "data:image/svg+xml;base64,");
    const playground = parse(text);
    const given = JSON.parse(text);
    const written = JSON.parse(write(playground));
    assert.deepEqual(written.shapes, given.shapes);
    assert.deepEqual(written.robots, given.robots);
    assert.equal(written.title, given.title);
    assert.deepEqual(written.translations, given.translations);
    const world = worldOf(playground.items, new Markers(() => null));
    assert.equal(Object.keys(world.robots).length, given.robots.length);
    assert.ok(world.markers.size >= given.shapes.length - (file === "line_gradient.json" ? 1 : 0));
    for (const item of playground.items)
      assert.ok(isOnGround(playground.items, item) || item.kind !== "robot", item.name);
  });
}

/** @param {any[]} shapes @param {any[]} [robots] */
const text = (shapes, robots = []) => JSON.stringify({ format: 1, title: "t", shapes, robots });
const BOX = {
  kind: "box",
  name: "crate",
  x_m: 0,
  y_m: 0,
  size_x_m: 0.1,
  size_y_m: 0.1,
  height_m: 0.1,
  color: "#112233",
};

test("titles may contain any characters, counted as code points; lone surrogates are rejected", () => {
  const titled = (/** @type {string} */ title) => parse(JSON.stringify({ format: 1, title })).title;
  for (const title of ["Labyrinth 🤖", "متاهة", "🤖".repeat(2000)]) assert.equal(titled(title), title);
  for (const title of ["🤖".repeat(2001), "\ud83e", "two\nlines"]) {
    assert.throws(() => titled(title), (fault) => fault instanceof Fault && fault.key === "title", title);
  }
});

for (const [what, given, key, word] of /** @type {[string, string, string, string][]} */ ([
  ["no JSON", "{", "", "fault.json"],
  ["a list", "[]", "", "fault.object"],
  ["another format", '{"format": 2, "title": ""}', "format", "fault.format"],
  ["a missing title", '{"format": 1}', "title", "fault.line"],
  ["an unknown key", text([{ ...BOX, sise_x_m: 1 }]), "shapes[0].sise_x_m", "fault.known"],
  ["a missing key", text([{ kind: "box", x_m: 0 }]), "shapes[0].y_m", "fault.number"],
  ["a number out of range", text([{ ...BOX, size_x_m: 0 }]), "shapes[0].size_x_m", "fault.number"],
  ["text for a number", text([{ ...BOX, x_m: "1" }]), "shapes[0].x_m", "fault.number"],
  ["a wrong color", text([{ ...BOX, color: "red" }]), "shapes[0].color", "fault.shade"],
  ["a name twice", text([BOX, BOX]), "shapes[1].name", "fault.ownName"],
  ["a robot in a box", text([BOX], [{ name: "thymio", x_m: 0, y_m: 0 }]), "robots[0]", "fault.free"],
  ["a track of one place", text([{ kind: "track", points_m: [[0, 0], [0, 0]], width_m: 0.1, color: "#000000" }]), "shapes[0].points_m", "fault.places"], // prettier-ignore
  ["a plate without its door", text([{ kind: "activation", x_m: 0, y_m: 0, size_x_m: 0.1, size_y_m: 0.1, area_m: [[0, 0], [1, 0], [0, 1]], door: "gate" }]), "shapes[0].door", "fault.door"], // prettier-ignore
])) {
  test(`${what} is rejected with its location`, () => {
    assert.throws(
      () => parse(given),
      (error) => error instanceof Fault && error.key === key && error.expected.word === word,
    );
  });
}

test("a shape of another package is kept as it is", () => {
  const spiral = { kind: "spiral", name: "s", turns: 3 };
  assert.deepEqual(JSON.parse(write(parse(text([spiral])))).shapes, [spiral]);
});

test("unnamed shapes get the same names as in the simulator", () => {
  const { name: _name, ...unnamed } = BOX;
  assert.equal(parse(text([unnamed])).items[0].name, "box_0");
});

test("an item may not overlap a robot, but objects may overlap each other", () => {
  const [robot] = parse(text([], [{ name: "thymio", x_m: 0, y_m: 0 }])).items;
  const crate = { ...BOX, x_m: 0.05 };
  assert.equal(blockerOf([robot], crate), "thymio");
  assert.deepEqual(findProblem([robot], crate), { word: "problem.blocked", values: { name: "thymio" } });
  assert.equal(findProblem([robot, { ...BOX, name: "other", x_m: 0.2 }], { ...BOX, x_m: 0.21 }), null);
  assert.equal(findProblem([robot], { ...BOX, x_m: 0.13 + 1e-9 }), null);
});

test("a value out of range is a problem with its key", () => {
  assert.equal(findProblem([], { ...BOX, height_m: 0 })?.values?.key, "height_m");
});

test("an item on a ground or on its edge is on the ground", () => {
  const ground = { kind: "rectangle", name: "g", size_x_m: 1, size_y_m: 1, color: "#ffffff" };
  assert.equal(isOnGround([ground], { ...BOX, x_m: 0.5 }), true);
  assert.equal(isOnGround([ground], { ...BOX, x_m: 0.51 }), false);
  assert.equal(isOnGround([], { ...BOX, x_m: 9 }), true);
});

test("unchanged items keep their markers", () => {
  const markers = new Markers(() => null);
  const items = [{ kind: "rectangle", name: "g", size_x_m: 1, size_y_m: 1, color: "#ffffff", walls: {} }, BOX];
  const before = markers.of(items);
  const after = markers.of([items[0], { ...BOX, x_m: 0.2 }]);
  assert.equal(before.size, 6);
  assert.equal(after.get("solid/g/1"), before.get("solid/g/1"));
  assert.notEqual(after.get("solid/crate/1"), before.get("solid/crate/1"));
});

test("a disc beside a corner does not overlap it", () => {
  const square = { vertices: rectangle(2, 2) };
  assert.equal(overlap(square, { middle: [1.8, 1.8], radius: 1 }), false);
  assert.equal(overlap(square, { middle: [1.7, 1.7], radius: 1 }), true);
  assert.equal(overlap({ middle: [0, 0], radius: 0.1 }, square), true);
  assert.equal(containsPoint(placed({ x: 1, y: 0, yaw: Math.PI / 4 }, rectangle(1, 1)), [1.6, 0]), true);
});

test("a robot's kind needs a name", () => {
  assert.ok(needed(ROBOT.fields.name.rule).required);
  assert.equal(partsOf({ kind: "robot", name: "a", x_m: 0, y_m: 0 }).footprints.length, 1);
});
