import assert from "node:assert/strict";
import { test } from "node:test";

import { isLow, layoutOf, workRange, workWidth } from "../../web_ui/ui/layout.js";
import { Workspace } from "../../web_ui/shell/workspace.js";
import { newStorage } from "./support.js";

test("layouts by width", () => {
  assert.deepEqual([390, 600, 899, 900, 1024, 1180, 1181, 1280].map(layoutOf), [
    "phone",
    "single",
    "single",
    "narrow",
    "narrow",
    "narrow",
    "wide",
    "wide",
  ]);
  assert.deepEqual([650, 719, 720, 800].map(isLow), [true, true, false, false]);
});

test("the stage keeps at least 480 px, the workspace at most 60 %", () => {
  assert.deepEqual(workRange(1280), { least: 360, most: 768 });
  assert.deepEqual(workRange(900), { least: 360, most: 420 });
  assert.equal(workWidth(1280, 752, null), 752);
  assert.equal(workWidth(1280, 480, 2000), 768);
  assert.equal(workWidth(1280, 480, 10), 360);
  assert.equal(workWidth(1024, 752, null), 416, "tablets: one width for all tabs");
  assert.equal(workWidth(1024, 752, 500), 500);
});

test("the first visit is closed; the tab is kept", () => {
  const kept = newStorage();
  const first = new Workspace(kept);
  assert.deepEqual([first.tab, first.screen], [null, "drive"]);
  first.select("program");
  assert.equal(new Workspace(kept).tab, "program");
  first.select(null);
  assert.equal(new Workspace(kept).tab, null);
});

test("each tab keeps its own width", () => {
  const workspace = new Workspace(newStorage());
  workspace.select("robot");
  workspace.setWidth(500.4);
  workspace.select("program");
  assert.deepEqual([workspace.chosenWidth("robot"), workspace.chosenWidth("program")], [500, null]);
  workspace.select("robot");
  workspace.setWidth(null);
  assert.equal(workspace.chosenWidth("robot"), null);
});

test("the class is offered with several robots, and left with the last but one", () => {
  const workspace = new Workspace(newStorage());
  let reports = 0;
  workspace.subscribe(() => (reports += 1));
  workspace.select("class");
  assert.deepEqual([workspace.tab, reports], [null, 0]);
  workspace.offerClass(true);
  workspace.select("class");
  workspace.offerClass(false);
  assert.deepEqual([workspace.tab, reports], ["robot", 3]);
});

test("a kept class tab waits until there are several robots", () => {
  const workspace = new Workspace(newStorage({ "workspace.tab": "class" }));
  assert.equal(workspace.tab, null);
  workspace.offerClass(true);
  assert.equal(workspace.tab, "class");
});
