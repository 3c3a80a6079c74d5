// Snapping, units, undo, names, the wheel, and other small tools of the creator.

import assert from "node:assert/strict";
import { test } from "node:test";

import { freeName, newPlayground } from "../../web_ui/creator/commands.js";
import { History } from "../../web_ui/creator/history.js";
import { middleOf, moved, pointsOf, turned, withPoint } from "../../web_ui/creator/place.js";
import { rounded, snapped } from "../../web_ui/creator/snap.js";
import { toDisplay, toFile } from "../../web_ui/playground/units.js";
import { WheelSteps } from "../../web_ui/creator/wheel.js";
import { placeOver } from "../../web_ui/creator/context_bar.js";
import { slidingWord } from "../../web_ui/creator/load.js";
import { prepared } from "./creator_support.js";

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
