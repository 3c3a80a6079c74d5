// Missions on the page: what is kept, what a try says, what the view draws.

import { readFileSync } from "node:fs";
import assert from "node:assert/strict";
import { test } from "node:test";

import texts from "../../web_ui/i18n/missions.texts.js";
import { translator } from "../../web_ui/i18n/index.js";
import { outcome, starTexts } from "../../web_ui/missions/card.js";
import { firstOpen, titleIn } from "../../web_ui/missions/list.js";
import { looksLikeMission } from "../../web_ui/missions/file_kind.js";
import { blockWords, codeLines, firstMissing, nextStep } from "../../web_ui/missions/next_step.js";
import { Progress } from "../../web_ui/missions/progress.js";
import { fetchMissions } from "../../web_ui/missions/steps.js";
import { firstOf } from "../../web_ui/missions/stars.js";
import { MARKER } from "../../web_ui/state/markers.js";
import { attemptOf, INITIAL, reduce } from "../../web_ui/state/index.js";
import { factText, hintsOf, measuredText, missionMarkers, missionText } from "../../web_ui/state/mission.js";
import { editorsOf } from "../../web_ui/hosts/program_host.js";

const t = translator("en", texts);

/** @type {import("../../web_ui/state/mission.js").Mission} */
const MISSION = {
  name: "bay",
  robot: "",
  title: "Into the bay",
  story: "Park.",
  languages: ["vpl", "text"],
  time_s: 30,
  next: "",
  hints: ["Turn.", "Stop."],
  facts: { parked: "It is in the bay", crash: "It touched something" },
  stars: [
    { text: "", within_s: 15, length: null },
    { text: "Five rows", within_s: null, length: 5 },
  ],
  zones: {
    bay: { kind: "rectangle", x_m: 0.3, y_m: 0.2, size_x_m: 0.2, size_y_m: 0.1, yaw_rad: Math.PI / 2 },
    hole: { kind: "disc", x_m: 0, y_m: 0, radius_m: 0.5 },
  },
  programs: {},
  solutions: {},
  toolbox: { hide: [], modes: null },
  missing: { parked: "It is not in the bay", crash: "It touched something" },
  translations: {
    de: {
      title: "In die Bucht",
      story: "",
      hints: ["Drehen."],
      facts: { parked: "In der Bucht" },
      missing: { parked: "Nicht in der Bucht" },
      stars: ["In 15 Sekunden"],
    },
  },
};

/** @type {import("../../web_ui/state/mission.js").Try} */
const TRY = {
  mission: "bay",
  tries: 1,
  state: "running",
  reason: "",
  at_s: 1,
  trouble: "",
  checklist: [["parked"], ["crash", "parked"]],
  done: [true, false],
  stars: [false, false, false],
  broken: [],
  missing: [],
  measured: {},
  trace: [],
};

function storage() {
  /** @type {Map<string, string>} */ const values = new Map();
  return {
    values,
    getItem: (/** @type {string} */ key) => values.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ value) => void values.set(key, value),
    removeItem: (/** @type {string} */ key) => void values.delete(key),
  };
}

test("the most stars of a mission are kept", () => {
  const kept = storage();
  const progress = new Progress(kept);
  assert.equal(progress.starsOf("bay"), null);
  progress.note("bay", 2);
  progress.note("bay", 1);
  progress.note("line", 1);
  assert.equal(new Progress(kept).starsOf("bay"), 2);
  assert.equal(progress.starsOf("line"), 1);
});

test("stars that another program wrote do no harm", () => {
  for (const broken of ["{", "null", "7", '{"bay": "many"}']) {
    const kept = storage();
    kept.setItem("missions.stars", broken);
    const progress = new Progress(kept);
    assert.equal(progress.starsOf("bay"), null);
    progress.note("bay", 3);
    assert.equal(progress.starsOf("bay"), 3);
  }
});

test("each mission and language has a program of its own", () => {
  const progress = new Progress(storage());
  progress.keepProgram("bay", "text", "a");
  progress.keepProgram("bay", "vpl", "b");
  progress.keepLanguage("bay", "vpl");
  assert.deepEqual(
    [progress.program("bay", "text"), progress.program("bay", "vpl"), progress.program("line", "vpl"), progress.language("bay")],
    ["a", "b", null, "vpl"],
  );
});

test("the list leads to the first mission that is not passed", () => {
  const progress = new Progress(storage());
  const steps = [["a", "b"], ["c"]].map((names, at) => ({
    name: String(at),
    titles: { en: "Step", de: "Schritt" },
    missions: names.map((name) => ({ name, titles: { en: name }, picture: "", stars: 2, languages: [] })),
  }));
  assert.equal(firstOpen(steps, progress), "a");
  progress.note("a", 1);
  progress.note("b", 1);
  assert.equal(firstOpen(steps, progress), "c");
  progress.note("c", 2);
  assert.equal(firstOpen(steps, progress), "");
  assert.equal(titleIn(steps[0].titles, "de"), "Schritt");
  assert.equal(titleIn(steps[0].titles, "fr"), "Step");
  assert.deepEqual(firstOf(1, 3), [true, false, false]);
});

test("a list that does not come is no list", async () => {
  const { fetch } = globalThis;
  try {
    globalThis.fetch = () => Promise.reject(new Error("away"));
    assert.equal(await fetchMissions(), null);
    globalThis.fetch = async () => new Response("", { status: 404 });
    assert.equal(await fetchMissions(), null);
    globalThis.fetch = async () => new Response("not JSON");
    assert.equal(await fetchMissions(), null);
  } finally {
    globalThis.fetch = fetch;
  }
});

test("a try says what became of it in words of the mission", () => {
  /** @param {Partial<typeof TRY>} change */
  const words = (change, language = "en") => outcome(MISSION, { ...TRY, ...change }, language, t);
  assert.equal(words({}), "");
  assert.equal(outcome(MISSION, null, "en", t), "");
  assert.equal(words({ state: "passed" }), "Mission passed!");
  assert.equal(words({ state: "failed", reason: "facts", broken: ["crash"] }), "Not passed: It touched something");
  assert.equal(
    words({ state: "failed", reason: "time", missing: ["parked"] }),
    "The time is over. Still missing: It is not in the bay",
  );
  assert.match(words({ state: "failed", reason: "hand" }), /hand/);
  assert.match(words({ state: "failed", reason: "time", missing: ["parked"] }, "de"), /Nicht in der Bucht/);
});

test("texts are those of the language, else the mission's own", () => {
  assert.equal(missionText(MISSION, "de", "title"), "In die Bucht");
  assert.equal(missionText(MISSION, "de", "story"), "Park.");
  assert.equal(missionText(MISSION, "fr", "title"), "Into the bay");
  assert.equal(factText(MISSION, "de", "crash"), "It touched something");
  assert.equal(factText(MISSION, "en", "unknown"), "unknown");
  assert.deepEqual(hintsOf(MISSION, "de"), ["Drehen.", "Stop."]);
  assert.deepEqual(starTexts(MISSION, "en", t), ["The goal is reached", "Within 15 seconds", "Five rows"]);
  assert.deepEqual(starTexts(MISSION, "de", t), ["The goal is reached", "In 15 Sekunden", "Five rows"]);
});

test("zones lie on the ground, turned as they are", () => {
  const markers = missionMarkers(MISSION, null);
  assert.deepEqual([...markers.keys()], ["paint/zone bay/0", "paint/zone bay/1", "paint/zone hole/0", "paint/zone hole/1"]);
  const rim = markers.get("paint/zone bay/1");
  assert.equal(rim?.type, MARKER.LINE_STRIP);
  const xs = rim?.points.map(({ x }) => Math.round(x * 1000)) ?? [];
  const ys = rim?.points.map(({ y }) => Math.round(y * 1000)) ?? [];
  assert.deepEqual([Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)], [250, 350, 100, 300]);
  assert.equal(markers.get("paint/zone bay/0")?.points.length, 6); // two triangles
  for (const { x, y } of markers.get("paint/zone hole/1")?.points ?? []) assert.ok(Math.abs(Math.hypot(x, y) - 0.5) < 1e-9);
});

test("the way is drawn when the try is over", () => {
  const trace = /** @type {[number, number][]} */ ([[0, 0], [0, 0], [0.1, 0]]); // prettier-ignore
  assert.ok(!missionMarkers(MISSION, { ...TRY, trace }).has("paint/way/0"));
  const way = missionMarkers(MISSION, { ...TRY, state: "failed", trace }).get("paint/way/0");
  assert.deepEqual(way?.points.map(({ x }) => x), [0, 0.1]);
});

test("mission and try come in any order, and end together", () => {
  /** @param {string} topic @param {any} value */
  const message = (topic, value) =>
    /** @type {const} */ ({ type: "message", topic, value: { data: JSON.stringify(value) }, timeNs: 0n });
  let state = reduce(INITIAL, message("/simulator/_mission/try", TRY));
  assert.equal(attemptOf(state), null);
  state = reduce(state, message("/simulator/_mission", MISSION));
  assert.equal(attemptOf(state)?.tries, 1);
  assert.equal(state.missionMarkers.size, 4);
  state = reduce(state, message("/simulator/_mission", { ...MISSION, name: "other" }));
  assert.equal(attemptOf(state), null);
  state = reduce(state, message("/simulator/_mission", null));
  assert.equal(state.mission, null);
  assert.equal(state.missionMarkers.size, 0);
});

test("the Scratch look is an editor of blocks", () => {
  assert.equal(editorsOf(null), null);
  assert.deepEqual(editorsOf(["vpl", "scratch", "ros"]), ["vpl", "blocks", "ros"]);
});

test("quantities stand beside their goals", () => {
  const attempt = { ...TRY, measured: /** @type {Record<string, [number, number, string]>} */ ({ far: [0.321, 0.5, "m"], turn: [12.4, 90, "°"], laps: [0.4, 1, ""] }) };
  assert.equal(measuredText(attempt, "far", "en"), "0.32 / 0.5 m");
  assert.equal(measuredText(attempt, "far", "de"), "0,32 / 0,5 m");
  assert.equal(measuredText(attempt, "turn", "en"), "12 / 90°");
  assert.equal(measuredText(attempt, "laps", "en"), "0.4 / 1");
  assert.equal(measuredText(attempt, "parked", "en"), "");
  assert.equal(measuredText(null, "far", "en"), "");
});

test("the next step is what a solution has first that the program lacks", () => {
  assert.equal(firstMissing(["a", "b", "b"], ["b", "a"]), "b");
  assert.equal(firstMissing(["a", "b"], ["b", "x", "a"]), null);
  const file = (/** @type {string} */ code) => `<!DOCTYPE aesl-source>\n<network><node nodeId="1" name="thymio-II">${code}</node></network>`;
  assert.deepEqual(codeLines(file("onevent  prox # near\n\n  motor.left.target = 3")), ["onevent prox", "motor.left.target = 3"]);
  assert.deepEqual(codeLines("<network"), []);
});

/** @param {string} language */
const solution = (language) =>
  readFileSync(new URL(`../../docs/course/1-buttons/programs/${language}.aesl`, import.meta.url), "utf8");

test("the next row of VPL is said in words", async () => {
  const whole = { kind: "vpl", solution: solution("solution"), language: "en" };
  assert.equal(await nextStep({ ...whole, own: whole.solution }), null);
  assert.match((await nextStep({ ...whole, own: "" })) ?? "", /→/);
});

test("the next block is said in words", async () => {
  const table = { "block.motor": "set {VARIABLE} to {VALUE}" };
  const text = '<block type="motor" id="1"><field name="VARIABLE">left</field><value name="VALUE"><block type="number"></block></value></block>';
  assert.deepEqual(blockWords(text, table), ["set left to …"]);
  const course = readFileSync(new URL("../../docs/course/3-blocks/programs/solution.aesl", import.meta.url), "utf8");
  assert.equal(await nextStep({ kind: "blocks", solution: course, own: course, language: "de" }), null);
  assert.ok(await nextStep({ kind: "blocks", solution: course, own: "", language: "de" }));
});

test("a file that is dropped is a mission by what is in it", () => {
  const bytes = (/** @type {string} */ text) => new TextEncoder().encode(text);
  assert.ok(looksLikeMission(bytes('{"format": 1, "facts": {}, "success": "far"}')));
  assert.ok(looksLikeMission(bytes("PK\u0003\u0004 mission.json")));
  for (const other of ['{"format": 1, "shapes": []}', "[]", "null", "<network>", "", "PK\u0003\u0004 playground.json"]) {
    assert.ok(!looksLikeMission(bytes(other)), other);
  }
});
