import assert from "node:assert/strict";
import { test } from "node:test";

import { changeOf, countMistakes, explainMistake, repairLabel, sentence } from "../../web_ui/editor/mistakes.js";
import editorTexts from "../../web_ui/i18n/editor.texts.js";
import { translator } from "../../web_ui/i18n/index.js";

const en = translator("en", editorTexts);

test("the button of a repair describes it", () => {
  /** @param {string} key @param {Record<string, any>} [values] */
  const t = (key, values = {}) => [key, ...Object.values(values)].join(" ");
  assert.equal(repairLabel(t, "a = 1", { from: 2, to: 3, insert: "==" }), "hint.change ==");
  assert.equal(repairLabel(t, "a b", { from: 1, to: 1, insert: " then" }), "hint.insert then");
  assert.equal(repairLabel(t, "a;", { from: 1, to: 2, insert: "" }), "hint.remove ;");
  assert.equal(repairLabel(t, "a", { from: 0, to: 1, insert: "b\nc" }), "hint.correct");
  assert.equal(repairLabel(t, "a\u00a0b", { from: 1, to: 2, insert: " " }), "hint.correct");
  assert.equal(repairLabel(t, "a", { from: 0, to: 0, insert: "x".repeat(30) }), "hint.correct");
});

test("a change is shown in its line", () => {
  const text = "onevent buttons\n\tif button.forward = 1 then\n\tend";
  const at = text.indexOf("= 1");
  assert.deepEqual(changeOf(text, { from: at, to: at + 1, insert: "==" }), {
    before: "if button.forward ",
    old: "=",
    now: "==",
    after: " 1 then",
  });
  assert.deepEqual(changeOf("a = 1;\nb = 2", { from: 5, to: 6, insert: "" }), { before: "a = 1", old: ";", now: "", after: "" });
  assert.deepEqual(changeOf("sound.freq(1)", { from: 0, to: 0, insert: "call " }), {
    before: "",
    old: "",
    now: "call",
    after: " sound.freq(1)",
  });
});

test("a new line stands alone, and a change of several lines is not shown", () => {
  assert.deepEqual(changeOf("if a then\nb = 1\n", { from: 16, to: 16, insert: "end\n" }), { before: "", old: "", now: "end", after: "" });
  assert.equal(changeOf("a\nb\nc", { from: 0, to: 3, insert: "d" }), null);
});

test("a long line is cut around its change", () => {
  const change = changeOf(`${"a".repeat(60)} = 1 ${"b".repeat(60)}`, { from: 61, to: 62, insert: "==" });
  assert.ok(change !== null && change.before.startsWith("…") && change.after.endsWith("…"));
  assert.ok(change.before.length + change.after.length < 70);
});

const EQUALS = { message: "expected 'then' but found '='", kind: "expected-token", hint: "to compare write '=='. Right: if a == 1 then", hintKind: "hint-equals-in-condition" };

test("a mistake has a title, a sentence, and what the compiler says on demand", () => {
  const mistake = explainMistake(en, "if a = 1 then", { ...EQUALS, repair: { from: 5, to: 6, insert: "==" } });
  assert.equal(mistake.title, "One “=” stores. Two compare.");
  assert.equal(mistake.text, "Here you ask whether it is so, and that takes two.");
  assert.equal(mistake.more, "To compare write '=='. Right: if a == 1 then Expected 'then' but found '='.");
  assert.equal(mistake.button, "Change it to ==");
});

test("a mistake without words of its own is explained by the compiler", () => {
  const mistake = explainMistake(en, "a", { message: "this never ends", kind: "infinite-loop" });
  assert.deepEqual([mistake.title, mistake.text, mistake.more], ["The robot does not understand this.", "This never ends.", ""]);
  assert.deepEqual([mistake.change, mistake.button], [null, ""]);
  const unknown = { message: "no variable is called 'b'; perhaps you meant 'a'", kind: "unknown-variable-hint" };
  assert.equal(explainMistake(en, "b", unknown).title, "The robot does not know this name.");
});

test("in every language each title of a mistake has words", () => {
  for (const language of Object.keys(editorTexts)) {
    const t = translator(language, editorTexts);
    const { title, text } = explainMistake(t, "a", { message: "", hintKind: "hint-missing-end", hint: "x" });
    assert.ok(!title.startsWith("mistake.") && text === "X.", language);
  }
});

test("sentences begin with a capital and end with a period", () => {
  assert.equal(sentence("no variable is called 'a'"), "No variable is called 'a'.");
  assert.equal(sentence("that is all."), "That is all.");
  assert.equal(sentence(""), "");
});

test("the mistakes are counted", () => {
  assert.equal(countMistakes(en, [{ line: 6 }]), "1 mistake, line 6");
  assert.equal(countMistakes(en, [{ line: 6 }, { line: 9 }]), "2 mistakes, first in line 6");
});
