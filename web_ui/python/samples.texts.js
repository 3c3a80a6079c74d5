// Evaluated when the page is built (vite.config.js): the page gets the value.

import { readFileSync } from "node:fs";

const NAMES = /** @type {const} */ (["first", "empty"]);

export default /** @type {Record<typeof NAMES[number], string>} */ (
  Object.fromEntries(NAMES.map((name) => [name, readFileSync(new URL(`samples/${name}.py`, import.meta.url), "utf8")]))
);
