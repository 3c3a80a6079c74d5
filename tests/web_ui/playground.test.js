import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { parse, write } from "../../web_ui/playground/document.js";
import { containsPoint, overlap, placed, rectangle } from "../../web_ui/playground/geometry.js";
import { blockerOf, isOnGround, findProblem } from "../../web_ui/playground/validation.js";
import { BUILT_IN } from "../../web_ui/playground/declarations.js";
import { kindNamed, ROBOT, shapeKinds } from "../../web_ui/playground/kinds/index.js";
import { Markers } from "../../web_ui/playground/markers.js";
import { partsOf, valuesOf } from "../../web_ui/playground/parts.js";
import { Fault } from "../../web_ui/playground/rules.js";
import { worldOf } from "../../web_ui/playground/world.js";

const FOLDER = new URL("../../playgrounds/", import.meta.url);
/** Playgrounds that page and simulator both read or both reject (tests/sim/playground/test_declarations.py). */
const CASES = JSON.parse(readFileSync(new URL("../data/web/playground_cases.json", import.meta.url), "utf8"));

test("every declared shape of the simulator has a drawing of its own", () => {
  assert.deepEqual(shapeKinds().filter((kind) => !kind.isExact({})), []);
  assert.deepEqual(shapeKinds().map(({ name }) => name), Object.keys(BUILT_IN.shapes));
});

/** With lengths in nanometers, and without images. @param {import("../../web_ui/playground/primitives.js").Primitive[]} primitives */
const rounded = (primitives) =>
  JSON.parse(
    JSON.stringify(
      primitives.filter(({ type }) => type !== "print"),
      (_key, value) => (typeof value === "number" ? Math.round(value * 1e9) / 1e9 + 0 : value),
    ),
  );

for (const kind of shapeKinds()) {
  test(`a ${kind.name} is drawn of the primitives that the simulator makes of it`, () => {
    const values = valuesOf({ name: "x", ...kind.sample, kind: kind.name });
    assert.deepEqual(rounded(kind.draw(values)), rounded(BUILT_IN.shapes[kind.name].primitives));
  });
}

test("the names of fields say how a kind is placed", () => {
  /** @param {string} name */
  const placed = (name) => {
    const { points, path, isRelative, placement } = /** @type {import("../../web_ui/playground/kinds/index.js").Kind} */ (kindNamed(name));
    return { points: points.length, path, isRelative, placement };
  };
  assert.deepEqual(placed("box"), { points: 1, path: undefined, isRelative: true, placement: "center" });
  assert.deepEqual(placed("door"), { points: 2, path: undefined, isRelative: true, placement: "center" });
  assert.deepEqual(placed("wall"), { points: 2, path: undefined, isRelative: true, placement: "ends" });
  assert.deepEqual(placed("track"), { points: 0, path: "points_m", isRelative: false, placement: "path" });
  assert.deepEqual(placed("activation"), { points: 1, path: "area_m", isRelative: true, placement: "center" });
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
])) {
  test(`${what} is rejected with its location`, () => {
    assert.throws(
      () => parse(given),
      (error) => error instanceof Fault && error.key === key && error.expected.word === word,
    );
  });
}

for (const { name, playground, key, word } of CASES) {
  test(`${name} is ${key === null ? "read" : "rejected with its location"}`, () => {
    const given = JSON.stringify({ format: 1, ...playground });
    if (key === null) assert.equal(parse(given).items.length > 0, true);
    else
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
  assert.ok(ROBOT.fields.name.required);
  assert.equal(partsOf({ kind: "robot", name: "a", x_m: 0, y_m: 0 }).footprints.length, 1);
});
