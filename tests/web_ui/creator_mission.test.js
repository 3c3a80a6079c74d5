// The creator's missions: what the form makes is a file, and the file opens in the form again.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";

import { added, newPlayground } from "../../web_ui/creator/commands.js";
import { write } from "../../web_ui/playground/document.js";
import { parseDraft, writeDraft } from "../../web_ui/playground/draft_text.js";
import { readByHand } from "../../web_ui/creator/mission_by_hand.js";
import { ACTIONS, FACTS, happeningChoices, HAPPENING, LANGUAGES, newGoal, newHappening, newMission, problemsOf, withMission, WORDS } from "../../web_ui/playground/mission.js";
import { pack, unpack } from "../../web_ui/playground/mission_archive.js";
import { missionFile, missionOf } from "../../web_ui/playground/mission_content.js";
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

test("what the form cannot have is kept as the file has it", () => {
  const made = mission({ goals: [goal("inside", { zone: "bay" })] });
  const file = missionFile(made, said);
  assert.deepEqual(missionOf(file, made, {}).kept, {});
  for (const change of [
    { success: { any: ["goal_1"] } },
    { success: { not: "goal_1" } },
    { failure: { hold: { all: ["goal_1", "goal_1"] }, for_s: 2 } },
    { zones: { bay: { kind: "disc", x_m: 0, y_m: 0, radius_m: 1 } } },
    { stars: [{ when: { not: "goal_1" } }] },
    { toolbox: { hide: ["prox"] } },
    { robots: { bert: "explorer" }, next: "forward", picture: "bay.png" },
    { translations: { de: { title: "Parken" } } },
    { facts: { ...file.facts, other: { kind: "fallen" } } },
    { facts: { goal_1: { kind: "unheard_of" } } },
  ]) {
    const opened = missionOf({ ...file, ...change }, made, {});
    assert.deepEqual(missionFile({ ...made, mission: opened }, said), { ...file, ...change }, JSON.stringify(change));
  }
});

const { title: _title, ...PLAIN } = newPlayground("Plain");

/** What a file means, with the usual values of what it leaves out. @param {Record<string, any>} file */
function meaning({ $schema: _schema, playground: _playground, programs: _programs, solutions: _solutions, facts, zones = {}, happens = [], success, ...rest }) {
  const filled = Object.entries(facts).map(([name, fact]) => [name, { robot: "", text: "", missing: "", .../** @type {object} */ (fact) }]);
  const parts = success.then === undefined && success.all === undefined ? { all: [success] } : success;
  return { story: "", robot: "", languages: LANGUAGES, hints: [], stars: [], time_s: 120, ...rest, zones, happens, success: parts, facts: Object.fromEntries(filled) };
}

const FOLDERS = ["../../playgrounds/missions/", "../../docs/course/"].map((folder) => new URL(folder, import.meta.url));
const SHIPPED = FOLDERS.flatMap((folder) =>
  readdirSync(folder, { recursive: true })
    .map(String)
    .filter((name) => /^\d-\w+.\w+\.json$/.test(name))
    .map((name) => ({ name, data: JSON.parse(readFileSync(new URL(name, folder), "utf8")) }))
    .filter(({ data }) => "success" in data),
);

test("each shipped mission is opened and saved again without loss, and most goals are in the form", () => {
  assert.ok(SHIPPED.length >= 23);
  for (const { name, data } of SHIPPED) {
    const opened = missionOf(data, { ...PLAIN, title: data.title }, {});
    const saved = missionFile({ ...PLAIN, title: data.title, mission: opened }, () => "");
    assert.deepEqual(meaning(saved), meaning(data), name);
    for (const word of ["story", "time_s", "hints", "happens", "languages", "robot"]) assert.ok(!(word in opened.kept), `${name}: ${word}`);
  }
  const inForm = SHIPPED.filter(({ data }) => !("success" in missionOf(data, { ...PLAIN, title: "" }, {}).kept));
  assert.ok(inForm.length > SHIPPED.length / 2, inForm.map(({ name }) => name).join());
});

test("names of facts stay, so that translations fit, and a new one is free", () => {
  const file = { ...missionFile(mission({ goals: [goal("still", {}, { text: "S" })] }), said), facts: { goal_2: { kind: "still" }, spare: { kind: "fallen" } }, success: "goal_2" };
  const opened = missionOf(file, field(), {});
  const more = { ...opened, goals: [...opened.goals, goal("sound")] };
  const saved = missionFile(mission(more), said);
  assert.deepEqual(Object.keys(saved.facts).sort(), ["goal_2", "goal_2_2", "spare"]);
  assert.deepEqual(saved.success, { all: ["goal_2", "goal_2_2"] });
});

test("a star for a goal is at the end or at any time, with a text of its own", () => {
  const extra = [goal("lights", { color: "green" }, { once: true, hold_s: 1, star: "Green on the way" })];
  const file = missionFile(mission({ goals: [goal("still")], extra, length: 5, length_text: "Short" }), said);
  assert.deepEqual(file.stars, [{ length: 5, text: "Short" }, { when: { once: { hold: "star_1", for_s: 1 } }, text: "Green on the way" }]);
  assert.deepEqual(problemsOf(mission({ goals: [goal("still")], extra, length: 5, within_s: 5 })).map(({ key }) => key), ["stars"]);
});

test("all that can happen can be added, and names a thing and a robot that are there", () => {
  const load = { ...POST, name: "load", mass_kg: 0.1 };
  const playground = added(field(), load);
  const happens = ACTIONS.map((action, at) => newHappening(action, at, playground));
  assert.deepEqual(happens.at(-1), { at_s: 5, move: "load", x_m: 0, y_m: 0 });
  for (const action of ACTIONS) {
    assert.ok(action in HAPPENING && `happening.${action}` in texts.en, action);
    for (const choice of (action === "move" ? [] : happeningChoices(action, playground)) ?? []) assert.ok(`choice.${choice}` in texts.en, choice);
  }
  const made = withMission(playground, { ...newMission(), goals: [goal("still")], happens });
  assert.deepEqual(problemsOf(made), []);
  assert.deepEqual(missionOf(missionFile(made, said), made, {}).happens, happens);
  const gone = withMission(playground, { ...made.mission, happens: [newHappening("move", 1, field()), { at_s: 1, tap: true, robot: "bert" }] });
  assert.deepEqual(problemsOf(gone).map(({ key }) => key), ["happens[0]", "happens[1]"]);
});

test("what is written by hand is JSON with words of a mission", () => {
  assert.deepEqual(readByHand(" "), { kept: {}, problem: null });
  assert.deepEqual(readByHand('{"next": "wall"}'), { kept: { next: "wall" }, problem: null });
  for (const [text, word] of [["{", "problem.json"], ["[]", "problem.json"], ["null", "problem.json"], ['{"facts": 3}', "problem.json"], ['{"story": "", "nxt": 1}', "problem.word"], ['{"format": 1}', "problem.word"]]) {
    assert.equal(readByHand(text).problem?.word, word, text);
  }
  assert.ok(WORDS.includes("translations"));
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
    [{ "mission.json": JSON.stringify({ ...file, facts: [] }) }, "facts", "fault.object"],
    [{ "mission.json": JSON.stringify({ ...file, facts: { a: 3 } }) }, "a", "fault.object"],
    [{ "mission.json": JSON.stringify({ ...file, stars: {} }) }, "stars", "fault.list"],
    [{ "mission.json": JSON.stringify({ ...file, hints: [[]] }) }, "hints", "fault.text"],
    [{ "mission.json": JSON.stringify({ ...file, happens: [3] }) }, "happens", "fault.object"],
    [{ "mission.json": JSON.stringify({ ...file, programs: {}, happens: [{ at_s: 1 }] }).replace('"at_s":', `"at_s": ${"[".repeat(9000)}${"]".repeat(9000)}, "tap":`), "playground.json": write(field()) }, "mission.json", "fault.tooMuch"],
  ])) {
    const zipped = zipSync(Object.fromEntries(Object.entries(content).map(([name, text]) => [name, strToU8(text)])));
    assert.throws(() => unpack(zipped), (error) => error instanceof Fault && error.key === key && error.expected.word === word, word);
  }
});

test("an archive keeps solutions and pictures, may have a folder, and may not be a bomb", () => {
  const made = mission({ goals: [goal("still", {}, { text: "S" })], solutions: { text: "motor.left.target = 0" }, kept: { picture: "p/bay.png" }, files: { "p/bay.png": btoa("\u0089PNG") } });
  assert.deepEqual(unpack(pack(made, said)), made);
  const { unzipSync } = createRequire(new URL("../../web_ui/", import.meta.url))("fflate");
  const inFolder = Object.fromEntries(Object.entries(unzipSync(pack(made, said))).map(([name, data]) => [`bay/${name}`, data]));
  assert.deepEqual(unpack(zipSync(inFolder)), made);
  const bomb = zipSync({ ...Object.fromEntries(Array.from({ length: 5 }, (_, at) => [`${at}.png`, new Uint8Array(8_000_000)])), "mission.json": strToU8("{}") });
  assert.ok(bomb.length < 100_000);
  const many = zipSync(Object.fromEntries(Array.from({ length: 300 }, (_, at) => [`${at}.txt`, new Uint8Array(0)])));
  for (const bytes of [bomb, many]) assert.throws(() => unpack(bytes), (error) => error instanceof Fault && error.expected.word === "fault.tooMuch");
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
