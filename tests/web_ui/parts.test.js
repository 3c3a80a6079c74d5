import assert from "node:assert/strict";
import { test } from "node:test";

import { BUTTON_PLACES, HEIGHT_M, LIGHTS, PARTS, PROXIMITY_PLACES } from "../../web_ui/scene/parts.js";

test("every light that a program can set is on the body", () => {
  /** @type {Record<string, number>} */ const counts = {};
  for (const { group } of LIGHTS) counts[group] = (counts[group] ?? 0) + 1;
  assert.deepEqual(counts, {
    circle: 8,
    buttons: 4,
    proximity: 8,
    ground: 2,
    temperature: 2,
    microphone: 1,
    remote: 1,
  });
  for (const name of ["top", "bottom_left", "bottom_right"]) assert.ok(PARTS.has(`led.${name}`));
});

test("left is where y is positive", () => {
  assert.ok(BUTTON_PLACES.left.y > 0);
  assert.ok(PROXIMITY_PLACES.left.y > 0 && PROXIMITY_PLACES.left.yaw > 0);
  assert.ok(PROXIMITY_PLACES.rear_left.y > 0);
});

test("the circle goes clockwise from the front", () => {
  const angles = LIGHTS.filter(({ group }) => group === "circle").map(({ place }) =>
    Math.atan2(place.y, place.x - 0.0489),
  );
  for (let index = 1; index < 8; index++) {
    const turn = (angles[index - 1] - angles[index] + 2 * Math.PI) % (2 * Math.PI);
    assert.ok(Math.abs(turn - Math.PI / 4) < 0.05, `${index}`);
  }
});

test("no part is outside the true size", () => {
  for (const [name, { x, y, z }] of PARTS) {
    assert.ok(x > -0.0315 && x < 0.082 && Math.abs(y) < 0.058 && z >= 0 && z <= HEIGHT_M + 0.001, name);
  }
});
