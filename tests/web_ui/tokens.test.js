// The design tokens: both dark blocks are equal, every variable that a sheet uses exists, and all pairs have contrast.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

const ROOT = new URL("../../web_ui/", import.meta.url);
const TOKENS = readFileSync(new URL("styles/tokens.css", ROOT), "utf8").replace(/\/\*[^]*?\*\//g, "");
/** Text, its ground, and the least ratio: 4.5 for text, 3 for borders of controls (WCAG 2.2). */
const PAIRS = /** @type {[string, string, number][]} */ ([
  ...["card", "bg", "sunk", "raise"].flatMap((ground) =>
    ["ink", "ink-2", "ink-3"].map((text) => /** @type {[string, string, number]} */ ([text, ground, 4.5])),
  ),
  ...["you", "sense", "act", "run", "wait", "stop"].flatMap(
    (color) =>
      /** @type {[string, string, number][]} */ ([
        [color, "card", 4.5],
        [color, `${color}-soft`, 4.5],
      ]),
  ),
  ["on-you", "you", 4.5],
  ["on-you", "you-hover", 4.5],
  ["on-run", "run-fill", 4.5],
  ["on-stop", "stop-fill", 4.5],
  ["on-stop", "stop-hover", 4.5],
  ["ink", "stop-soft", 4.5],
  ["edge", "card", 3],
  ["sense-line", "card", 3],
  ["act-line", "card", 3],
  ...["c-key", "c-num", "c-com", "c-ev", "c-fn"].map(
    (color) => /** @type {[string, string, number]} */ ([color, "card", 4.5]),
  ),
]);

/** The declarations of the block that starts with `head`. @param {string} head @returns {Record<string, string>} */
function block(head) {
  const start = TOKENS.indexOf(head);
  assert.ok(start >= 0, head);
  const inside = TOKENS.slice(TOKENS.indexOf("{", start) + 1, TOKENS.indexOf("}", start));
  return Object.fromEntries([...inside.matchAll(/([\w-]+):\s*([^;]+);/g)].map(([, name, value]) => [name, value.trim()]));
}

const LIGHT = block(":root {");
const DARK = block(':root[data-theme="dark"] {');

/** Relative luminance of #rrggbb. @param {string} hex */
function luminance(hex) {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const share = parseInt(hex.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** @param {string} one @param {string} other */
function ratio(one, other) {
  const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

test("the dark theme is the same by choice and by the system", () => {
  assert.deepEqual(block(":root:not([data-theme]) {"), DARK);
});

test("the dark theme only changes what the light one defines", () => {
  assert.deepEqual(
    Object.keys(DARK).filter((name) => !(name in LIGHT)),
    [],
  );
});

for (const [theme, values] of /** @type {const} */ ([
  ["light", LIGHT],
  ["dark", { ...LIGHT, ...DARK }],
])) {
  test(`every pair has contrast in the ${theme} theme`, () => {
    const weak = PAIRS.map(([text, ground, least]) => {
      const found = ratio(values[`--${text}`], values[`--${ground}`]);
      return found < least ? `${text} on ${ground}: ${found.toFixed(2)}, expected ${least}` : "";
    });
    assert.deepEqual(weak.filter(Boolean), []);
  });
}

test("every variable that a sheet uses is defined, in a sheet or by a script", () => {
  const files = readdirSync(ROOT, { recursive: true })
    .map(String)
    .filter((name) => /\.(css|js)$/.test(name) && !/^(node_modules|dist)\b/.test(name));
  /** @param {string} end */
  const read = (end) => files.filter((name) => name.endsWith(end)).map((name) => readFileSync(new URL(name, ROOT), "utf8"));
  const sheets = read(".css");
  const declared = sheets.flatMap((sheet) => [...sheet.matchAll(/(--[\w-]+)\s*:/g)].map(([, name]) => name));
  const set = read(".js").flatMap((script) => [...script.matchAll(/["`](--[\w-]+)["`:]/g)].map(([, name]) => name));
  const defined = new Set([...declared, ...set]);
  const used = sheets.flatMap((sheet) => [...sheet.matchAll(/var\((--[\w-]+)\s*\)/g)].map(([, name]) => name));
  assert.deepEqual([...new Set(used)].filter((name) => !defined.has(name)), []);
});
