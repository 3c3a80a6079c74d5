// The creator's missions: what the form makes is a file, and the file opens in the form again.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";

import { added, newPlayground } from "../../web_ui/creator/commands.js";
import { write } from "../../web_ui/playground/document.js";
import { parseDraft, writeDraft } from "../../web_ui/playground/draft_text.js";
import { FACTS, LANGUAGES, newGoal, newMission, problemsOf, withMission } from "../../web_ui/playground/mission.js";
import { missionFile, missionOf, pack, unpack } from "../../web_ui/playground/mission_archive.js";
import { Fault } from "../../web_ui/playground/rules.js";
import texts from "../../web_ui/i18n/creator.texts.js";

const { strToU8, zipSync } = createRequire(new URL("../../web_ui/", import.meta.url))("fflate");

const BAY = { kind: "rectangle", name: "bay", x_m: 0.3, y_m: 0.2, size_x_m: 0.2, size_y_m: 0.1, color: "#0000ff" };
const POST = { kind: "cylinder", name: "post", x_m: -0.3, y_m: 0.2, radius_m: 0.05, height_m: 0.1, color: "#ff0000" };

function field() {
  return [BAY, POST].reduce(added, newPlayground("Park"));
}

/** @param {Partial<import("../../web_ui/playground/mission.js").Mission>} values */
const mission = (values) => withMission(field(), { ...newMission(), ...values });

/** @param {string} kind @param {object} [values] @param {object} [rest] */
const goal = (kind, values = {}, rest = {}) => ({ ...newGoal(kind, field()), ...rest, values: { ...newGoal(kind, field()).values, ...values } });

const said = (/** @type {{ kind: string }} */ { kind }) => `It is ${kind}`;

test("a mission is written with zones where the areas of the playground are", () => {
  const goals = [goal("inside", { zone: "bay" }), goal("lights", { color: "red" }, { text: "Red!", hold_s: 2 })];
  const never = [goal("touches", { what: "post" })];
  const file = missionFile(mission({ order: "then", goals, never, within_s: 20, length: 4, programs: { vpl: "<network/>" } }), said);
  assert.deepEqual(file.zones, { bay: { kind: "rectangle", x_m: 0.3, y_m: 0.2, size_x_m: 0.2, size_y_m: 0.1 } });
  assert.deepEqual(file.success, { then: ["goal_1", { hold: "goal_2", for_s: 2 }] });
  assert.deepEqual(file.facts.goal_1, { kind: "inside", zone: "bay", text: "It is inside" });
  assert.equal(file.facts.goal_2.text, "Red!");
  assert.equal(file.failure, "never_1");
  assert.deepEqual(file.stars, [{ within_s: 20 }, { length: 4 }]);
  assert.deepEqual(file.programs, { vpl: "programs/vpl.aesl" });
});

for (const order of /** @type {const} */ (["any", "then", "same"])) {
  test(`a written mission opens in the form again: order ${order}`, () => {
    const goals = [goal("inside", { zone: "bay" }, { text: "In" }), goal("still", {}, { text: "Still", hold_s: 1 })];
    const never = [goal("touches", {}, { text: "Bang" }), goal("fallen", {}, { text: "Down" })];
    const made = mission({ order, goals, never, hints: ["Turn"], time_s: 30, story: "Go", programs: { text: "# go" } });
    assert.deepEqual(missionOf(missionFile(made, said), made, { text: "# go" }), made.mission);
  });
}

test("a mission that the form cannot have is not taken for a similar one", () => {
  const made = mission({ goals: [goal("inside", { zone: "bay" })] });
  const file = missionFile(made, said);
  /** @param {object} change */
  const opened = (change) => missionOf({ ...file, ...change }, made, {});
  assert.notEqual(opened({}), null);
  assert.equal(opened({ success: { any: ["goal_1"] } }), null);
  assert.equal(opened({ success: { not: "goal_1" } }), null);
  assert.equal(opened({ happens: [{ at_s: 1, tap: true }] }), null);
  assert.equal(opened({ zones: { bay: { kind: "disc", x_m: 0, y_m: 0, radius_m: 1 } } }), null);
  assert.equal(opened({ stars: [{ when: "goal_1" }] }), null);
  assert.equal(opened({ robot: "other" }), null);
});

test("one file has the mission with its playground and programs", () => {
  const made = mission({ goals: [goal("inside", { zone: "bay" }, { text: "In" })], programs: { text: "motor.left.target = 1" } });
  assert.deepEqual(unpack(pack(made, said)), made);
  assert.deepEqual(parseDraft(writeDraft(made)), made);
  assert.deepEqual(parseDraft(writeDraft(field())), field());
  assert.throws(() => unpack(new Uint8Array([1, 2, 3])), (error) => error instanceof Fault && error.expected.word === "fault.zip");
  const file = missionFile(made, said);
  for (const [content, key, word] of /** @type {const} */ ([
    [{ "other.json": "{}" }, "mission.json", "fault.file"],
    [{ "mission.json": "{" }, "mission.json", "fault.json"],
    [{ "mission.json": "[]" }, "mission.json", "fault.object"],
    [{ "mission.json": JSON.stringify(file) }, "playground.json", "fault.file"],
    [{ "mission.json": JSON.stringify({ ...file, programs: {}, failure: { not: "goal_1" } }), "playground.json": write(field()) }, "mission.json", "fault.form"],
  ])) {
    const zipped = zipSync(Object.fromEntries(Object.entries(content).map(([name, text]) => [name, strToU8(text)])));
    assert.throws(() => unpack(zipped), (error) => error instanceof Fault && error.key === key && error.expected.word === word, word);
  }
});

test("what is missing is said with its field", () => {
  assert.deepEqual(problemsOf(field()), []);
  /** @param {Partial<import("../../web_ui/playground/mission.js").Mission>} values */
  const keys = (values) => problemsOf(mission(values)).map(({ key }) => key);
  assert.deepEqual(keys({}), ["goals"]);
  assert.deepEqual(keys({ goals: [goal("inside", { zone: "gone" })], languages: [] }), ["languages", "goals[0].zone"]);
  assert.deepEqual(keys({ goals: [goal("emits")], never: [goal("touches", { what: "gone" })] }), ["goals[0].event", "never[0].what"]);
  assert.deepEqual(keys({ goals: [goal("still", {}, { robot: "other" })] }), ["goals[0].robot"]);
  assert.deepEqual(keys({ goals: [goal("inside", { zone: "bay" })] }), []);
});

test("each kind of fact, field and language has texts, and a new goal is complete but for names", () => {
  for (const [kind, fields] of Object.entries(FACTS)) {
    for (const key of [`goal.${kind}`, `goal.${kind}.text`]) assert.ok(key in texts.en, key);
    for (const key of Object.keys(fields)) assert.ok(`field.${key}` in texts.en, key);
  }
  for (const language of LANGUAGES) assert.ok(`mission.language.${language}` in texts.en, language);
  const kinds = Object.keys(FACTS).filter((kind) => !["emits", "reads"].includes(kind));
  assert.deepEqual(problemsOf(mission({ goals: kinds.map((kind) => goal(kind)) })), []);
});

test("a mission of the course is not changed by the form", () => {
  const file = JSON.parse(readFileSync(new URL("../../docs/course/1-buttons/mission.json", import.meta.url), "utf8"));
  assert.equal(missionOf(file, field(), {}), null);
});
