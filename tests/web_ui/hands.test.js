// What hands do to the robot: the counts of a hand before the sensors, the settings of each robot, and their keys.

import assert from "node:assert/strict";
import { test } from "node:test";

import { HAND_KEYS, handOfKey } from "../../web_ui/input/hand_keys.js";
import { watchKeyboard } from "../../web_ui/input/keyboard.js";
import { isLifted } from "../../web_ui/stage/hands/at_once.js";
import { handCounts, PLACES } from "../../web_ui/stage/hands/hand_counts.js";
import { HandSettings } from "../../web_ui/stage/hands/settings.js";
import { firstThatFits, NAMES } from "../../web_ui/ui/names_fit.js";

test("a hand is seen by the sensor behind it, less by those beside it, and not by the rear ones", () => {
  assert.deepEqual(handCounts("center", 1), [0, 1935, 4500, 1935, 0, -1, -1]);
  assert.deepEqual(handCounts("left", 0), [1200, 516, 0, 0, 0, -1, -1]);
  for (const place of PLACES) {
    const counts = handCounts(place, 0.7);
    assert.equal(Math.max(...counts), counts[PLACES.indexOf(place)]);
    assert.ok(counts.every((count) => count >= -1 && count <= 4505));
  }
});

test("without a hand all sensors measure what is there", () => {
  assert.deepEqual(handCounts(null, 0.7), []);
});

test("each robot keeps its settings, and all get them when all are addressed", () => {
  const store = { state: { selected: "a", toAll: false, robots: { a: {}, b: {} } } };
  const settings = new HandSettings(/** @type {any} */ (store), { near: 1, place: "none" });
  settings.change({ near: 2 });
  assert.deepEqual(settings.now, { near: 2, place: "none" });
  store.state.selected = "b";
  assert.deepEqual(settings.now, { near: 1, place: "none" });
  store.state.toAll = true;
  settings.change({ place: "left" });
  store.state.selected = "a";
  assert.deepEqual(settings.now, { near: 1, place: "left" });
});

test("a robot is in the hand while its pose is over the floor", () => {
  const at = (/** @type {number} */ z) => /** @type {any} */ ({ latest: { pose: { z } } });
  assert.deepEqual([at(0.06), at(0), at(-0.2), undefined].map(isLifted), [true, false, false, false]);
});

/** The keyboard of the view with everything it calls. @param {boolean} [moves] */
function keyboard(moves = false) {
  /** @type {Record<string, (event: any) => void>} */ const listeners = {};
  /** @type {any[]} */ const calls = [];
  const call = (/** @type {string} */ name) => (/** @type {any[]} */ ...values) => void calls.push([name, ...values]);
  const scene = { camera: { turn: call("turn") }, zoom: call("zoom"), setView: call("view"), setSensors: call("beams"), showSensors: true };
  const drag = { mode: moves, setMode: call("mode"), nudge: call("nudge"), drop: async () => {}, next: call("next") };
  const element = { addEventListener: (/** @type {string} */ name, /** @type {any} */ listener) => (listeners[name] = listener) };
  watchKeyboard(/** @type {any} */ (element), /** @type {any} */ (scene), /** @type {any} */ (drag), call("press"), {
    useHand: call("hand"),
    pause: call("pause"),
  });
  /** @param {string} key @param {object} [more] */
  const press = (key, more = {}) => {
    let isUsed = false;
    listeners.keydown({ key, shiftKey: false, repeat: false, preventDefault: () => (isUsed = true), stopPropagation() {}, ...more });
    return isUsed;
  };
  return { press, calls };
}

test("every hand has a letter of its own, which the view does not use for anything else", () => {
  const letters = Object.values(HAND_KEYS);
  assert.equal(new Set(letters).size, letters.length);
  const { press, calls } = keyboard();
  for (const [name, letter] of Object.entries(HAND_KEYS)) {
    assert.equal(handOfKey(letter.toLowerCase()), name);
    assert.ok(press(letter)); // as with Caps Lock
    assert.deepEqual(calls.pop(), ["hand", name]);
  }
  assert.deepEqual(calls, []);
});

test("Space pauses time and B shows the beams, once for a key that is held", () => {
  const { press, calls } = keyboard();
  press(" ");
  press(" ", { repeat: true });
  press("b");
  assert.deepEqual(calls, [["pause"], ["beams", false]]);
});

test("keys with Ctrl belong to the browser", () => {
  const { press, calls } = keyboard();
  assert.equal(press("p", { ctrlKey: true }), false);
  assert.deepEqual(calls, []);
});

test("buttons show as much of their names as fits", () => {
  const below = (/** @type {string} */ names) => names === "below" || names === "few";
  assert.equal(firstThatFits(NAMES, () => true), "beside");
  assert.equal(firstThatFits(NAMES, below), "below");
  assert.equal(firstThatFits(NAMES, () => false), "few");
});
