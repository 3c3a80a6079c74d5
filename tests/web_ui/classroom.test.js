import assert from "node:assert/strict";
import { test } from "node:test";

import { ClassApi, TokenError } from "../../web_ui/classroom/api.js";
import { base64, kindOfFile } from "../../web_ui/classroom/hand_out.js";
import { progressText } from "../../web_ui/classroom/handout_table.js";
import texts from "../../web_ui/i18n/classroom.texts.js";
import { translator } from "../../web_ui/i18n/index.js";
import { bodyColor, fit } from "../../web_ui/classroom/plan.js";
import { needsHelp, pupilState, slowPercent } from "../../web_ui/classroom/pupil_state.js";

/** @typedef {import("../../web_ui/classroom/api.js").Pupil} Pupil */

/** @param {Partial<Pupil>} given @returns {Pupil} */
function pupil(given) {
  const program = { state: "running", program: "mine.aesl", line: "", fault: "" };
  const known = { id: "ada", name: "Ada", reason: "", restarts: 0, paused: false, held: false, achieved: 1, fallen: [], programs: [program] };
  return { ...known, phase: "running", overview: {}, plan: "1", notice: "", hand: "", trouble: "", link: "", watch: "", ...given };
}

test("a pupil's state is one word, and the worst of several robots", () => {
  const program = { program: "mine.aesl", line: "", fault: "" };
  assert.equal(pupilState(pupil({})), "runs");
  assert.equal(pupilState(pupil({ paused: true })), "paused");
  assert.equal(pupilState(pupil({ paused: true, held: true })), "held");
  assert.equal(pupilState(pupil({ programs: [] })), "idle");
  assert.equal(pupilState(pupil({ fallen: ["thymio"] })), "fell");
  assert.equal(pupilState(pupil({ phase: "broken" })), "broken");
  const programs = [{ ...program, state: "running" }, { ...program, state: "fault" }];
  assert.equal(pupilState(pupil({ programs })), "mistake");
});

test("a pupil needs help with a mistake or a broken simulator, not while waiting", () => {
  assert.deepEqual(
    [pupil({}), pupil({ phase: "broken" }), pupil({ phase: "starting" }), pupil({ paused: true, held: true }), pupil({ fallen: ["thymio"] })].map(needsHelp),
    [false, true, false, false, true],
  );
});

test("a raised hand needs help, and so does a robot that is stuck in a mission while its program runs", () => {
  assert.ok(needsHelp(pupil({ hand: "2026-11-30T10:00:00+01:00", paused: true })));
  assert.ok(needsHelp(pupil({ trouble: "stuck" })));
  assert.ok(needsHelp(pupil({ trouble: "tries", paused: true })));
  assert.ok(!needsHelp(pupil({ trouble: "stuck", paused: true, held: true })));
});

test("the kind of a file that is handed out is that of its content", () => {
  const bytes = (/** @type {string} */ text) => new TextEncoder().encode(text);
  assert.equal(kindOfFile("bus.AESL", bytes("<network>")), "program");
  assert.equal(kindOfFile("bus.py", bytes("import rclpy")), "program");
  assert.equal(kindOfFile("bus.json", bytes('{"format": 1, "success" : "home"}')), "mission");
  assert.equal(kindOfFile("room.json", bytes('{"format": 1, "title": "A success"}')), "playground");
  assert.equal(kindOfFile("bus.zip", bytes("PK mission.json")), "mission");
  assert.equal(kindOfFile("room.zip", bytes("PK room.json")), "playground");
  assert.equal(base64(Uint8Array.from([0, 255, 128])), "AP+A");
});

test("how far a pupil is with a hand-out is said in a few words", () => {
  const t = translator("en", texts);
  const clock = () => "10:31";
  const nothing = { opened: "", changed: "", tries: 0, stars: 0, passed: "", best_s: 0, late: false };
  /** @param {"program" | "mission"} kind @param {object} [progress] */
  const words = (kind, progress) => {
    const handout = { id: "a", kind, name: "bus.json", title: "", pupils: [], due: "", solution_of: "", progress: {} };
    return progressText(handout, progress && { ...nothing, ...progress }, t, clock);
  };
  assert.equal(words("program"), "–");
  assert.equal(words("program", {}), "not opened");
  assert.equal(words("program", { opened: "x" }), "opened 10:31");
  assert.equal(words("program", { opened: "x", changed: "y", tries: 3 }), "runs: 3 · 10:31");
  const passed = { opened: "x", changed: "y", tries: 2, stars: 2, passed: "y", best_s: 7.25, late: true };
  assert.equal(words("mission", passed), "★★ · 7.3 s · tries: 2 · 10:31 · late");
});

test("a simulator that does not keep up is shown in percent of real time", () => {
  assert.equal(slowPercent(pupil({ achieved: 0.51 })), 51);
  assert.equal(slowPercent(pupil({ achieved: 0.97 })), null);
  assert.equal(slowPercent(pupil({ achieved: 0.51, paused: true })), null);
});

test("a plan fills the picture and stays in its middle", () => {
  const { scale, x, y } = fit([-1, -0.5, 1, 0.5], 208, 300);
  assert.equal(Math.round(scale), 100);
  assert.deepEqual([x, y], [104, 150]);
});

test("the body of a robot has the color of its light, white without one", () => {
  assert.equal(bodyColor([0, 0, 0]), "#ffffff");
  assert.equal(bodyColor([32, 0, 0]), "rgb(255 0 0)");
});

test("a wrong token and too many wrong ones (429) are token errors, another failure is not", async (t) => {
  for (const [status, isToken] of /** @type {[number, boolean][]} */ ([[401, true], [429, true], [500, false]])) {
    t.mock.method(globalThis, "fetch", async () => new Response("reason", { status }));
    await assert.rejects(new ClassApi("wrong").state(), (error) => (error instanceof TokenError) === isToken);
  }
});
