import assert from "node:assert/strict";
import { test } from "node:test";

import { Theme } from "../../web_ui/browser/theme.js";

/** @param {boolean} dark @param {string | null} kept */
function theme(dark, kept = null) {
  /** @type {{ data: string | null, change: () => void, matches: boolean, kept: string | null, reports: number }} */
  const seen = { data: null, change: () => {}, matches: dark, kept, reports: 0 };
  const made = new Theme({
    storage: {
      getItem: () => seen.kept,
      setItem: (_key, value) => void (seen.kept = value),
      removeItem: () => void (seen.kept = null),
    },
    systemIsDark: /** @type {any} */ ({
      get matches() {
        return seen.matches;
      },
      addEventListener: (/** @type {string} */ _type, /** @type {() => void} */ act) => void (seen.change = act),
    }),
    root: {
      setAttribute: (_name, value) => void (seen.data = value),
      removeAttribute: () => void (seen.data = null),
    },
  });
  made.subscribe(() => (seen.reports += 1));
  return { made, seen };
}

test("without a choice the page follows the system, also when it changes", () => {
  const { made, seen } = theme(true);
  assert.deepEqual([made.isDark, seen.data], [true, null]);
  seen.matches = false;
  seen.change();
  assert.deepEqual([made.isDark, seen.reports], [false, 1]);
});

test("a choice is kept and overrides the system", () => {
  const { made, seen } = theme(true);
  made.choose("light");
  assert.deepEqual([made.isDark, seen.data, seen.kept, seen.reports], [false, "light", "light", 1]);
  seen.change();
  assert.equal(seen.reports, 1);
  assert.equal(theme(true, "light").seen.data, "light");
  made.choose("system");
  assert.deepEqual([made.isDark, seen.data], [true, null]);
});

test("a kept value that is none of the choices counts as the system", () => {
  assert.equal(theme(false, "sepia").made.choice, "system");
});
