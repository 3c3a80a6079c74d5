import assert from "node:assert/strict";
import { test } from "node:test";

import { Builder } from "../../web_ui/creator/builder.js";
import { freeName, grounded, groundOf, newPlayground, withGround } from "../../web_ui/creator/commands.js";
import { History } from "../../web_ui/creator/history.js";
import { canTurn, middleOf, moved, pointsOf, turned, withPoint } from "../../web_ui/creator/place.js";
import { sketchOf } from "../../web_ui/creator/sketch.js";
import { rounded, snapped } from "../../web_ui/creator/snap.js";
import { shown, taken } from "../../web_ui/creator/units.js";
import { WheelSteps } from "../../web_ui/creator/wheel.js";
import { WORDS } from "../../web_ui/creator/words/index.js";
import { Workshop } from "../../web_ui/creator/workshop.js";
import { parse, write } from "../../web_ui/playground/document.js";
import { lacksGround, offGround } from "../../web_ui/playground/judge.js";
import { SHAPES } from "../../web_ui/playground/kinds/index.js";

/** Straight down. @param {number} x @param {number} y */
const down = (x, y) => ({ origin: { x, y, z: 1 }, direction: { x: 0, y: 0, z: -1 } });

/** A builder on a new playground, with what it told. */
function prepared() {
  /** @type {import("../../web_ui/playground/rules.js").Phrase[]} */ const told = [];
  const builder = new Builder({
    playground: newPlayground("Mine"),
    tell: (phrase) => told.push(phrase),
    changed: () => {},
  });
  /** @param {number} x @param {number} y @param {boolean} [free] */
  const click = (x, y, free = false) => {
    builder.placing?.hover([x, y], free);
    builder.placing?.put();
  };
  const names = () => builder.playground.items.map(({ name }) => name);
  /** @param {string} name */
  const item = (name) => builder.playground.items.find((one) => one.name === name);
  return { builder, told, click, names, item };
}

test("places snap to lines, to the middles of fields, or not at all", () => {
  assert.deepEqual(snapped([0.123, -0.061], { size: 0.05, on: "lines" }), [0.1, -0.05]);
  assert.deepEqual(snapped([0.123, -0.061], { size: 0.05, on: "centres" }), [0.125, -0.075]);
  assert.deepEqual(snapped([0.123, -0.061], null), [0.123, -0.061]);
  assert.ok(Object.is(rounded(-1e-9), 0));
});

test("numbers are real numbers with their units", () => {
  assert.equal(taken(0.5, "m"), 0.005);
  assert.equal(taken(1.5, "kg"), 0.0015);
  assert.equal(shown(0.123456, "m"), 12.3456);
  assert.equal(shown(taken(37.5, "rad"), "rad"), 37.5);
});

test("what was done is undone and done again in its order, and a new step forgets what was undone", () => {
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

test("steps of one series are one step until something comes between", () => {
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

test("a box is put down on the grid, several times, until Escape", () => {
  const { builder, click, names, item } = prepared();
  builder.choose("box");
  click(0.26, 0.21);
  click(-0.31, 0.2, true);
  assert.deepEqual(names(), ["ground", "box_1", "box_2", "thymio"]);
  assert.deepEqual([item("box_1")?.x_m, item("box_2")?.x_m], [0.25, -0.31]);
  assert.ok(builder.cancel());
  assert.equal(builder.placing, null);
  assert.equal(builder.cancel(), false);
});

test("nothing is put down on a robot or outside the ground, and it is said why", () => {
  const { builder, told, click, names } = prepared();
  builder.choose("cylinder");
  click(0, 0);
  assert.deepEqual(told.at(-1), { word: "problem.taken", values: { name: "thymio" } });
  click(0.7, 0);
  assert.deepEqual(told.at(-1), { word: "problem.outside" });
  builder.choose("robot");
  click(0.05, 0);
  assert.deepEqual(told.at(-1), { word: "problem.taken", values: { name: "thymio" } });
  assert.deepEqual(names(), ["ground", "thymio"]);
});

test("the ghost is turned by steps, and what is put down is turned as it was", () => {
  const { builder, click, item } = prepared();
  builder.choose("box");
  builder.turn(3);
  builder.turn(-1, true);
  click(0.3, 0.3);
  assert.ok(Math.abs((item("box_1")?.yaw_rad ?? 0) - (44 * Math.PI) / 180) < 1e-9);
});

test("a track keeps all of its points, however it is ended", () => {
  const { builder, click, item } = prepared();
  builder.choose("track");
  for (const [x, y] of [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3]]) click(x, y); // prettier-ignore
  builder.placing?.finish();
  for (const [x, y] of [[-0.3, 0.3], [0, 0.4], [0, 0.4]]) click(x, y); // prettier-ignore
  for (const [x, y] of [[-0.4, -0.4], [-0.2, -0.4], [-0.2, -0.2], [-0.4, -0.4]]) click(x, y); // prettier-ignore
  assert.deepEqual(item("track_1")?.points_m, [[-0.3, -0.3], [0.3, -0.3], [0.3, 0.3]]); // prettier-ignore
  assert.deepEqual(item("track_2")?.points_m, [[-0.3, 0.3], [0, 0.4]]); // prettier-ignore
  assert.equal(item("track_3")?.closed, true);
  assert.equal(item("track_3")?.points_m.length, 3);
});

test("while a track is drawn undo takes back its points, and Escape all of it", () => {
  const { builder, click, names } = prepared();
  builder.choose("track");
  click(0.1, 0.3);
  click(0.2, 0.3);
  builder.undo();
  assert.equal(builder.placing?.points.length, 1);
  builder.redo();
  assert.equal(builder.placing?.points.length, 2);
  builder.cancel();
  assert.deepEqual(names(), ["ground", "thymio"]);
  assert.equal(builder.history.past.length, 0);
});

test("a track of one point is not ended", () => {
  const { builder, told, click } = prepared();
  builder.choose("track");
  click(0.1, 0.3);
  builder.placing?.finish();
  assert.deepEqual(told.at(-1), { word: "problem.twoPoints" });
});

test("walls go on from where the last one ended", () => {
  const { builder, click, item } = prepared();
  builder.choose("wall");
  for (const [x, y] of [[-0.3, 0.2], [0.3, 0.2], [0.3, 0.4]]) click(x, y); // prettier-ignore
  assert.deepEqual([item("wall_1")?.end_x_m, item("wall_1")?.end_y_m], [0.3, 0.2]);
  assert.deepEqual([item("wall_2")?.start_x_m, item("wall_2")?.end_y_m], [0.3, 0.4]);
});

test("every kind can be put down, moved, turned, copied and removed, and all of it undone to the beginning", () => {
  for (const { name: kind } of SHAPES) {
    const { builder, click, names, item } = prepared();
    const start = builder.playground;
    if (kind === "activation") {
      builder.choose("door");
      click(-0.3, 0.3);
    }
    builder.choose(kind, kind === "picture" ? { image: "data:image/png;base64,AA==" } : {});
    click(0.2, 0.25);
    if (kind === "track" || kind === "wall") click(0.2, 0.35);
    builder.placing?.finish();
    builder.choose(null);
    const name = `${kind}_1`;
    assert.ok(names().includes(name), kind);
    builder.select(name);
    const before = item(name);
    builder.nudge(-1, 0);
    assert.notEqual(item(name), before, kind);
    const placed = item(name);
    builder.turn(1);
    assert.equal(item(name) !== placed, placed !== undefined && canTurn(placed), kind);
    builder.duplicate();
    assert.equal(builder.selected, `${kind}_2`);
    builder.remove();
    assert.equal(builder.selected, null);
    while (builder.history.past.length > 0) builder.undo();
    assert.equal(builder.playground, start);
    while (builder.history.future.length > 0) builder.redo();
    assert.deepEqual(parse(write(builder.playground)).items, builder.playground.items);
  }
});

test("what stands is taken, carried on the grid, and put back where it cannot be", () => {
  const { builder, told, click, item } = prepared();
  builder.choose("box");
  click(0.3, 0.3);
  builder.choose(null);
  assert.equal(builder.selecting.grab(down(0.31, 0.31)), true);
  builder.selecting.drag(down(0.22, 0.31), false);
  assert.equal(builder.ghost?.item.x_m, 0.2);
  builder.selecting.drop();
  assert.equal(item("box_1")?.x_m, 0.2);
  builder.selecting.grab(down(0.2, 0.3));
  builder.selecting.drag(down(0, 0), false);
  assert.equal(builder.ghost?.problem?.word, "problem.taken");
  builder.selecting.drop();
  assert.equal(told.at(-1)?.word, "problem.taken");
  assert.equal(item("box_1")?.x_m, 0.2);
});

test("the ring turns, points are moved one by one, and the ground only by its knob", () => {
  const { builder, click, item } = prepared();
  builder.choose("box");
  click(0.3, 0.3);
  builder.select("box_1");
  const radius = Math.hypot(0.05, 0.05) + 0.03;
  assert.ok(builder.selecting.grab(down(0.3 + radius, 0.3)));
  builder.selecting.drag(down(0.3, 0.3 + radius), false);
  builder.selecting.drop();
  assert.ok(Math.abs((item("box_1")?.yaw_rad ?? 0) - Math.PI / 2) < 1e-9);
  builder.choose("track");
  click(-0.4, -0.3);
  click(0.4, -0.3);
  builder.placing?.finish();
  builder.select("track_1");
  assert.ok(builder.selecting.grab(down(0.4, -0.3)));
  builder.selecting.drag(down(0.4, -0.4), false);
  builder.selecting.drop();
  assert.deepEqual(item("track_1")?.points_m, [[-0.4, -0.3], [0.4, -0.4]]); // prettier-ignore
  builder.select(null);
  assert.equal(builder.selecting.grab(down(-0.2, 0.2)), false);
  builder.selecting.click(down(-0.2, 0.2));
  assert.equal(builder.selected, "ground");
});

test("values are changed by numbers, and refused with a reason", () => {
  const { builder, click, item } = prepared();
  builder.choose("box");
  click(0.3, 0.3);
  builder.select("box_1");
  assert.equal(builder.edit({ size_x_m: 0.05, mass_kg: 0.2 }), null);
  assert.equal(item("box_1")?.mass_kg, 0.2);
  assert.equal(builder.edit({ name: "thymio" })?.word, "problem.name");
  assert.equal(builder.edit({ name: "a b" })?.word, "problem.value");
  assert.equal(builder.edit({ x_m: 0, y_m: 0 })?.word, "problem.taken");
  assert.equal(builder.edit({ x_m: 3 })?.word, "problem.outside");
  assert.equal(builder.edit({ name: "crate" }), null);
  assert.equal(builder.selected, "crate");
});

test("a door keeps its plates by another name, and takes them with it when it goes", () => {
  const { builder, told, click, item, names } = prepared();
  builder.choose("activation");
  assert.equal(told.at(-1)?.word, "problem.noDoor");
  builder.choose("door");
  click(-0.3, 0.3);
  builder.choose("activation");
  click(-0.3, -0.3);
  builder.select("door_1");
  builder.edit({ name: "gate" });
  assert.equal(item("activation_1")?.door, "gate");
  builder.remove();
  assert.deepEqual(names(), ["ground", "thymio"]);
});

test("the ground becomes an octagon and back, or none, and keeps colour and walls", () => {
  const { builder } = prepared();
  const octagon = groundOf(grounded(builder.playground, "octagon"));
  assert.equal(octagon?.kind, "octagon");
  assert.equal(octagon?.walls.color, "#7c8b9a");
  const back = groundOf(grounded(grounded(builder.playground, "octagon"), "rectangle"));
  assert.ok(Math.abs(back?.size_x_m - 1) < 0.002);
  assert.equal(groundOf(grounded(builder.playground, "none")), null);
});

test("names are free ones", () => {
  const playground = newPlayground("Mine");
  assert.equal(freeName(playground, "thymio"), "thymio_1");
  assert.equal(freeName(playground, "box"), "box_1");
  assert.equal(freeName(playground, "crate"), "crate");
});

test("moving and turning keep what they should", () => {
  const wall = { kind: "wall", name: "w", start_x_m: 0, start_y_m: 0, end_x_m: 0.4, end_y_m: 0, color: "#000000" };
  assert.deepEqual(middleOf(wall), [0.2, 0]);
  assert.deepEqual(pointsOf(turned(wall, Math.PI / 2)), [[0.2, -0.2], [0.2, 0.2]]); // prettier-ignore
  assert.deepEqual(pointsOf(moved(wall, 0.1, 0.2)), [[0.1, 0.2], [0.5, 0.2]]); // prettier-ignore
  assert.deepEqual(pointsOf(withPoint(wall, 1, [0.3, 0.3]))[1], [0.3, 0.3]);
});

test("what is drawn over it says whether a place is free", () => {
  const { builder } = prepared();
  builder.choose("box");
  builder.placing?.hover([0.3, 0.3], false);
  assert.deepEqual(new Set(sketchOf(builder).areas.map(({ tone }) => tone)), new Set(["free"]));
  builder.placing?.hover([0, 0], false);
  assert.deepEqual(new Set(sketchOf(builder).areas.map(({ tone }) => tone)), new Set(["taken"]));
});

test("the draft is kept by the browser and there again; without room it is said", () => {
  /** @type {Map<string, string>} */ const kept = new Map();
  const shelf = {
    getItem: (/** @type {string} */ key) => kept.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ value) => void kept.set(key, value),
    removeItem: (/** @type {string} */ key) => void kept.delete(key),
  };
  /** @type {string[]} */ const told = [];
  const options = { shelf, title: "Mine", tell: (/** @type {any} */ { word }) => told.push(word), changed: () => {} };
  const workshop = new Workshop(options);
  assert.equal(workshop.isUnsaved, false);
  workshop.builder.choose("box");
  workshop.builder.placing?.hover([0.3, 0.3], false);
  workshop.builder.placing?.put();
  workshop.keep();
  const again = new Workshop(options);
  assert.deepEqual(again.builder.playground.items, workshop.builder.playground.items);
  assert.equal(again.isUnsaved, true);
  assert.equal(again.fileName, "Mine.json");
  shelf.setItem = () => {
    throw new Error("full");
  };
  again.builder.undo();
  again.take(newPlayground("Ünser Feld!"), { word: "did.new" });
  again.keep();
  assert.equal(told.at(-1), "tell.noDraft");
  assert.equal(again.fileName, "Unser_Feld.json");
  again.builder.undo();
  assert.ok(again.builder.playground.items.some(({ name }) => name === "box_1"));
  clearTimeout(again.timer);
  clearTimeout(workshop.timer);
});

test("the creator has every word in every language, with the same values", () => {
  /** @param {string} text */
  const values = (text) => [...text.matchAll(/\{\w+\}/g)].map(([name]) => name).sort();
  for (const table of Object.values(WORDS)) {
    assert.deepEqual(Object.keys(table), Object.keys(WORDS.en));
    for (const [key, text] of Object.entries(WORDS.en)) assert.deepEqual(values(table[key]), values(text), key);
  }
  for (const { name, fields } of SHAPES) {
    assert.ok(`kind.${name}` in WORDS.en && `tool.${name}` in WORDS.en, name);
    for (const key of Object.keys(fields)) assert.ok(`field.${key}` in WORDS.en, key);
  }
});

test("a picture is as wide as the ground, and without a grid a shaky second click ends a track", () => {
  const { builder, click, item } = prepared();
  builder.choose("picture", { image: "data:image/png;base64,AA==" });
  click(0, 0);
  assert.equal(item("picture_1")?.size_x_m, 1);
  builder.choose("track");
  for (const [x, y] of [[0.1, 0.3], [0.3, 0.3], [0.302, 0.301]]) click(x, y, true); // prettier-ignore
  assert.deepEqual(item("track_1")?.points_m, [[0.1, 0.3], [0.3, 0.3]]); // prettier-ignore
});

test("what is taken in hand begins where there is room", () => {
  const { builder } = prepared();
  builder.choose("box");
  assert.deepEqual(builder.placing?.place, [0.15, 0]);
  assert.equal(builder.ghost?.problem, null);
});

test("what a smaller ground leaves outside is told, and can still be changed", () => {
  const { builder, click, item } = prepared();
  builder.choose("box");
  click(0.4, 0.4);
  builder.select("ground");
  assert.equal(builder.edit({ size_x_m: 0.5 }), null);
  assert.deepEqual(
    offGround(builder.playground.items).map(({ name }) => name),
    ["box_1"],
  );
  builder.select("box_1");
  assert.equal(builder.edit({ height_m: 0.2 }), null);
  assert.equal(item("box_1")?.height_m, 0.2);
});

test("while only the pointer moves the world that is drawn stays the same", () => {
  const shelf = { getItem: () => null, setItem: () => {}, removeItem: () => {} };
  const workshop = new Workshop({ shelf, title: "Mine", tell: () => {}, changed: () => {} });
  workshop.builder.choose("box");
  const { world, sketch } = workshop;
  workshop.builder.placing?.hover([0.3, 0.3], false);
  workshop.builder.changed();
  assert.equal(workshop.world, world);
  assert.notEqual(workshop.sketch, sketch);
  workshop.builder.placing?.put();
  assert.notEqual(workshop.world, world);
  clearTimeout(workshop.timer);
});

test("a notch of any mouse is one step, and a touchpad's way adds up", () => {
  const notches = [
    { deltaY: 120, deltaMode: 0 },
    { deltaY: 100, deltaMode: 0 },
    { deltaY: 66.7, deltaMode: 0 }, // the page is at 150 %
    { deltaY: 3, deltaMode: 1 },
    { deltaY: 1, deltaMode: 2 },
  ];
  for (const notch of notches) {
    const wheel = new WheelSteps();
    assert.deepEqual([1, 2, 3].map(() => wheel.take(notch)), [1, 1, 1]);
    assert.equal(wheel.take({ ...notch, deltaY: -notch.deltaY }), -1);
  }
  assert.equal(new WheelSteps().take({ deltaY: 240, deltaMode: 0 }), 2);
  const pad = new WheelSteps();
  const steps = Array.from({ length: 60 }, () => pad.take({ deltaY: 4, deltaMode: 0 }));
  assert.equal(steps.reduce((sum, one) => sum + one, 0), 2);
});

test("a playground without any ground gets one under all that stands there", () => {
  const bare = grounded(newPlayground("Mine"), "none");
  assert.ok(lacksGround(bare.items));
  assert.ok(!lacksGround(newPlayground("Mine").items));
  assert.ok(!lacksGround([...bare.items, { kind: "of_a_plugin", name: "sand" }]));
  const far = { ...bare, items: [...bare.items, { kind: "robot", name: "other", x_m: 2, y_m: -0.5 }] };
  const whole = withGround(far);
  assert.ok(!lacksGround(whole.items));
  assert.deepEqual(offGround(whole.items), []);
  parse(write(whole));
});

test("what was saved is saved after a reload too, and what is as in the file counts as saved", () => {
  /** @type {Map<string, string>} */ const kept = new Map();
  const shelf = {
    getItem: (/** @type {string} */ key) => kept.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ value) => void kept.set(key, value),
    removeItem: (/** @type {string} */ key) => void kept.delete(key),
  };
  const options = { shelf, title: "Mine", tell: () => {}, changed: () => {} };
  const workshop = new Workshop(options);
  const titled = (/** @type {Workshop} */ one, /** @type {string} */ title) =>
    one.builder.become({ ...one.builder.playground, title }, { word: "did.titled" });
  titled(workshop, "Yours");
  workshop.keep();
  assert.equal(new Workshop(options).isUnsaved, true);
  workshop.noteSaved();
  assert.equal(new Workshop(options).isUnsaved, false);
  titled(workshop, "Ours");
  assert.equal(workshop.isUnsaved, true);
  titled(workshop, "Yours");
  assert.equal(workshop.isUnsaved, false);
  workshop.keep();
  assert.equal(new Workshop(options).isUnsaved, false);
});
