// Evaluated when the page is built (vite.config.js): the page gets the value.

import { readdirSync, readFileSync } from "node:fs";

const FOLDER = new URL("./", import.meta.url);
const ENDING = ".xml";

/** Name → workspace, without indentation. */
export default /** @type {Record<string, string>} */ (
  Object.fromEntries(
    readdirSync(FOLDER)
      .filter((name) => name.endsWith(ENDING))
      .sort()
      .map((name) => [name.slice(0, -ENDING.length), readFileSync(new URL(name, FOLDER), "utf8").replace(/\n\s*/g, "\n")]),
  )
);
