import assert from "node:assert/strict";
import { test } from "node:test";

import { placeBeside } from "../../web_ui/ui/sheet.js";

const WINDOW = { width: 1280, height: 800 };
const SHEET = { width: 300, height: 200 };

test("a sheet is below its button, aligned at the side that has room", () => {
  assert.deepEqual(placeBeside(SHEET, { left: 100, top: 10, right: 144, bottom: 54 }, WINDOW), { left: 100, top: 62 });
  assert.deepEqual(placeBeside(SHEET, { left: 1200, top: 10, right: 1244, bottom: 54 }, WINDOW), { left: 944, top: 62 });
});

test("a sheet is above a button at the foot of the window", () => {
  assert.deepEqual(placeBeside(SHEET, { left: 20, top: 740, right: 64, bottom: 784 }, WINDOW), { left: 20, top: 532 });
});

test("a sheet stays inside a small window", () => {
  const { left, top } = placeBeside({ width: 300, height: 500 }, { left: 10, top: 300, right: 54, bottom: 344 }, { width: 320, height: 520 });
  assert.deepEqual([left, top], [10, 12]);
});
