// The tab "Class": one word per robot, who has waited longest, names given by the class.

import assert from "node:assert/strict";
import { test } from "node:test";

import { RobotNames } from "../../web_ui/browser/robot_names.js";
import { classState, fits, membersOf, needsLook, Troubles } from "../../web_ui/class_tab/class_states.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";
import classTexts from "../../web_ui/i18n/class.texts.js";
import { newStorage } from "./support.js";

/** @param {string} state @param {string} [name] @param {Record<string, string>} [values] */
const program = (state, name = "mine.aesl", values = {}) => ({ state, name, message: "", level: 0, line: "", values: { state, ...values } });

test("every state of a program is one word, and falling off comes first", () => {
  assert.equal(classState(program("running"), false), "runs");
  assert.equal(classState(program("stopped"), false), "stopped");
  assert.equal(classState(program("paused"), false), "halted");
  assert.equal(classState(program("fault"), false), "mistake");
  assert.equal(classState(program("off"), false), "idle");
  assert.equal(classState(program(""), false), "idle");
  assert.equal(classState(undefined, false), "idle");
  assert.equal(classState(program("running"), true), "fell");
});

test("a robot that waits with its light has not been started", () => {
  assert.equal(classState(program("running", "welcome"), false), "idle");
  assert.equal(classState(program("running", "welcome.aesl"), false), "idle");
  assert.equal(classState(program("fault", "welcome"), false), "mistake");
});

test("every state has its word in every language", () => {
  for (const texts of Object.values(classTexts)) {
    for (const state of ["runs", "stopped", "halted", "mistake", "fell", "idle"]) assert.ok(texts[`state.${state}`], state);
  }
});

test("members are filtered by who needs a look and who has not started", () => {
  const members = membersOf({
    robots: { t1: NEW_ROBOT, t2: NEW_ROBOT, t3: NEW_ROBOT },
    programs: { t1: program("running"), t2: program("fault", "x", { line: "7", first_line: "2" }), "": program("off") },
    simulator: /** @type {any} */ ({ fallen: [] }),
  });
  assert.deepEqual(members.map(({ number }) => number), ["1", "2", "3"]); // as on the dots in the view
  assert.deepEqual(members.map(({ state, line }) => [state, line]), [["runs", 0], ["mistake", 6], ["idle", 0]]); // prettier-ignore
  assert.deepEqual(members.map((member) => fits("look", member)), [false, true, false]);
  assert.deepEqual(members.map((member) => fits("idle", member)), [false, false, true]);
  assert.ok(members.every((member) => fits("all", member)));
  assert.deepEqual(["runs", "stopped", "halted", "mistake", "fell", "idle"].map((state) => needsLook(/** @type {any} */ (state))), [false, false, true, true, true, false]); // prettier-ignore
});

test("a robot that has waited longest comes first, unless one in trouble is chosen", () => {
  const troubles = new Troubles();
  /** @param {Record<string, string>} states */
  const members = (states) =>
    Object.entries(states).map(([robot, state]) => ({ robot, number: "1", state: /** @type {any} */ (state), line: 0 }));
  assert.equal(troubles.first("a"), null);
  troubles.update(members({ a: "runs", b: "mistake", c: "runs" }), 0);
  troubles.update(members({ a: "fell", b: "mistake", c: "runs" }), 60_000);
  assert.equal(troubles.first("c"), "b");
  assert.equal(troubles.first("a"), "a");
  assert.equal(troubles.minutes("b", 200_000), 3);
  assert.equal(troubles.minutes("a", 61_000), 0);
  troubles.update(members({ a: "fell", b: "halted", c: "runs" }), 240_000); // another trouble: its time starts again
  assert.equal(troubles.minutes("b", 241_000), 0);
  troubles.update(members({ a: "runs", b: "runs", c: "runs" }), 300_000);
  assert.equal(troubles.first("a"), null);
});

test("names stay in the browser, and broken ones are forgotten", () => {
  const storage = newStorage();
  const names = new RobotNames(storage);
  names.set("t1", "  Ada ");
  names.set("t2", "Ben");
  names.set("t2", "");
  assert.deepEqual(["t1", "t2", "toString"].map((robot) => names.of(robot)), ["Ada", "", ""]);
  assert.equal(new RobotNames(storage).of("t1"), "Ada");
  storage.kept.set("robot.names", "[1");
  assert.equal(new RobotNames(storage).of("t1"), "");
});
