import assert from "node:assert/strict";
import { test } from "node:test";

import { CreatorModel } from "../../web_ui/creator/creator_model.js";
import { freeName, grounded, groundOf, newPlayground, withGround } from "../../web_ui/creator/commands.js";
import { History } from "../../web_ui/creator/history.js";
import { canTurn, middleOf, moved, pointsOf, turned, withPoint } from "../../web_ui/creator/place.js";
import { sketchOf } from "../../web_ui/creator/sketch.js";
import { rounded, snapped } from "../../web_ui/creator/snap.js";
import { toDisplay, toFile } from "../../web_ui/creator/units.js";
import { WheelSteps } from "../../web_ui/creator/wheel.js";
import creatorTexts from "../../web_ui/i18n/creator.texts.js";
import { placeOver } from "../../web_ui/creator/context_bar.js";
import { CreatorSession } from "../../web_ui/creator/creator_session.js";
import { slidingWord } from "../../web_ui/creator/load.js";
import { Drafts } from "../../web_ui/playground_tab/drafts.js";
import { parse, write } from "../../web_ui/playground/document.js";
import { lacksGround, itemsOffGround } from "../../web_ui/playground/validation.js";
import { shapeKinds } from "../../web_ui/playground/kinds/index.js";

/** Straight down. @param {number} x @param {number} y */
const down = (x, y) => ({ origin: { x, y, z: 1 }, direction: { x: 0, y: 0, z: -1 } });

/** A browser's storage in memory. */
function newStorage() {
  /** @type {Map<string, string>} */ const kept = new Map();
  return {
    getItem: (/** @type {string} */ key) => kept.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ value) => void kept.set(key, value),
    removeItem: (/** @type {string} */ key) => void kept.delete(key),
  };
}

/** A model on a new playground, with what it reported. */
function prepared() {
  /** @type {import("../../web_ui/playground/rules.js").Phrase[]} */ const reported = [];
  const model = new CreatorModel({
    playground: newPlayground("Mine"),
    report: (phrase) => reported.push(phrase),
    changed: () => {},
  });
  /** @param {number} x @param {number} y @param {boolean} [free] */
  const click = (x, y, free = false) => {
    model.placing?.hover([x, y], free);
    model.placing?.put();
  };
  const names = () => model.playground.items.map(({ name }) => name);
  /** @param {string} name */
  const item = (name) => model.playground.items.find((one) => one.name === name);
  return { model, reported, click, names, item };
}

test("points snap to lines, to cell centers, or not at all", () => {
  assert.deepEqual(snapped([0.123, -0.061], { size: 0.05, on: "lines" }), [0.1, -0.05]);
  assert.deepEqual(snapped([0.123, -0.061], { size: 0.05, on: "centers" }), [0.125, -0.075]);
  assert.deepEqual(snapped([0.123, -0.061], null), [0.123, -0.061]);
  assert.ok(Object.is(rounded(-1e-9), 0));
});

test("numbers are converted between units", () => {
  assert.equal(toFile(0.5, "m"), 0.005);
  assert.equal(toFile(1.5, "kg"), 0.0015);
  assert.equal(toDisplay(0.123456, "m"), 12.3456);
  assert.equal(toDisplay(toFile(37.5, "rad"), "rad"), 37.5);
});

test("steps are undone and redone in order, and a new step discards undone ones", () => {
  const [one, two, three] = ["1", "2", "3"].map(newPlayground);
  const history = new History(one);
  history.do(two, { word: "a" });
  history.do(three, { word: "b" });
  assert.equal(history.undo()?.word, "b");
  assert.equal(history.undo()?.word, "a");
  assert.equal(history.undo(), null);
  assert.equal(history.redo()?.word, "a");
  assert.equal(history.present, two);
  history.do(one, { word: "c" });
  assert.equal(history.redo(), null);
});

test("consecutive steps of one series count as one", () => {
  const [one, two, three, four] = ["1", "2", "3", "4"].map(newPlayground);
  const history = new History(one);
  history.do(two, { word: "moved" }, "move box");
  history.do(three, { word: "moved" }, "move box");
  history.undo();
  assert.equal(history.present, one);
  history.redo();
  history.do(four, { word: "moved" }, "move box");
  history.undo();
  assert.equal(history.present, three);
});

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

test("values are edited as numbers, and rejected with a reason", () => {
  const { model, click, item } = prepared();
  model.choose("box");
  click(0.3, 0.3);
  model.select("box_1");
  assert.equal(model.edit({ size_x_m: 0.05, mass_kg: 0.2 }), null);
  assert.equal(item("box_1")?.mass_kg, 0.2);
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

test("new names are unused", () => {
  const playground = newPlayground("Mine");
  assert.equal(freeName(playground, "thymio"), "thymio_1");
  assert.equal(freeName(playground, "box"), "box_1");
  assert.equal(freeName(playground, "crate"), "crate");
});

test("moving and turning keep all other values", () => {
  const wall = { kind: "wall", name: "w", start_x_m: 0, start_y_m: 0, end_x_m: 0.4, end_y_m: 0, color: "#000000" };
  assert.deepEqual(middleOf(wall), [0.2, 0]);
  assert.deepEqual(pointsOf(turned(wall, Math.PI / 2)), [[0.2, -0.2], [0.2, 0.2]]); // prettier-ignore
  assert.deepEqual(pointsOf(moved(wall, 0.1, 0.2)), [[0.1, 0.2], [0.5, 0.2]]); // prettier-ignore
  assert.deepEqual(pointsOf(withPoint(wall, 1, [0.3, 0.3]))[1], [0.3, 0.3]);
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
function session(storage = newStorage()) {
  /** @type {string[]} */ const reported = [];
  const drafts = new Drafts(storage);
  const one = new CreatorSession({ drafts, title: "Mine", report: ({ word }) => void reported.push(word), changed: () => {} });
  const again = () => {
    const next = session(storage);
    const [draft] = next.drafts.list();
    if (draft === undefined) return next;
    const playground = { ...parse(next.drafts.read(draft.id) ?? ""), draft: draft.id };
    next.one.replacePlayground(playground, { word: "change.opened" }, draft.inFile);
    return next;
  };
  return { one, drafts, reported, storage, again };
}

/** @param {CreatorSession} one @param {string} title */
function titled(one, title) {
  one.model.replacePlayground({ ...one.model.playground, title }, { word: "change.titled" });
}

test("what is built is kept and restored; a full storage is reported", () => {
  const { one, storage, again } = session();
  assert.equal(one.kept, "fresh");
  one.model.choose("box");
  one.model.placing?.hover([0.3, 0.3], false);
  one.model.placing?.put();
  one.keep();
  assert.equal(one.kept, "device");
  const next = again();
  assert.deepEqual(next.one.model.playground.items, one.model.playground.items);
  assert.equal(next.one.kept, "device");
  assert.equal(next.one.fileName, "Mine.json");
  storage.setItem = () => {
    throw new Error("full");
  };
  titled(next.one, "Ünser Feld!");
  next.one.keep();
  assert.equal(next.reported.at(-1), "status.noDraft");
  assert.equal(next.one.kept, "none");
  assert.equal(next.one.fileName, "Unser_Feld.json");
  next.one.model.undo();
  assert.ok(next.one.model.playground.items.some(({ name }) => name === "box_1"));
  clearTimeout(next.one.timer);
  clearTimeout(one.timer);
});

test("each playground is a draft of its own, which undo finds again; what was only opened is not kept", () => {
  const { one, drafts } = session();
  titled(one, "First");
  one.replacePlayground(newPlayground("Second"), { word: "change.new" });
  assert.deepEqual(drafts.list().map(({ title }) => title), ["First"]);
  one.keep();
  assert.equal(drafts.list().length, 1);
  titled(one, "Third");
  one.keep();
  assert.deepEqual(drafts.list().map(({ title }) => title), ["Third", "First"]);
  one.model.undo();
  one.model.undo();
  titled(one, "First again");
  one.keep();
  assert.deepEqual(drafts.list().map(({ title }) => title), ["First again", "Third"]);
  clearTimeout(one.timer);
});

test("the creator has texts for every shape and its fields", () => {
  for (const { name, fields } of shapeKinds()) {
    assert.ok(`kind.${name}` in creatorTexts.en, name);
    for (const key of Object.keys(fields)) assert.ok(`field.${key}` in creatorTexts.en, key);
  }
});

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

test("items outside a smaller ground are reported, and can still be changed", () => {
  const { model, click, item } = prepared();
  model.choose("box");
  click(0.4, 0.4);
  model.select("ground");
  assert.equal(model.edit({ size_x_m: 0.5 }), null);
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

test("a notch of any mouse is one step, and touchpad distances are accumulated", () => {
  const notches = [
    { deltaY: 120, deltaMode: 0 },
    { deltaY: 100, deltaMode: 0 },
    { deltaY: 66.7, deltaMode: 0 }, // the page is at 150 %
    { deltaY: 3, deltaMode: 1 },
    { deltaY: 1, deltaMode: 2 },
  ];
  for (const notch of notches) {
    const wheel = new WheelSteps();
    assert.deepEqual([1, 2, 3].map(() => wheel.add(notch)), [1, 1, 1]);
    assert.equal(wheel.add({ ...notch, deltaY: -notch.deltaY }), -1);
  }
  assert.equal(new WheelSteps().add({ deltaY: 240, deltaMode: 0 }), 2);
  const pad = new WheelSteps();
  const steps = Array.from({ length: 60 }, () => pad.add({ deltaY: 4, deltaMode: 0 }));
  assert.equal(steps.reduce((sum, one) => sum + one, 0), 2);
});

test("a playground without ground gets one below all items", () => {
  const bare = grounded(newPlayground("Mine"), "none");
  assert.ok(lacksGround(bare.items));
  assert.ok(!lacksGround(newPlayground("Mine").items));
  assert.ok(!lacksGround([...bare.items, { kind: "of_a_plugin", name: "sand" }]));
  const far = { ...bare, items: [...bare.items, { kind: "robot", name: "other", x_m: 2, y_m: -0.5 }] };
  const whole = withGround(far);
  assert.ok(!lacksGround(whole.items));
  assert.deepEqual(itemsOffGround(whole.items), []);
  parse(write(whole));
});

test("the saved state survives a reload, and a playground equal to its file counts as saved", () => {
  const { one, again } = session();
  titled(one, "Yours");
  one.keep();
  assert.equal(again().one.kept, "device");
  one.noteSaved();
  assert.equal(again().one.kept, "file");
  titled(one, "Ours");
  assert.equal(one.kept, "device");
  titled(one, "Yours");
  assert.equal(one.kept, "file");
  one.keep();
  assert.equal(again().one.kept, "file");
});

test("nothing snaps to a grid that is off", () => {
  const { model, click, item } = prepared();
  model.setGrid({ isOff: true });
  model.choose("box");
  click(0.313, 0.207);
  assert.deepEqual([item("box_1")?.x_m, item("box_1")?.y_m], [0.313, 0.207]);
  model.setGrid({ size: 0.1, isOff: false });
  click(-0.313, 0.207);
  assert.deepEqual([item("box_2")?.x_m, item("box_2")?.y_m], [-0.3, 0.2]);
});

test("a sentence says how a thing can be pushed", () => {
  assert.equal(slidingWord({ mass_kg: null }), "field.movable.fixed");
  assert.equal(slidingWord({ mass_kg: 0.08, friction: 0.25 }), "field.movable.light");
  assert.equal(slidingWord({ mass_kg: 0.08, friction: 0.5 }), "field.movable.paper");
  assert.equal(slidingWord({ mass_kg: 0.08, friction: 0.7 }), "field.movable.heavy");
});

test("the bar of the selected item is over it, else below it, and always inside the scene", () => {
  const [bar, scene] = [{ width: 280, height: 50 }, { width: 600, height: 500 }];
  /** @param {number} x @param {number} y */
  const at = (x, y) => placeOver(bar, [{ x: x - 20, y: y - 30 }, { x: x + 20, y: y + 30 }], scene, 74);
  assert.deepEqual(at(300, 300), { x: 160, y: 208 });
  assert.deepEqual(at(300, 100), { x: 160, y: 142 }); // the views are above
  assert.deepEqual(at(20, 300), { x: 12, y: 208 });
  assert.deepEqual(at(590, 300), { x: 308, y: 208 });
  for (const y of [-100, 0, 250, 480, 700]) {
    const place = at(300, y);
    assert.ok(place.y >= 74 && place.y + bar.height <= scene.height, String(y));
  }
  const large = placeOver(bar, [{ x: 0, y: 0 }, { x: 600, y: 500 }], { width: 240, height: 100 }, 74);
  assert.deepEqual(large, { x: 12, y: 74 });
});
