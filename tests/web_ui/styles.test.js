// Style sheets that are loaded later must not restyle what another part of the page shows.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

const ROOT = new URL("../../web_ui/", import.meta.url);
/** Lazily loaded parts: their sheet, and the files and folders that belong to them. */
const PARTS = [
  { sheet: "blockly/view/blocks.css", own: ["blockly/view/"] },
  { sheet: "editor/editor.css", own: ["editor/", "python/", "hosts/program_host.js"] },
  { sheet: "python/python.css", own: ["python/", "hosts/program_host.js"] },
  { sheet: "program_tab/program.css", own: ["program_tab/", "hosts/program_host.js"] },
  { sheet: "class_tab/class_tab.css", own: ["class_tab/", "hosts/class_host.js"] },
  { sheet: "creator/creator.css", own: ["creator/", "hosts/creator_host.js"] },
  { sheet: "vpl/view/vpl.css", own: ["vpl/", "hosts/program_host.js"] },
  { sheet: "missions/missions.css", own: ["missions/", "hosts/mission_host.js"] },
  { sheet: "sharing/sharing.css", own: ["sharing/", "hosts/share_host.js"] },
  { sheet: "tour/tour.css", own: ["tour/", "hosts/tour_host.js"] },
  { sheet: "welcome/welcome.css", own: ["welcome/", "hosts/welcome_host.js"] },
];

/** Every script of the page. */
const SCRIPTS = readdirSync(ROOT, { recursive: true })
  .map(String)
  .filter((name) => name.endsWith(".js") && !/^(node_modules|dist)\b/.test(name));

/** @param {string} name */
function read(name) {
  return readFileSync(new URL(name, ROOT), "utf8");
}

/** Class names that a script writes. @param {string} script @returns {string[]} */
function classesOf(script) {
  const source = read(script);
  const attributes = [...source.matchAll(/\bclass(?:Name)?\s*[:=]\s*(["`])(.*?)\1/g)].map(([, , words]) => words);
  const lists = [...source.matchAll(/classList\.\w+\(([^)]*)\)/g)].flatMap(([, given]) => given.match(/"[\w-]+"/g) ?? []);
  return [...attributes, ...lists].flatMap((words) => words.replace(/\$\{[^}]*\}/g, " ").match(/[\w-]+/g) ?? []);
}

/** Selectors of a sheet. @param {string} sheet */
function selectorsOf(sheet) {
  const rules = read(sheet)
    .replace(/\/\*[^]*?\*\//g, "")
    .matchAll(/([^{}]+)\{/g);
  return [...rules]
    .map(([, head]) => head.trim())
    .filter((head) => !head.startsWith("@") && !/^(from|to|\d+%)$/.test(head))
    .flatMap((head) => head.split(/,(?![^(]*\))/).map((selector) => selector.trim()));
}

for (const { sheet, own } of PARTS) {
  test(`every rule of ${sheet} starts with a class of its own part`, () => {
    const foreign = new Set(
      SCRIPTS.filter((name) => !own.some((each) => name.startsWith(each))).flatMap((name) => classesOf(name)),
    );
    const selectors = selectorsOf(sheet);
    assert.ok(selectors.length > 0);
    const loose = selectors.filter((selector) => {
      const [first] = selector.split(/[\s>+~]/);
      const classes = [...first.matchAll(/\.([\w-]+)/g)].map(([, name]) => name);
      return !classes.some((name) => !foreign.has(name));
    });
    assert.deepEqual(loose, []);
  });
}

test("colors are written in the sheet of the tokens only", () => {
  const sheets = readdirSync(ROOT, { recursive: true })
    .map(String)
    .filter((name) => name.endsWith(".css") && !/^(node_modules|dist)\b/.test(name) && name !== "styles/tokens.css");
  assert.ok(sheets.length > 8);
  const found = sheets.flatMap((name) =>
    [...read(name).matchAll(/[:\s(](#[0-9a-f]{3,8}\b|(?:rgb|hsl)a?\()[^;]*/gi)].map(([text]) => `${name}: ${text.trim()}`),
  );
  assert.deepEqual(found, []);
});
