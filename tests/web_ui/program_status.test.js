import assert from "node:assert/strict";
import { test } from "node:test";

import { translator } from "../../web_ui/i18n/index.js";
import programTexts from "../../web_ui/i18n/program.texts.js";
import { faultMessage, lineOf, lineLabel, stateLabel } from "../../web_ui/state/program_status.js";

const FAILED = { state: "fault", line: "7", first_line: "5", fault: "division by zero" };

test("a state has a label in each language, and a new one is unknown", () => {
  assert.deepEqual(["off", "fault", "dreaming"].map((state) => stateLabel(state, translator("de", programTexts))), ["aus", "Fehler", "unbekannt"]);
});

test("the line counts from where the code starts, and is not reported while the program runs", () => {
  assert.equal(lineOf(FAILED), 3);
  assert.equal(lineOf({ line: "7" }), 7);
  assert.equal(lineOf({ line: "" }), 0);
  assert.equal(lineOf({ line: "2", first_line: "5" }), 0);
  assert.equal(lineLabel(FAILED, translator("fr", programTexts)), " (ligne 3)");
  assert.equal(lineLabel({ ...FAILED, state: "running" }, translator("fr", programTexts)), "");
});

test("a fault is shown in the language of the page if the runtime has a translation", () => {
  const faults = JSON.stringify({ en: "division by zero", de: "Division durch null" });
  assert.equal(faultMessage({ ...FAILED, faults }, "de"), "Division durch null");
  assert.equal(faultMessage({ ...FAILED, faults }, "it"), "division by zero");
  assert.equal(faultMessage(FAILED, "de"), "division by zero");
  assert.equal(faultMessage({ state: "running", fault: "", faults: "{}" }, "de"), "");
});

test("a program that runs while the simulation is paused says so, and a stopped one does not", () => {
  const t = translator("en", programTexts);
  assert.equal(stateLabel("running", t, true), "running, simulation paused");
  assert.equal(stateLabel("running", t, false), "running");
  assert.equal(stateLabel("stopped", t, true), "stopped");
});
