import assert from "node:assert/strict";
import { test } from "node:test";

import { Flashes } from "../../web_ui/scene/flash.js";
import { nudged, numberOf } from "../../web_ui/scene/tags.js";

test("dots show the number in a robot's name, else its place", () => {
  assert.deepEqual([numberOf("thymio_12", 3), numberOf("mia", 7), numberOf("red2b", 1), numberOf("t007", 1)], ["12", "7", "2", "7"]);
});

test("dots that would cover each other are moved apart, others stay", () => {
  const places = nudged([{ x: 100, y: 100 }, null, { x: 104, y: 101 }, { x: 300, y: 100 }]);
  assert.deepEqual(places, [{ x: 100, y: 100 }, null, { x: 104, y: 129 }, { x: 300, y: 100 }]);
});

test("a robot flashes when its program changes, not at the first one", () => {
  const flashes = new Flashes();
  /** @param {string} name */
  const state = (name) => /** @type {any} */ ({ programs: { anna: { state: "running", name, values: { bytecode_used: "12" } } } });
  assert.equal(flashes.of(state("one"), "anna", 0), 0);
  assert.equal(flashes.of(state("one"), "anna", 10), 0);
  assert.equal(flashes.of(state("two"), "anna", 1000), 1);
  const later = flashes.of(state("two"), "anna", 1200);
  assert.ok(later > 0 && later < 1);
  assert.equal(flashes.of(state("two"), "anna", 1500), 0);
  assert.equal(flashes.of(/** @type {any} */ ({ programs: {} }), "anna", 1500), 0);
});
