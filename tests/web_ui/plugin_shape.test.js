import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { CreatorModel } from "../../web_ui/creator/creator_model.js";
import { newPlayground } from "../../web_ui/creator/commands.js";
import { Labels } from "../../web_ui/playground/labels.js";
import WORDS from "../../web_ui/i18n/creator.texts.js";
import { translator } from "../../web_ui/i18n/index.js";
import { BUILT_IN, fetchShapes } from "../../web_ui/playground/declarations.js";
import { parse, write } from "../../web_ui/playground/document.js";
import { kindNamed, registerShapes, shapeKinds } from "../../web_ui/playground/kinds/index.js";
import { learnParts, outlinesOf, partsOf } from "../../web_ui/playground/parts.js";
import { findProblem } from "../../web_ui/playground/validation.js";
import { recorded } from "./creator_support.js";

/** The shape of docs/plugins.md, as the page's server declares it (tests/test_plugin_page.py). */
const SLALOM = JSON.parse(readFileSync(new URL("../data/web/slalom.json", import.meta.url), "utf8"));
const TUNNEL = {
  group: "object",
  fields: { ...BUILT_IN.shapes.wall.fields, width_m: BUILT_IN.shapes.track.fields.width_m },
  sample: { ...BUILT_IN.shapes.wall.sample, width_m: 0.2 },
  primitives: [],
  labels: {},
  field_labels: {},
};
const RIVER = {
  group: "paint",
  fields: { course_m: BUILT_IN.shapes.track.fields.points_m, depth_m: BUILT_IN.shapes.box.fields.height_m },
  sample: { course_m: [[0, 0], [0.1, 0]], depth_m: 0.1 }, // prettier-ignore
  primitives: [],
  labels: { fr: "Fleuve" },
  field_labels: {},
};
registerShapes(/** @type {any} */ ({ slalom: SLALOM, tunnel: TUNNEL, river: RIVER }));

function prepared() {
  /** @type {import("../../web_ui/playground/rules.js").Phrase[]} */ const reported = [];
  const model = new CreatorModel({
    playground: newPlayground("Mine"),
    report: (phrase) => reported.push(phrase),
    changed: () => {},
  });
  /** @param {number} x @param {number} y */
  const click = (x, y) => {
    model.placing?.hover([x, y], false);
    model.placing?.put();
  };
  /** @param {string} name */
  const item = (name) => model.playground.items.find((one) => one.name === name);
  return { model, reported, click, item };
}

test("a shape of a plug-in is placed, moved, turned where it can be, edited, and saved", () => {
  const { model, click, item } = prepared();
  model.choose("slalom");
  click(-0.4, 0.3);
  model.choose(null);
  assert.deepEqual(item("slalom_1"), {
    kind: "slalom",
    name: "slalom_1",
    x_m: -0.4,
    y_m: 0.3,
    length_m: 1,
  });
  model.select("slalom_1");
  model.nudge(1, 0);
  assert.equal(item("slalom_1")?.x_m, -0.35);
  assert.equal(model.edit({ gap_m: 0.5, color: "#00ff00" }), null);
  const problem = model.edit({ gap_m: 0 });
  const german = new Labels("de", translator("de", WORDS));
  assert.equal(problem === null ? "" : german.text(problem), "Abstand muss von 0.1 bis 10000 cm sein.");
  const saved = JSON.parse(write(parse(write(model.playground))));
  assert.deepEqual(saved.shapes[1], {
    kind: "slalom",
    name: "slalom_1",
    x_m: -0.35,
    y_m: 0.3,
    length_m: 1,
    gap_m: 0.5,
    color: "#00ff00",
  });
});

test("fields of a plug-in are checked when a file is read", () => {
  const shape = { kind: "slalom", x_m: 0, y_m: 0, length_m: "long" };
  assert.throws(() => parse(JSON.stringify({ format: 1, title: "t", shapes: [shape] })), /shapes\[0\].length_m/);
});

test("the sample is drawn as the simulator builds it, at the pose of the item, also in another color", () => {
  const posts = { kind: "slalom", name: "s", x_m: 1, y_m: 2, length_m: 1 };
  const { isExact, footprints } = partsOf(posts);
  const { primitives } = partsOf({ ...posts, color: "#00ff00" });
  assert.ok(isExact);
  assert.equal(footprints.length, 5);
  assert.deepEqual(
    primitives.map((part) => part.type === "solid" && [part.pose.x, part.pose.y, part.radius, part.color]),
    [0, 0.25, 0.5, 0.75, 1].map((x) => [1 + x, 2, 0.01, "#00ff00"]),
  );
  const robot = { kind: "robot", name: "r", x_m: 1, y_m: 2 };
  assert.equal(findProblem([posts], robot)?.word, "problem.blocked");
});

test("other values are stretched posts, which are in nothing's way, until the simulator has answered", async () => {
  const posts = { kind: "slalom", name: "s", x_m: 1, y_m: 2, length_m: 2, height_m: 0.3 };
  const robot = { kind: "robot", name: "r", x_m: 1, y_m: 2 };
  const places = () => partsOf(posts).primitives.map((part) => part.type === "solid" && [part.pose.x, part.radius, part.height]);
  assert.ok(!partsOf(posts).isExact);
  assert.deepEqual(places(), [0, 0.5, 1, 1.5, 2].map((x) => [1 + x, 0.02, 0.3]));
  assert.equal(findProblem([posts], robot), null);
  await learnParts([posts], recorded);
  assert.ok(partsOf(posts).isExact);
  assert.deepEqual(places(), Array.from({ length: 9 }, (_, index) => [1 + index / 4, 0.01, 0.3]));
  assert.equal(findProblem([posts], robot)?.word, "problem.blocked");
});

test("a shape with two ends is placed by two clicks, and one with a path by any number", () => {
  const { model, click, item } = prepared();
  model.choose("tunnel");
  click(0.2, 0.2);
  click(0.2, 0.4);
  model.choose("river");
  for (const [x, y] of [[-0.4, -0.4], [0, -0.4], [0.4, -0.3]]) click(x, y); // prettier-ignore
  model.placing?.finish();
  assert.deepEqual([item("tunnel_1")?.start_y_m, item("tunnel_1")?.end_y_m], [0.2, 0.4]);
  assert.deepEqual(item("river_1")?.course_m, [[-0.4, -0.4], [0, -0.4], [0.4, -0.3]]); // prettier-ignore
  assert.equal(outlinesOf(/** @type {any} */ (item("river_1"))).length, 2);
});

test("names come from the declaration, from the page's texts, or from the key", () => {
  const german = new Labels("de", translator("de", WORDS));
  const french = new Labels("fr", translator("fr", WORDS));
  assert.equal(german.kind("slalom"), "Slalomstangen");
  assert.equal(french.help("slalom"), "Slalom posts");
  assert.equal(french.kind("river"), "Fleuve");
  assert.equal(german.kind("tunnel"), "Tunnel");
  assert.equal(german.field("slalom", "gap_m"), "Abstand");
  assert.equal(german.field("slalom", "height_m"), WORDS.de["field.height_m"]);
  assert.equal(german.field("river", "depth_m"), "Depth");
  assert.equal(german.text({ word: "form.new", values: { kind: "slalom" } }), WORDS.de["form.new"].replace("{kind}", "Slalomstangen"));
});

test("shapes come from the server if it declares this format", async () => {
  /** @param {any} answer */
  const server = (answer) => /** @type {any} */ (async () => ({ ok: true, json: async () => answer }));
  assert.deepEqual(Object.keys((await fetchShapes(server({ format: 1, shapes: { slalom: SLALOM } }))) ?? {}), ["slalom"]);
  assert.equal(await fetchShapes(server({ format: 2, shapes: {} })), null);
  assert.equal(await fetchShapes(/** @type {any} */ (async () => ({ ok: false }))), null);
  assert.equal(await fetchShapes(() => Promise.reject(new TypeError("no network"))), null);
  assert.equal(kindNamed("robot")?.group, "robot");
  assert.ok(shapeKinds().length > Object.keys(BUILT_IN.shapes).length);
});
