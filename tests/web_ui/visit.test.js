import assert from "node:assert/strict";
import { test } from "node:test";

import { MotionSetting } from "../../web_ui/browser/motion_setting.js";
import { visitOptions } from "../../web_ui/browser/visit_options.js";

test("the address switches parts of the page on and off", () => {
  assert.deepEqual(visitOptions(""), { tour: null, welcome: null, scene: true });
  assert.deepEqual(visitOptions("?tour=off&welcome=on&scene=off"), { tour: false, welcome: true, scene: false });
  assert.equal(visitOptions("?tour=perhaps").tour, null);
});

test("movement is reduced by the system or by choice, which is kept", () => {
  /** @type {{ kept: string | null, calm: boolean | undefined, reports: number }} */
  const seen = { kept: null, calm: undefined, reports: 0 };
  const storage = {
    getItem: () => seen.kept,
    setItem: (/** @type {string} */ _key, /** @type {string} */ value) => void (seen.kept = value),
    removeItem: () => void (seen.kept = null),
  };
  const root = { toggleAttribute: (/** @type {string} */ _name, /** @type {boolean | undefined} */ on) => (seen.calm = on) === true };
  const system = /** @type {any} */ ({ matches: false, addEventListener: () => {} });
  const motion = new MotionSetting({ storage, systemIsCalm: system, root });
  motion.subscribe(() => (seen.reports += 1));
  assert.deepEqual([motion.isCalm, seen.calm], [false, false]);
  motion.choose(true);
  assert.deepEqual([motion.isCalm, seen.calm, seen.reports], [true, true, 1]);
  assert.equal(new MotionSetting({ storage, systemIsCalm: system, root }).isCalm, true);
  motion.choose(false);
  system.matches = true;
  assert.equal(motion.isCalm, true);
});
