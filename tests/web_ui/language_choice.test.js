import assert from "node:assert/strict";
import { test } from "node:test";

import { newAesl } from "../../web_ui/editor/aesl.js";
import { FileStore } from "../../web_ui/editor/file_store.js";
import { Workspace } from "../../web_ui/editor/workspace.js";
import { LanguageChoice, languageOf } from "../../web_ui/program_tab/language_choice.js";
import { newStorage } from "./support.js";

const PICTURE = "<toolsPlugins><picture/></toolsPlugins>";
const LANGUAGES = [
  { id: "picture", holds: (/** @type {string} */ text) => text.includes("<picture") },
  { id: "cards", holds: (/** @type {string} */ text) => text.includes("<cards") },
  { id: "text", holds: () => true },
];
const WITH_PICTURE = newAesl("motor.left.target = 1\n").replace("</node>", `${PICTURE}</node>`);
const withoutPicture = (/** @type {string} */ text) => text.replace(PICTURE, "");

/** A workspace whose open document is this text. @param {string} text */
function opened(text) {
  const fileStore = new FileStore(newStorage());
  const workspace = new Workspace({ fileStore, now: () => 0, changed: () => {} });
  assert.equal(workspace.open("a.aesl", text), null);
  return { workspace, choice: new LanguageChoice({ workspace, languages: LANGUAGES }) };
}

test("the file decides to which language it belongs", () => {
  assert.equal(languageOf({ name: "a.aesl", text: WITH_PICTURE }, LANGUAGES), "picture");
  assert.equal(languageOf({ name: "a.aesl", text: newAesl() }, LANGUAGES), "text");
});

test("a picture can be looked at as text, which is read only", () => {
  const { workspace, choice } = opened(WITH_PICTURE);
  assert.deepEqual([choice.shown, choice.isReadOnly, choice.notice], ["picture", false, null]);
  assert.equal(choice.choose("text"), "shown");
  assert.deepEqual([choice.shown, choice.isReadOnly], ["text", true]);
  assert.deepEqual(choice.notice, { kind: "made", language: "picture" });
  assert.equal(choice.choose("picture"), "shown");
  assert.equal(choice.shown, "picture");
  assert.equal(workspace.current.text, WITH_PICTURE);
});

test("a picture leaves the file, and comes back as it was", () => {
  const { workspace, choice } = opened(WITH_PICTURE);
  choice.choose("text");
  choice.detach(withoutPicture);
  assert.equal(workspace.current.text, withoutPicture(WITH_PICTURE));
  assert.deepEqual([choice.shown, choice.isReadOnly], ["text", false]);
  assert.deepEqual(choice.notice, { kind: "detached", language: "picture" });
  assert.ok(workspace.fileStore.recent().some(({ text }) => text === WITH_PICTURE), "kept among the last programs");
  assert.equal(choice.choose("picture"), "shown");
  assert.equal(workspace.current.text, WITH_PICTURE);
  assert.deepEqual([choice.shown, choice.notice], ["picture", null]);
});

test("after an edit, it is asked whether the changes may go; they are kept among the last programs", () => {
  const { workspace, choice } = opened(WITH_PICTURE);
  choice.detach(withoutPicture);
  workspace.edit("motor.left.target = 2\n");
  const changed = workspace.current.text;
  assert.equal(choice.choose("picture"), "ask");
  assert.deepEqual(choice.notice, { kind: "ask", language: "picture" });
  choice.keepText();
  assert.deepEqual([workspace.current.text, choice.shown], [changed, "text"]);
  choice.choose("picture");
  choice.undo();
  assert.deepEqual([workspace.current.text, choice.shown], [WITH_PICTURE, "picture"]);
  assert.ok(workspace.fileStore.recent().some(({ text }) => text === changed));
});

test("a text cannot become a picture: a new program is offered, and nothing changes", () => {
  const { workspace, choice } = opened(newAesl("a = 1\n"));
  const { text } = workspace.current;
  assert.equal(choice.choose("picture"), "new");
  assert.deepEqual([workspace.current.text, choice.shown, choice.notice], [text, "text", null]);
});

test("a picture that left does not come back into another document, or where it was settled", () => {
  const { workspace, choice } = opened(WITH_PICTURE);
  choice.detach(withoutPicture);
  choice.settle();
  assert.equal(choice.notice, null);
  choice.undo();
  assert.equal(workspace.current.text, withoutPicture(WITH_PICTURE));
  const other = opened(WITH_PICTURE);
  other.choice.detach(withoutPicture);
  other.workspace.open("b.aesl", newAesl("b = 1\n"));
  assert.deepEqual([other.choice.notice, other.choice.choose("picture")], [null, "new"]);
});

test("the whole file is set as one edit: unsaved, with a draft, in the same node", () => {
  const { workspace } = opened(WITH_PICTURE);
  workspace.replaceText(newAesl("x = 1\n"));
  assert.equal(workspace.code, "x = 1\n");
  assert.equal(workspace.fileStore.draft(workspace.tab)?.text, newAesl("x = 1\n"));
  assert.equal(workspace.isInRobot, false);
});
