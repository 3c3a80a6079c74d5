import assert from "node:assert/strict";
import { test } from "node:test";

import { Drafts } from "../../web_ui/playground_tab/drafts.js";
import { newStorage } from "./support.js";

const DRAFT = { id: "a", title: "Mine", inFile: false, text: "{}" };

test("the draft that was changed last comes first", () => {
  const drafts = new Drafts(newStorage());
  drafts.keep(DRAFT);
  drafts.keep({ ...DRAFT, id: "b" });
  drafts.keep({ ...DRAFT, title: "Ours" });
  assert.deepEqual(drafts.list(), [
    { id: "a", title: "Ours", inFile: false },
    { id: "b", title: "Mine", inFile: false },
  ]);
  assert.equal(drafts.version, 3);
});

test("a removed draft leaves nothing", () => {
  const storage = newStorage();
  const drafts = new Drafts(storage);
  drafts.keep(DRAFT);
  drafts.remove("a");
  assert.equal(storage.kept.size, 0);
  assert.equal(drafts.read("a"), null);
});

test("a draft that another tab has changed stays beside the own one", () => {
  const storage = newStorage();
  const [one, other] = [new Drafts(storage), new Drafts(storage)];
  one.keep(DRAFT);
  assert.equal(other.read("a"), DRAFT.text);
  one.keep({ ...DRAFT, text: "of one" });
  one.keep({ ...DRAFT, text: "of one, later" });
  assert.equal(other.list().length, 1);
  other.keep({ ...DRAFT, text: "of the other" });
  assert.deepEqual(other.list().map(({ id }) => other.read(id)), ["of the other", "of one, later"]);
});

test("two tabs that change one draft by turns keep the last text of each, and no more drafts with each turn", () => {
  const storage = newStorage();
  const [one, other, third] = [new Drafts(storage), new Drafts(storage), new Drafts(storage)];
  one.keep(DRAFT);
  for (const drafts of [other, third]) drafts.read("a");
  third.keep({ ...DRAFT, text: "of the third" });
  for (let turn = 0; turn < 9; turn++) {
    one.keep({ ...DRAFT, text: `one ${turn}` });
    other.keep({ ...DRAFT, text: `other ${turn}` });
  }
  const texts = one.list().map(({ id }) => one.read(id));
  assert.deepEqual(texts.sort(), ["of the third", "one 8", "other 7", "other 8"]);
});

test("a full storage keeps no outdated draft, and the others", () => {
  const storage = newStorage();
  const drafts = new Drafts(storage);
  drafts.keep(DRAFT);
  drafts.keep({ ...DRAFT, id: "b" });
  const { setItem } = storage;
  storage.setItem = (key, value) => {
    if (value.length > 100) throw new Error("full");
    setItem(key, value);
  };
  assert.throws(() => drafts.keep({ ...DRAFT, text: "x".repeat(200) }));
  assert.deepEqual(drafts.list().map(({ id }) => id), ["b"]);
});

test("the draft of an earlier version is adopted", () => {
  const storage = newStorage({ "creator.draft": '{"title": "Old"}', "creator.draftSaved": "true" });
  const drafts = new Drafts(storage);
  const [{ id, title, inFile }] = drafts.list();
  assert.deepEqual([title, inFile, drafts.read(id)], ["Old", true, '{"title": "Old"}']);
  assert.equal(storage.getItem("creator.draft"), null);
});

test("invalid content of the storage is ignored", () => {
  for (const text of ["{", "3", '[{"id": 3}, null]']) {
    assert.deepEqual(new Drafts(newStorage({ "creator.drafts": text, "creator.draft": "{" })).list(), []);
  }
});
