import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { parse, write } from "../../web_ui/playground/document.js";
import creatorTexts from "../../web_ui/i18n/creator.texts.js";
import { translator } from "../../web_ui/i18n/index.js";
import { containsPoint, overlap, placed, rectangle } from "../../web_ui/playground/geometry.js";
import { blockerOf, isOnGround, findProblem, problemsIn } from "../../web_ui/playground/validation.js";
import { kindNamed, ROBOT } from "../../web_ui/playground/kinds/index.js";
import { Labels } from "../../web_ui/playground/labels.js";
import { Markers } from "../../web_ui/playground/markers.js";
import { learnParts, partsOf, valuesOf } from "../../web_ui/playground/parts.js";
import { Fault } from "../../web_ui/playground/rules.js";
import { worldOf } from "../../web_ui/playground/world.js";
import { recorded } from "./creator_support.js";

const FOLDER = new URL("../../playgrounds/", import.meta.url);
/** Playgrounds that page and simulator both read or both reject (tests/sim/playground/test_declarations.py). */
const CASES = JSON.parse(readFileSync(new URL("../data/web/playground_cases.json", import.meta.url), "utf8"));

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

test("an item may not overlap a robot, but objects may overlap each other", async () => {
  await learnParts([{ ...BOX, yaw_rad: 0 }], recorded);
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

test("an item on a ground or on its edge is on the ground", async () => {
  const ground = { kind: "rectangle", name: "g", size_x_m: 1, size_y_m: 1, color: "#ffffff" };
  assert.equal(isOnGround([ground], { ...BOX, x_m: 0.51 }), true, "only the simulator knows");
  await learnParts([ground], recorded);
  assert.equal(isOnGround([ground], { ...BOX, x_m: 0.5 }), true);
  assert.equal(isOnGround([ground], { ...BOX, x_m: 0.51 }), false);
  assert.equal(isOnGround([], { ...BOX, x_m: 9 }), true);
});

test("unchanged items keep their markers", async () => {
  const markers = new Markers(() => null);
  const items = [{ kind: "rectangle", name: "g", size_x_m: 1, size_y_m: 1, color: "#ffffff", walls: {} }, BOX];
  await learnParts(items, recorded);
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

/** With lengths in nanometers. @param {Record<string, number>} pose */
const rounded = (pose) => Object.fromEntries(Object.entries(pose).map(([key, value]) => [key, Math.round(value * 1e9) / 1e9]));

/** A track around a corner. @param {number} radius */
const bend = (radius) => ({
  kind: "track", name: "line", points_m: [[0, 0], [1, 0], [1, 1]], width_m: 0.1, color: "#000000", corner_radius_m: radius,
}); // prettier-ignore

test("what the simulator refuses, and a robot in a shape, are problems of the playground once it has answered", async () => {
  const lines = [bend(0.2), bend(0.01), bend(2), { ...bend(0), points_m: [[0, 0], [0, 0]] }]; // prettier-ignore
  const items = [...lines, { ...BOX, size_x_m: 0.5, x_m: 0.3 }, { kind: "robot", name: "thymio", x_m: 0, y_m: 0 }];
  assert.deepEqual(problemsIn(items), []);
  await learnParts(items, async () => null);
  assert.deepEqual(problemsIn(items), []);
  await learnParts(items, recorded);
  const words = problemsIn(items).map(({ problem: { word, values } }) => values?.reason ?? word);
  assert.deepEqual(words, ["fault.radius", "fault.corners", "fault.places", "problem.blocked"]);
  const labels = new Labels("de", translator("de", creatorTexts));
  const field = labels.t("field.corner_radius_m");
  assert.equal(labels.text(problemsIn(items)[0].problem), labels.t("fault.radius", { field }));
  assert.ok(partsOf(lines[1]).primitives.length > 0, "its preview stays visible");
});

test("what is moved, or turned by its rotation, needs no answer; other values do, and are previewed until then", async () => {
  const wall = { kind: "wall", name: "w", start_x_m: 0.1, start_y_m: 0.2, end_x_m: 0.4, end_y_m: 0.2, color: "#112233" };
  await learnParts([BOX, wall, bend(0.2)], recorded);
  const line = { ...bend(0.2), points_m: bend(0.2).points_m.map(([x, y]) => [x + 0.1, y - 0.7]) };
  const known = [{ ...BOX, x_m: -0.7, y_m: 0.3, yaw_rad: 1.2 }, { ...wall, start_x_m: 0.7, end_x_m: 1 }, line];
  assert.ok(known.every((item) => partsOf(item).isExact));
  const poses = known.slice(0, 2).map((item) => rounded(/** @type {any} */ (partsOf(item).primitives[0]).pose));
  assert.deepEqual(poses, [{ x: -0.7, y: 0.3, yaw: 1.2 }, { x: 0.85, y: 0.2, yaw: 0 }]);
  const post = { kind: "cylinder", name: "c", x_m: 1, y_m: 0, radius_m: 0.2, height_m: 0.3, color: "#123456" };
  const others = [post, { ...BOX, color: "#445566" }, { ...wall, end_x_m: 0.5 }, { ...line, closed: true }];
  assert.ok(others.every((item) => !partsOf(item).isKnown && partsOf(item).primitives.length > 0));
  const preview = { type: "solid", pose: { x: 1, y: 0, yaw: 0 }, radius: 0.2, height: 0.3, color: "#123456" };
  assert.deepEqual(partsOf(post).primitives, [preview]);
  const moved = { ...bend(0.2), points_m: [[0, 0], [1, 0.1], [1, 1]] }; // prettier-ignore
  assert.deepEqual(partsOf(moved).primitives, partsOf(bend(0.2)).primitives, "rounded corners stay until the answer");
  await learnParts([moved], async () => null);
  assert.equal(partsOf(moved).primitives.length, 2, "strips, if there is none");
  const far = { ...wall, start_x_m: -100, end_x_m: 100 };
  const asked = kindNamed("wall")?.shape?.framed(valuesOf(far)).own;
  assert.deepEqual([asked?.start_x_m, asked?.end_x_m], [-100, 100], "no coordinate is 200 m");
});

test("a convex solid is drawn as the simulator's prism, and stands in the way as it is", async () => {
  const vertices = [[0, 0], [0.3, 0], [0, 0.3]]; // prettier-ignore
  const part = { type: "solid", pose: { x: 0, y: 0, yaw: 0 }, vertices, height: 0.1, color: "#112233" };
  const prism = { ...BOX, size_x_m: 0.3, size_y_m: 0.3 };
  await learnParts([prism, prism], async (shapes) => JSON.stringify(JSON.parse(shapes).map(() => ({ primitives: [part] }))));
  const marker = new Markers(() => null).of([prism]).get("solid/crate/1");
  assert.deepEqual([marker?.points.length, marker?.pose.position.z], [3 + 3 * 6, 0.05]);
  assert.equal(overlap(partsOf(prism).footprints[0], { middle: [0.25, 0.25], radius: 0.05 }), false);
});
