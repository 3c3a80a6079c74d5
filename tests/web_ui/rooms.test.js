// The folders of the page import each other in one direction.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, posix } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const PAGE = fileURLToPath(new URL("../../web_ui/", import.meta.url));
const NOT_SOURCES = /^(?:node_modules|dist)\//;
/** Imports and dynamic imports, but not those of types in comments. */
const IMPORT = /^(?:import|export)\b[^;"(]*"(\.[^"]+)";|\bimport\("(\.[^"]+)"\)(?!\.)/gm;

/** The folder of a module; that of `main.js` is ".". @param {string} module */
const roomOf = (module) => (module.includes("/") ? module.split("/")[0] : ".");

/** Every import between rooms. */
function importsBetweenRooms() {
  const modules = readdirSync(PAGE, { recursive: true, encoding: "utf8" })
    .map((path) => path.replaceAll("\\", "/"))
    .filter((path) => path.endsWith(".js") && !NOT_SOURCES.test(path));
  return modules.flatMap((module) =>
    [...readFileSync(PAGE + module, "utf8").matchAll(IMPORT)]
      .map(([, fixed, lazy]) => posix.join(dirname(module), fixed ?? lazy))
      .filter((imported) => imported.endsWith(".js") && roomOf(imported) !== roomOf(module))
      .map((imported) => ({ module, imported })),
  );
}

test("no two rooms need each other", () => {
  let left = importsBetweenRooms();
  assert.ok(left.length > 100);
  for (;;) {
    const importing = new Set(left.map(({ module }) => roomOf(module)));
    const next = left.filter(({ imported }) => importing.has(roomOf(imported)));
    if (next.length === left.length) break;
    left = next;
  }
  assert.deepEqual(left, []); // else: rooms of a circle, and those that import them
});
