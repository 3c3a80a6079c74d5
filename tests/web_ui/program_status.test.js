import assert from "node:assert/strict";
import { test } from "node:test";

import { translator } from "../../web_ui/i18n/index.js";
import programTexts from "../../web_ui/i18n/program.texts.js";
import { badgeOf } from "../../web_ui/program_tab/program_badge.js";
import { faultMessage, lineOf, stateLabel, stateWithLine } from "../../web_ui/state/program_status.js";

const FAILED = { state: "fault", line: "7", first_line: "5", fault: "division by zero" };

/** @param {string} language */
const texts = (language) => translator(language, programTexts);

test("a state has a label in each language, and a new one is unknown", () => {
  assert.deepEqual(["off", "fault", "dreaming"].map((state) => stateLabel(state, texts("de"))), ["aus", "Fehler", "unbekannt"]);
});

test("the line counts from where the code starts, and is not reported while the program runs", () => {
  assert.equal(lineOf(FAILED), 3);
  assert.equal(lineOf({ line: "7" }), 7);
  assert.equal(lineOf({ line: "" }), 0);
  assert.equal(lineOf({ line: "2", first_line: "5" }), 0);
  assert.equal(stateWithLine(FAILED, texts("fr")), "erreur à la ligne 3");
  assert.equal(stateWithLine({ ...FAILED, state: "paused" }, texts("en")), "halted in line 3");
  assert.equal(stateWithLine({ ...FAILED, state: "running" }, texts("fr")), "en marche");
});

test("a fault is shown in the language of the page if the runtime has a translation", () => {
  const faults = JSON.stringify({ en: "division by zero", de: "Division durch null" });
  assert.equal(faultMessage({ ...FAILED, faults }, "de"), "Division durch null");
  assert.equal(faultMessage({ ...FAILED, faults }, "it"), "division by zero");
  assert.equal(faultMessage(FAILED, "de"), "division by zero");
  assert.equal(faultMessage({ state: "running", fault: "", faults: "{}" }, "de"), "");
});

test("a program that runs while time is paused says so, and a stopped one does not", () => {
  const t = texts("en");
  assert.equal(stateLabel("running", t, true), "time is paused");
  assert.equal(stateLabel("running", t, false), "running");
  assert.equal(stateLabel("stopped", t, true), "stopped");
});

const RUNNING = { values: { state: "running" }, title: "go.aesl", timePaused: false, isTextInRobot: true, wasInRobot: true };

test("the badge says which version runs", () => {
  /** @param {Partial<import("../../web_ui/program_tab/program_badge.js").Facts>} what */
  const text = (what) => badgeOf({ ...RUNNING, ...what }, texts("en")).text;
  assert.equal(text({}), "running");
  assert.equal(text({ timePaused: true }), "time is paused");
  assert.equal(text({ isTextInRobot: false }), "Robot runs the older version");
  assert.equal(text({ isTextInRobot: false, wasInRobot: false }), "Robot runs go.aesl");
  assert.equal(text({ isTextInRobot: false, wasInRobot: false, title: "" }), "not started");
  assert.equal(text({ values: FAILED }), "mistake in line 3");
  assert.equal(text({ values: FAILED, isTextInRobot: false }), "mistake"); // the line is one of another text
  assert.equal(text({ values: {} }), "");
});

test("only a program that runs as shown has the color of what works", () => {
  assert.equal(badgeOf(RUNNING, texts("en")).tone, "run");
  assert.equal(badgeOf({ ...RUNNING, isTextInRobot: false }, texts("en")).tone, "wait");
  assert.equal(badgeOf({ ...RUNNING, values: FAILED }, texts("en")).tone, "stop");
});
