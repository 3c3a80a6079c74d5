import assert from "node:assert/strict";
import { test } from "node:test";

import { FlatView } from "../../web_ui/scene/flat.js";

const CORNERS = /** @type {any[]} */ ([{ x: -1, y: -0.5, z: 0 }, { x: 1, y: 0.5, z: 0.2 }]);

/** Where the corners are in a picture of this size, in CSS pixels from its upper left corner. */
function shown(/** @type {number} */ width, /** @type {number} */ height, /** @type {any} */ covered) {
  const canvas = /** @type {any} */ ({ clientWidth: width, clientHeight: height, getContext: () => null });
  const view = new FlatView(canvas);
  view.aim(CORNERS, null, covered);
  const { position, left, right, top, bottom } = view.camera;
  return CORNERS.map(({ x, y }) => ({
    x: ((x - position.x - left) / (right - left)) * width,
    y: ((top - (y - position.y)) / (top - bottom)) * height,
  }));
}

test("the 2D view shows the whole world in what is not covered", () => {
  for (const [width, height] of [
    [800, 600],
    [390, 500],
    [640, 240],
  ]) {
    for (const covered of [{}, { top: 74 }, { top: 74, bottom: 60 }, { bottom: 120, left: 30 }]) {
      const { top = 0, right = 0, bottom = 0, left = 0 } = /** @type {Record<string, number>} */ (covered);
      const [lower, upper] = shown(width, height, covered);
      const where = JSON.stringify({ width, height, covered, lower, upper });
      assert.ok(lower.x >= left && upper.x <= width - right, where);
      assert.ok(upper.y >= top && lower.y <= height - bottom, where);
      assert.ok(Math.abs((lower.x + upper.x) / 2 - (left + width - right) / 2) < 0.01, where);
      assert.ok(Math.abs((lower.y + upper.y) / 2 - (top + height - bottom) / 2) < 0.01, where);
    }
  }
});
