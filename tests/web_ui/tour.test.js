import assert from "node:assert/strict";
import { test } from "node:test";

import tourTexts from "../../web_ui/i18n/tour.texts.js";
import { placed } from "../../web_ui/tour/place.js";
import { STEPS } from "../../web_ui/tour/steps.js";
import { tourOf } from "../../web_ui/hosts/tour_host.js";

/** @param {string | null} kept */
const storage = (kept) => ({ getItem: () => kept });

test("the tour is offered at a first visit, and never again once it was closed", () => {
  assert.equal(tourOf({ search: "", storage: storage(null), entry: null }), "offered");
  assert.equal(tourOf({ search: "?token=abc", storage: storage("closed"), entry: null }), "closed");
  assert.equal(tourOf({ search: "", storage: storage(null), entry: { tour: "closed" } }), "closed"); // nothing can be stored
});

test("the address overrides the stored choice", () => {
  assert.equal(tourOf({ search: "?token=abc&tour=off", storage: storage(null), entry: null }), "closed");
  assert.equal(tourOf({ search: "?tour=on", storage: storage("closed"), entry: { tour: "closed" } }), "open");
});

test("every step of the tour has its texts", () => {
  assert.equal(STEPS.length, 5);
  for (const { name } of STEPS) assert.ok(name in tourTexts.en && `${name}.text` in tourTexts.en, name);
});

test("the card is beside its target, and always inside the window", () => {
  const card = { width: 320, height: 170 };
  const targets = [
    { left: 14, top: 600, width: 160, height: 160 },
    { left: 900, top: 8, width: 120, height: 34 },
    { left: 1230, top: 300, width: 38, height: 38 },
    { left: 960, top: 770, width: 300, height: 28 },
  ];
  for (const window of [
    { width: 1280, height: 800 },
    { width: 1280, height: 650 },
  ]) {
    for (const target of targets) {
      const { left, top } = placed(card, target, window);
      assert.ok(left >= 0 && top >= 0 && left + card.width <= window.width && top + card.height <= window.height);
      const apart =
        left >= target.left + target.width ||
        left + card.width <= target.left ||
        top >= target.top + target.height ||
        top + card.height <= target.top;
      assert.ok(apart, JSON.stringify(target));
    }
  }
});

test("on a large target the card is in its upper part, without a target in the center of the window", () => {
  const card = { width: 300, height: 200 };
  const window = { width: 1000, height: 800 };
  const view = { left: 0, top: 60, width: 1000, height: 740 };
  assert.deepEqual(placed(card, view, window), { left: 350, top: 88 });
  assert.deepEqual(placed(card, null, window), { left: 350, top: 300 });
  assert.deepEqual(placed(card, null, { width: 200, height: 100 }), { left: 8, top: 8 });
});
