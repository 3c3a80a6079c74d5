import assert from "node:assert/strict";
import { test } from "node:test";

import { makeBlock } from "../../web_ui/vpl/blocks.js";
import {
  changeBlock,
  copyRow,
  insertRow,
  moveBlock,
  moveRow,
  putBlock,
  removeBlock,
  removeRow,
  whyNot,
} from "../../web_ui/vpl/edits.js";
import { generate } from "../../web_ui/vpl/generator.js";
import { DEPTH, endSeries, newHistory, record, redo, undo } from "../../web_ui/vpl/history.js";
import { BLOCKS, MODES } from "../../web_ui/vpl/kinds.js";
import { lostIn, palette, withMode } from "../../web_ui/vpl/mode.js";
import { press, withBlockMode, withKey, withNote, withNumber } from "../../web_ui/vpl/parameters.js";
import { isEmptyRow, makeProgram, sameProgram } from "../../web_ui/vpl/program.js";
import { block, pick, program, randomBlock, randomNumbers, randomProgram } from "./vpl_programs.js";

/** @typedef {import("../../web_ui/vpl/program.js").Program} Program */

/** The rows in short: names of events and actions. @param {Program} program */
const names = ({ rows }) =>
  rows.map(({ event, actions }) => `${event?.name ?? "-"}: ${actions.map(({ name }) => name).join(" ")}`);

const TWO = program(
  "basic",
  [
    ["clap"],
    [
      ["move", 50, 50],
      ["colortop", 1, 2, 3],
    ],
  ],
  [["button", 1], [["move", 0, 0]]],
);

test("a program always ends with an empty row", () => {
  assert.deepEqual(names(makeProgram("basic")), ["-: "]);
  assert.deepEqual(names(TWO), ["clap: move colortop", "button: move", "-: "]);
  assert.deepEqual(names(removeRow(TWO, 2)), names(TWO));
});

test("a block is put into a row, and a program still ends with an empty row", () => {
  assert.deepEqual(names(putBlock(TWO, 2, makeBlock("prox"))), ["clap: move colortop", "button: move", "prox: ", "-: "]);
  assert.deepEqual(names(putBlock(TWO, 0, makeBlock("prox")))[0], "prox: move colortop");
  assert.deepEqual(names(putBlock(TWO, 1, makeBlock("sound")))[1], "button: move sound");
});

test("an action of a kind that the row has is refused, with the reason", () => {
  assert.equal(putBlock(TWO, 0, makeBlock("move")), TWO);
  assert.deepEqual(whyNot(TWO, 0, makeBlock("move")), { key: "edit.twice", values: { row: 1 } });
  assert.deepEqual(whyNot(TWO, 0, makeBlock("timer")), { key: "edit.advanced", values: { row: 1 } });
  assert.equal(whyNot(TWO, 9, makeBlock("move"))?.key, "edit.row");
});

test("blocks move, are copied, and change their order", () => {
  const action = /** @type {const} */ ({ row: 0, slot: "actions", index: 1 });
  assert.deepEqual(names(moveBlock(TWO, action, 1)).slice(0, 2), ["clap: move", "button: move colortop"]);
  assert.deepEqual(names(moveBlock(TWO, action, 1, { copy: true })).slice(0, 2), [
    "clap: move colortop",
    "button: move colortop",
  ]);
  assert.deepEqual(names(moveBlock(TWO, action, 0, { at: 0 }))[0], "clap: colortop move");
  assert.equal(moveBlock(TWO, { row: 0, slot: "actions", index: 0 }, 1), TWO);
  assert.deepEqual(names(moveBlock(TWO, { row: 0, slot: "event" }, 1)).slice(0, 2), ["-: move colortop", "clap: move"]);
});

test("a state filter is always copied, and emptied when it is removed", () => {
  const two = program("advanced", [["clap"], [["move"]], [1, 0, 0, 0]], [["timeout"], [["move"]]]);
  const copied = moveBlock(two, { row: 0, slot: "state" }, 1);
  assert.deepEqual(copied.rows[0].state, copied.rows[1].state);
  assert.deepEqual(removeBlock(copied, { row: 0, slot: "state" }).rows[0].state?.values, [0, 0, 0, 0]);
});

test("rows are inserted, removed, moved and copied", () => {
  assert.deepEqual(names(insertRow(TWO, 0)), ["-: ", ...names(TWO)]);
  assert.deepEqual(names(removeRow(TWO, 0)), ["button: move", "-: "]);
  assert.deepEqual(names(moveRow(TWO, 1, 0)), ["button: move", "clap: move colortop", "-: "]);
  assert.deepEqual(names(copyRow(TWO, 0, 1)), ["clap: move colortop", "clap: move colortop", "button: move", "-: "]);
});

test("the result of an editor replaces its block only", () => {
  const place = /** @type {const} */ ({ row: 0, slot: "actions", index: 0 });
  const changed = changeBlock(TWO, place, makeBlock("move", [500, -500]));
  assert.deepEqual(changed.rows[0].actions[0].values, [500, -500]);
  assert.equal(changed.rows[1], TWO.rows[1]);
  assert.equal(changeBlock(TWO, place, makeBlock("timer")), TWO);
});

test("a click shows the next state of a part; between exists in advanced mode only", () => {
  /** @param {boolean} advanced */
  const states = (advanced) => {
    let square = makeBlock("prox");
    return [1, 2, 3, 4].map(() => (square = press(square, 0, advanced)).values[0]);
  };
  assert.deepEqual(states(false), [1, 2, 0, 1]);
  assert.deepEqual(states(true), [1, 2, 3, 0]);
  assert.deepEqual(press(makeBlock("button", [1]), 0, false).values[0], 0);
  assert.throws(() => press(makeBlock("move"), 0, false), /found value 0, expected a choice/);
});

test("modes of a block start with their first key and no tilt", () => {
  const arrows = withBlockMode(makeBlock("button", [1, 1]), 1);
  assert.deepEqual(arrows.values, [0, 0, 0, 0, 0, 1, 4]);
  assert.deepEqual(withKey(arrows, 2).values[6], 2);
  assert.deepEqual(withBlockMode(arrows, 2).values[6], 0);
  assert.deepEqual(withBlockMode(withNumber(withBlockMode(makeBlock("acc"), 1), 1, -3), 0).values, [0, 0]);
});

test("sliders keep to their steps and ranges, and thresholds in order", () => {
  assert.deepEqual(withNumber(makeBlock("move"), 0, 333).values, [350, 0]);
  assert.deepEqual(withNumber(makeBlock("move"), 1, -900).values, [0, -500]);
  assert.deepEqual(withNumber(makeBlock("timer"), 0, 1620).values, [1500]);
  assert.deepEqual(withNumber(makeBlock("prox"), 8, 2399).values.slice(7), [1000, 2200]);
  assert.deepEqual(withNumber(makeBlock("prox"), 7, 3999).values.slice(7), [3600, 3600]);
  assert.deepEqual(withNumber(makeBlock("proxground"), 3, 99).values.slice(2), [75, 75]);
});

test("a note becomes long, silent and short again", () => {
  let melody = makeBlock("sound", [258]);
  const seen = [1, 2, 3].map(() => (melody = withNote(melody, 0, 2)).values[0]);
  assert.deepEqual(seen, [514, 517, 258]);
  assert.equal(withNote(makeBlock("sound", [514]), 0, 4).values[0], 516);
});

test("advanced mode adds state filters; leaving it lists what is lost", () => {
  assert.deepEqual(
    withMode(TWO, "advanced").rows.map(({ state }) => state?.values),
    Array(3).fill([0, 0, 0, 0]),
  );
  assert.deepEqual(lostIn(withMode(TWO, "advanced"), "basic"), []);
  assert.ok(sameProgram(withMode(withMode(TWO, "advanced"), "basic"), TWO));
  const rich = program(
    "advanced",
    [
      ["button", 0, 0, 0, 0, 0, 1, 2],
      [
        ["timer", 250],
        ["move", 50, 0],
      ],
      [1, 0, 0, 0],
    ],
    [["prox", 3, 1, 0, 0, 0, 0, 0, 800, 900], [["setstate", 1]]],
    [["acc", 1, 2], [["move"]]],
    [["timeout"], [["move"]]],
  );
  assert.deepEqual(
    lostIn(rich, "basic").map(({ row, key }) => `${row} ${key}`),
    [
      "0 mode.reset.button",
      "0 mode.state",
      "0 mode.removed.timer",
      "1 mode.reset.prox",
      "1 mode.removed.setstate",
      "2 mode.reset.acc",
      "3 mode.removed.timeout",
    ],
  );
  const basic = withMode(rich, "basic");
  assert.deepEqual(names(basic), ["button: move", "prox: ", "acc: move", "-: move", "-: "]);
  assert.deepEqual(basic.rows[1].event?.values, [2, 1, 0, 0, 0, 0, 0, 1000, 2000]);
  assert.deepEqual(lostIn(basic, "basic"), []);
});

test("the palettes", () => {
  assert.deepEqual(palette("event", "basic"), ["button", "prox", "proxground", "acc", "clap"]);
  assert.deepEqual(palette("action", "advanced"), ["move", "colortop", "colorbottom", "sound", "timer", "setstate"]);
  assert.deepEqual(palette("state", "basic"), []);
});

test("undo and redo, 50 steps, a gesture at a time", () => {
  let history = newHistory(TWO);
  for (let count = 0; count < DEPTH + 5; count++) history = record(history, insertRow(history.present, 0));
  const newest = history.present;
  for (let count = 0; count < DEPTH + 5; count++) history = undo(history);
  assert.equal(history.present.rows.length, TWO.rows.length + 5);
  for (let count = 0; count < DEPTH; count++) history = redo(history);
  assert.equal(history.present, newest);
  assert.deepEqual(redo(history).present, newest);

  history = newHistory(TWO);
  for (const speed of [50, 100, 150]) {
    const place = /** @type {const} */ ({ row: 1, slot: "actions", index: 0 });
    history = record(history, changeBlock(history.present, place, makeBlock("move", [speed, 0])), "speed");
  }
  assert.equal(undo(history).present, TWO);
  history = record(endSeries(history), insertRow(history.present, 0), "speed");
  assert.deepEqual(undo(history).present.rows[1].actions[0].values, [150, 0]);
  assert.equal(record(history, history.present), history);
});

test("impossible values become the default of a block", () => {
  assert.deepEqual(block(["prox", 9, -1, 3])?.values, [0, 0, 3, 0, 0, 0, 0, 1000, 2000]);
  assert.deepEqual(block(["move", 799, -77])?.values, [500, -50]);
  assert.deepEqual(block(["acc", 0, 5])?.values, [0, 0]);
  assert.deepEqual(block(["button", 1, 0, 0, 0, 0, 1, 7])?.values, [0, 0, 0, 0, 0, 1, 4]);
  assert.throws(() => makeBlock("fly"), /found block "fly", expected one of button, /);
});

test("extended mode has conditions, of what lasts, and they take the place of events", () => {
  const made = program(
    "extended",
    [
      ["clap"],
      [["move"]],
      undefined,
      [
        ["prox", 1],
        ["counter", 3, 2],
      ],
    ],
    [["acc", 1, 2], []],
  );
  assert.equal(whyNot(made, 0, makeBlock("clap"), "conditions")?.key, "edit.slot");
  assert.equal(whyNot(made, 0, makeBlock("counter"), "event")?.key, "edit.slot");
  assert.equal(whyNot(withMode(made, "advanced"), 0, makeBlock("prox"), "conditions")?.key, "edit.extended");
  assert.deepEqual(putBlock(made, 1, makeBlock("counter")).rows[1].conditions[0].values, [3, 0]);
  const moved = moveBlock(made, { row: 1, slot: "event" }, 0, { slot: "conditions", at: 0 });
  assert.deepEqual(
    moved.rows[0].conditions.map(({ name }) => name),
    ["acc", "prox", "counter"],
  );
  assert.equal(moved.rows[1].event, null);
  assert.equal(changeBlock(moved, { row: 0, slot: "conditions", index: 0 }, makeBlock("acc")), moved);
  assert.equal(removeBlock(moved, { row: 0, slot: "conditions", index: 1 }).rows[0].conditions.length, 2);
});

test("advanced mode drops what is extended, and says so", () => {
  const made = program(
    "extended",
    [["init"], [["play", 3], ["move"]]],
    [
      ["clap"],
      [
        ["setcounter", 2, 1],
        ["timer", 250],
      ],
      [1, 0, 0, 0],
      [
        ["counter", 2, 9],
        ["prox", 1],
      ],
    ],
  );
  assert.deepEqual(
    lostIn(made, "advanced").map(({ row, key }) => `${row} ${key}`),
    ["0 mode.removed.init", "0 mode.removed.play", "1 mode.condition", "1 mode.condition", "1 mode.removed.setcounter"],
  );
  const advanced = withMode(made, "advanced");
  assert.deepEqual(names(advanced), ["-: move", "clap: timer", "-: "]);
  assert.deepEqual(lostIn(advanced, "advanced"), []);
});

test("random edits keep every program whole", () => {
  const random = randomNumbers(3);
  for (let round = 0; round < 60; round++) {
    let made = randomProgram(random, MODES[round % 3]);
    for (let step = 0; step < 20; step++) {
      const size = made.rows.length + 1;
      const place = {
        row: pick(random, size),
        slot: /** @type {const} */ (["event", "state", "actions"])[pick(random, 3)],
        index: pick(random, 3),
      };
      const kinds = [...BLOCKS.keys()];
      const added = randomBlock(random, kinds[pick(random, kinds.length)]);
      const edits = [
        () => putBlock(made, place.row, added),
        () => removeBlock(made, place),
        () => moveBlock(made, place, pick(random, size), { at: pick(random, 4), copy: random() < 0.5 }),
        () => insertRow(made, pick(random, size)),
        () => removeRow(made, pick(random, size)),
        () => moveRow(made, pick(random, size), pick(random, size)),
        () => copyRow(made, pick(random, size), pick(random, size)),
        () => withMode(made, MODES[pick(random, 3)]),
      ];
      made = edits[pick(random, edits.length)]();
      assert.ok(isEmptyRow(made.rows[made.rows.length - 1]));
      for (const { state, conditions, actions } of made.rows) {
        assert.ok(made.mode === "extended" || conditions.length === 0);
        assert.equal(state !== null, made.mode !== "basic");
        assert.equal(new Set(actions.map(({ name }) => name)).size, actions.length);
      }
      if (made.mode === "basic")
        assert.deepEqual(
          lostIn(made, "basic").filter(({ key }) => !key.startsWith("mode.reset")),
          [],
        );
      generate(made);
    }
  }
});
