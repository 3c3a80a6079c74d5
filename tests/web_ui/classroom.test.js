import assert from "node:assert/strict";
import { test } from "node:test";

import { ClassApi, TokenError } from "../../web_ui/classroom/api.js";
import { bodyColor, fit } from "../../web_ui/classroom/plan.js";
import { needsHelp, pupilState, slowPercent } from "../../web_ui/classroom/pupil_state.js";

/** @typedef {import("../../web_ui/classroom/api.js").Pupil} Pupil */

/** @param {Partial<Pupil>} given @returns {Pupil} */
function pupil(given) {
  const program = { state: "running", program: "mine.aesl", line: "", fault: "" };
  const known = { id: "ada", name: "Ada", reason: "", restarts: 0, paused: false, held: false, achieved: 1, fallen: [], programs: [program] };
  return { ...known, phase: "running", overview: {}, plan: "1", notice: "", link: "", watch: "", ...given };
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
