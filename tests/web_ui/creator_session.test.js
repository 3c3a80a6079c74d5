// What the creator keeps: drafts, files and texts.

import assert from "node:assert/strict";
import { test } from "node:test";

import { newPlayground } from "../../web_ui/creator/commands.js";
import creatorTexts from "../../web_ui/i18n/creator.texts.js";
import { learnParts, partsOf } from "../../web_ui/playground/parts.js";
import { shapeKinds } from "../../web_ui/playground/kinds/index.js";
import { session, titled } from "./creator_support.js";

/** An answer that only a simulator can give: a wall that is longer than its ends are apart. */
const DRAWN = JSON.stringify([
  { primitives: [{ type: "solid", pose: { x: 0.3, y: 0, yaw: 0 }, size: [0.7, 0.02], height: 0.12, color: "#8a97a5" }] },
]);

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

test("what is shown is asked for once, not again before the answer, and drawn as the simulator answers", async () => {
  const { one } = session();
  /** @type {((value: boolean) => void)[]} */ const answers = [];
  /** @type {number[]} */ const asked = [];
  one.learn = (items) => {
    asked.push(items.filter((item) => !partsOf(item).isKnown).length);
    return new Promise((resolve) => answers.push(resolve));
  };
  await one.ask();
  assert.deepEqual(asked, [], "the sample and the ground are known");
  one.model.choose("wall");
  one.model.placing?.hover([-0.3, 0.2], false);
  one.model.placing?.put();
  one.model.placing?.hover([0.3, 0.2], false);
  const asking = one.ask();
  await one.ask();
  assert.deepEqual(asked, [1], "the wall that is being placed");
  one.model.placing?.put();
  const { world } = one;
  assert.ok(await learnParts(one.model.playground.items, async () => DRAWN));
  answers[0](true);
  await asking;
  assert.notEqual(one.world, world);
  assert.equal(one.world.markers.get("solid/wall_1/1")?.scale.x, 0.7);
  one.keep();
});
