// What the creator keeps: drafts, files and texts.

import assert from "node:assert/strict";
import { test } from "node:test";

import { newPlayground } from "../../web_ui/creator/commands.js";
import creatorTexts from "../../web_ui/i18n/creator.texts.js";
import { shapeKinds } from "../../web_ui/playground/kinds/index.js";
import { session, titled } from "./creator_support.js";

test("what is built is kept and restored; a full storage is reported", () => {
  const { one, storage, again } = session();
  assert.equal(one.kept, "fresh");
  one.model.choose("box");
  one.model.placing?.hover([0.3, 0.3], false);
  one.model.placing?.put();
  one.keep();
  assert.equal(one.kept, "device");
  const next = again();
  assert.deepEqual(next.one.model.playground.items, one.model.playground.items);
  assert.equal(next.one.kept, "device");
  assert.equal(next.one.fileName, "Mine.json");
  storage.setItem = () => {
    throw new Error("full");
  };
  titled(next.one, "Ünser Feld!");
  next.one.keep();
  assert.equal(next.reported.at(-1), "status.noDraft");
  assert.equal(next.one.kept, "none");
  assert.equal(next.one.fileName, "Unser_Feld.json");
  next.one.model.undo();
  assert.ok(next.one.model.playground.items.some(({ name }) => name === "box_1"));
  clearTimeout(next.one.timer);
  clearTimeout(one.timer);
});

test("each playground is a draft of its own, which undo finds again; what was only opened is not kept", () => {
  const { one, drafts } = session();
  titled(one, "First");
  one.replacePlayground(newPlayground("Second"), { word: "change.new" });
  assert.deepEqual(drafts.list().map(({ title }) => title), ["First"]);
  one.keep();
  assert.equal(drafts.list().length, 1);
  titled(one, "Third");
  one.keep();
  assert.deepEqual(drafts.list().map(({ title }) => title), ["Third", "First"]);
  one.model.undo();
  one.model.undo();
  titled(one, "First again");
  one.keep();
  assert.deepEqual(drafts.list().map(({ title }) => title), ["First again", "Third"]);
  clearTimeout(one.timer);
});

test("the creator has texts for every shape and its fields", () => {
  for (const { name, fields } of shapeKinds()) {
    assert.ok(`kind.${name}` in creatorTexts.en, name);
    for (const key of Object.keys(fields)) assert.ok(`field.${key}` in creatorTexts.en, key);
  }
});

test("the saved state survives a reload, and a playground equal to its file counts as saved", () => {
  const { one, again } = session();
  titled(one, "Yours");
  one.keep();
  assert.equal(again().one.kept, "device");
  one.noteSaved();
  assert.equal(again().one.kept, "file");
  titled(one, "Ours");
  assert.equal(one.kept, "device");
  titled(one, "Yours");
  assert.equal(one.kept, "file");
  one.keep();
  assert.equal(again().one.kept, "file");
});
