// Changing items and the ground in the creator.

import assert from "node:assert/strict";
import { test } from "node:test";

import { grounded, groundOf, newPlayground, withGround } from "../../web_ui/creator/commands.js";
import { canTurn } from "../../web_ui/creator/place.js";
import { parse, write } from "../../web_ui/playground/document.js";
import { lacksGround, itemsOffGround } from "../../web_ui/playground/validation.js";
import { shapeKinds } from "../../web_ui/playground/kinds/index.js";
import { learnParts } from "../../web_ui/playground/parts.js";
import { down, prepared, recorded, session } from "./creator_support.js";

test("every kind can be placed, moved, turned, copied and removed, and all of it undone", () => {
  for (const { name: kind } of shapeKinds()) {
    const { model, click, names, item } = prepared();
    const start = model.playground;
    if (kind === "activation") {
      model.choose("door");
      click(-0.3, 0.3);
    }
    model.choose(kind, kind === "picture" ? { image: "data:image/png;base64,AA==" } : {});
    click(0.2, 0.25);
    if (kind === "track" || kind === "wall") click(0.2, 0.35);
    model.placing?.finish();
    model.choose(null);
    const name = `${kind}_1`;
    assert.ok(names().includes(name), kind);
    model.select(name);
    const before = item(name);
    model.nudge(-1, 0);
    assert.notEqual(item(name), before, kind);
    const placed = item(name);
    model.turn(1);
    assert.equal(item(name) !== placed, placed !== undefined && canTurn(placed), kind);
    model.selecting.duplicate();
    assert.equal(model.selected, `${kind}_2`);
    model.selecting.remove();
    assert.equal(model.selected, null);
    while (model.history.past.length > 0) model.undo();
    assert.equal(model.playground, start);
    while (model.history.future.length > 0) model.redo();
    assert.deepEqual(parse(write(model.playground)).items, model.playground.items);
  }
});

test("an item is dragged on the grid, and restored if the position is invalid", () => {
  const { model, reported, click, item } = prepared();
  model.choose("box");
  click(0.3, 0.3);
  model.choose(null);
  assert.equal(model.selecting.grab(down(0.31, 0.31)), true);
  model.selecting.drag(down(0.22, 0.31), false);
  assert.equal(model.ghost?.item.x_m, 0.2);
  model.selecting.drop();
  assert.equal(item("box_1")?.x_m, 0.2);
  model.selecting.grab(down(0.2, 0.3));
  model.selecting.drag(down(0, 0), false);
  assert.equal(model.ghost?.problem?.word, "problem.blocked");
  model.selecting.drop();
  assert.equal(reported.at(-1)?.word, "problem.blocked");
  assert.equal(item("box_1")?.x_m, 0.2);
});

test("the ring turns, points move one by one, and the ground moves by its knob only", () => {
  const { model, click, item } = prepared();
  model.choose("box");
  click(0.3, 0.3);
  model.select("box_1");
  const radius = Math.hypot(0.05, 0.05) + 0.03;
  assert.ok(model.selecting.grab(down(0.3 + radius, 0.3)));
  model.selecting.drag(down(0.3, 0.3 + radius), false);
  model.selecting.drop();
  assert.ok(Math.abs((item("box_1")?.yaw_rad ?? 0) - Math.PI / 2) < 1e-9);
  model.choose("track");
  click(-0.4, -0.3);
  click(0.4, -0.3);
  model.placing?.finish();
  model.select("track_1");
  assert.ok(model.selecting.grab(down(0.4, -0.3)));
  model.selecting.drag(down(0.4, -0.4), false);
  model.selecting.drop();
  assert.deepEqual(item("track_1")?.points_m, [[-0.4, -0.3], [0.4, -0.4]]); // prettier-ignore
  model.select(null);
  assert.equal(model.selecting.grab(down(-0.2, 0.2)), false);
  model.selecting.click(down(-0.2, 0.2));
  assert.equal(model.selected, "ground");
});

test("values are edited as numbers, and rejected with a reason", async () => {
  const { model, click, item } = prepared();
  model.choose("box");
  click(0.3, 0.3);
  model.select("box_1");
  assert.equal(model.edit({ size_x_m: 0.05, mass_kg: 0.2 }), null);
  assert.equal(item("box_1")?.mass_kg, 0.2);
  await learnParts(model.playground.items, recorded);
  assert.equal(model.edit({ name: "thymio" })?.word, "problem.name");
  assert.equal(model.edit({ name: "a b" })?.word, "problem.value");
  assert.equal(model.edit({ x_m: 0, y_m: 0 })?.word, "problem.blocked");
  assert.equal(model.edit({ x_m: 3 })?.word, "problem.outside");
  assert.equal(model.edit({ name: "crate" }), null);
  assert.equal(model.selected, "crate");
});

test("a renamed door keeps its plates, and a removed door removes them", () => {
  const { model, reported, click, item, names } = prepared();
  model.choose("activation");
  assert.equal(reported.at(-1)?.word, "problem.noDoor");
  model.choose("door");
  click(-0.3, 0.3);
  model.choose("activation");
  click(-0.3, -0.3);
  model.select("door_1");
  model.edit({ name: "gate" });
  assert.equal(item("activation_1")?.door, "gate");
  model.selecting.remove();
  assert.deepEqual(names(), ["ground", "thymio"]);
});

test("the ground becomes an octagon and back, or none, and keeps color and walls", () => {
  const { model } = prepared();
  const octagon = groundOf(grounded(model.playground, "octagon"));
  assert.equal(octagon?.kind, "octagon");
  assert.equal(octagon?.walls.color, "#7c8b9a");
  const back = groundOf(grounded(grounded(model.playground, "octagon"), "rectangle"));
  assert.ok(Math.abs(back?.size_x_m - 1) < 0.002);
  assert.equal(groundOf(grounded(model.playground, "none")), null);
});

test("items outside a smaller ground are reported, and can still be changed", async () => {
  const { model, click, item } = prepared();
  model.choose("box");
  click(0.4, 0.4);
  model.select("ground");
  assert.equal(model.edit({ size_x_m: 0.5 }), null);
  await learnParts(model.playground.items, recorded);
  assert.deepEqual(
    itemsOffGround(model.playground.items).map(({ name }) => name),
    ["box_1"],
  );
  model.select("box_1");
  assert.equal(model.edit({ height_m: 0.2 }), null);
  assert.equal(item("box_1")?.height_m, 0.2);
});

test("the drawn world stays the same object while only the pointer moves", () => {
  const { one } = session();
  one.model.choose("box");
  const { world, sketch } = one;
  one.model.placing?.hover([0.3, 0.3], false);
  one.model.changed();
  assert.equal(one.world, world);
  assert.notEqual(one.sketch, sketch);
  one.model.placing?.put();
  assert.notEqual(one.world, world);
  clearTimeout(one.timer);
});

test("a playground without ground gets one below all items", async () => {
  const bare = grounded(newPlayground("Mine"), "none");
  assert.ok(lacksGround(bare.items));
  assert.ok(!lacksGround(newPlayground("Mine").items));
  assert.ok(!lacksGround([...bare.items, { kind: "of_a_plugin", name: "sand" }]));
  const far = { ...bare, items: [...bare.items, { kind: "robot", name: "other", x_m: 2, y_m: -0.5 }] };
  const whole = withGround(far);
  assert.ok(!lacksGround(whole.items));
  await learnParts(whole.items, recorded);
  assert.deepEqual(itemsOffGround(whole.items), []);
  parse(write(whole));
});
