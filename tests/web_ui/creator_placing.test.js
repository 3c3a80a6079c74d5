// New items and tracks in the creator: where they can be placed, and how.

import assert from "node:assert/strict";
import { test } from "node:test";

import { sketchOf } from "../../web_ui/creator/sketch.js";
import { prepared } from "./creator_support.js";

test("a box is placed on the grid, repeatedly, until Escape", () => {
  const { model, click, names, item } = prepared();
  model.choose("box");
  click(0.26, 0.21);
  click(-0.31, 0.2, true);
  assert.deepEqual(names(), ["ground", "box_1", "box_2", "thymio"]);
  assert.deepEqual([item("box_1")?.x_m, item("box_2")?.x_m], [0.25, -0.31]);
  assert.ok(model.cancel());
  assert.equal(model.placing, null);
  assert.equal(model.cancel(), false);
});

test("nothing can be placed on a robot or outside the ground, and the reason is reported", () => {
  const { model, reported, click, names } = prepared();
  model.choose("cylinder");
  click(0, 0);
  assert.deepEqual(reported.at(-1), { word: "problem.blocked", values: { name: "thymio" } });
  click(0.7, 0);
  assert.deepEqual(reported.at(-1), { word: "problem.outside" });
  model.choose("robot");
  click(0.05, 0);
  assert.deepEqual(reported.at(-1), { word: "problem.blocked", values: { name: "thymio" } });
  assert.deepEqual(names(), ["ground", "thymio"]);
});

test("the ghost turns by steps, and the item is placed with its rotation", () => {
  const { model, click, item } = prepared();
  model.choose("box");
  model.turn(3);
  model.turn(-1, true);
  click(0.3, 0.3);
  assert.ok(Math.abs((item("box_1")?.yaw_rad ?? 0) - (44 * Math.PI) / 180) < 1e-9);
});

test("a track keeps all of its points, however it is finished", () => {
  const { model, click, item } = prepared();
  model.choose("track");
  for (const [x, y] of [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3]]) click(x, y); // prettier-ignore
  model.placing?.finish();
  for (const [x, y] of [[-0.3, 0.3], [0, 0.4], [0, 0.4]]) click(x, y); // prettier-ignore
  for (const [x, y] of [[-0.4, -0.4], [-0.2, -0.4], [-0.2, -0.2], [-0.4, -0.4]]) click(x, y); // prettier-ignore
  assert.deepEqual(item("track_1")?.points_m, [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3]]); // prettier-ignore
  assert.deepEqual(item("track_2")?.points_m, [[-0.3, 0.3], [0, 0.4]]); // prettier-ignore
  assert.equal(item("track_3")?.closed, true);
  assert.equal(item("track_3")?.points_m.length, 3);
});

test("while a track is drawn, undo removes its points and Escape the whole track", () => {
  const { model, click, names } = prepared();
  model.choose("track");
  click(0.1, 0.3);
  click(0.2, 0.3);
  model.undo();
  assert.equal(model.placing?.points.length, 1);
  model.redo();
  assert.equal(model.placing?.points.length, 2);
  model.cancel();
  assert.deepEqual(names(), ["ground", "thymio"]);
  assert.equal(model.history.past.length, 0);
});

test("a track of one point cannot be finished", () => {
  const { model, reported, click } = prepared();
  model.choose("track");
  click(0.1, 0.3);
  model.placing?.finish();
  assert.deepEqual(reported.at(-1), { word: "problem.twoPoints" });
});

test("the next wall starts where the last one ended", () => {
  const { model, click, item } = prepared();
  model.choose("wall");
  for (const [x, y] of [[-0.3, 0.2], [0.3, 0.2], [0.3, 0.4]]) click(x, y); // prettier-ignore
  assert.deepEqual([item("wall_1")?.end_x_m, item("wall_1")?.end_y_m], [0.3, 0.2]);
  assert.deepEqual([item("wall_2")?.start_x_m, item("wall_2")?.end_y_m], [0.3, 0.4]);
});

test("the overlay shows whether a position is free", () => {
  const { model } = prepared();
  model.choose("box");
  model.placing?.hover([0.3, 0.3], false);
  assert.deepEqual(new Set(sketchOf(model).areas.map(({ tone }) => tone)), new Set(["free"]));
  model.placing?.hover([0, 0], false);
  assert.deepEqual(new Set(sketchOf(model).areas.map(({ tone }) => tone)), new Set(["taken"]));
});

/** A session whose drafts are in memory, with what it reported; `again` starts the next visit. */

test("an image is as wide as the ground, and without a grid an inexact second click finishes a track", () => {
  const { model, click, item } = prepared();
  model.choose("picture", { image: "data:image/png;base64,AA==" });
  click(0, 0);
  assert.equal(item("picture_1")?.size_x_m, 1);
  model.choose("track");
  for (const [x, y] of [[0.1, 0.3], [0.3, 0.3], [0.302, 0.301]]) click(x, y, true); // prettier-ignore
  assert.deepEqual(item("track_1")?.points_m, [[0.1, 0.3], [0.3, 0.3]]); // prettier-ignore
});

test("a new item starts at a free position", () => {
  const { model } = prepared();
  model.choose("box");
  assert.deepEqual(model.placing?.place, [0.15, 0]);
  assert.equal(model.ghost?.problem, null);
});
