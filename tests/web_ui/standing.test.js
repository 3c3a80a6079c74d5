import assert from "node:assert/strict";
import { test } from "node:test";

import { translator } from "../../web_ui/i18n/index.js";
import { faultWords, lineOf, placeWords, stateWord } from "../../web_ui/state/standing.js";

const FAILED = { state: "fault", line: "7", first_line: "5", fault: "division by zero" };

test("a state has a word in each language, and one that is new is unknown", () => {
  assert.deepEqual(["off", "fault", "dreaming"].map((state) => stateWord(state, translator("de"))), ["aus", "Fehler", "unbekannt"]);
});

test("the line counts from where the code begins, and is not told while the program runs", () => {
  assert.equal(lineOf(FAILED), 3);
  assert.equal(lineOf({ line: "7" }), 7);
  assert.equal(lineOf({ line: "" }), 0);
  assert.equal(lineOf({ line: "2", first_line: "5" }), 0);
  assert.equal(placeWords(FAILED, translator("fr")), " (ligne 3)");
  assert.equal(placeWords({ ...FAILED, state: "running" }, translator("fr")), "");
});

test("a fault is told in the language of the page if the runtime speaks it", () => {
  const faults = JSON.stringify({ en: "division by zero", de: "Division durch null" });
  assert.equal(faultWords({ ...FAILED, faults }, "de"), "Division durch null");
  assert.equal(faultWords({ ...FAILED, faults }, "it"), "division by zero");
  assert.equal(faultWords(FAILED, "de"), "division by zero");
  assert.equal(faultWords({ state: "running", fault: "", faults: "{}" }, "de"), "");
});

test("a program that runs while time is paused says so, and one that has ended does not", () => {
  const t = translator("en");
  assert.equal(stateWord("running", t, true), "running, time is paused");
  assert.equal(stateWord("running", t, false), "running");
  assert.equal(stateWord("stopped", t, true), "stopped");
});
