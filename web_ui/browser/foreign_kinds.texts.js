// Evaluated when the page is built (vite.config.js): the page gets the value.

import { readFileSync } from "node:fs";

import { readTexts } from "../i18n/read_texts.js";

const KINDS = new URL("../../aseba_vm/aesl/foreign_kinds.json", import.meta.url);

/** What files of other programs contain, and the sentence about each kind by language. */
export default {
  kinds: JSON.parse(readFileSync(KINDS, "utf8")),
  sentences: Object.fromEntries(
    Object.entries(readTexts("compiler")).map(([language, table]) => [
      language,
      Object.fromEntries(Object.entries(table).filter(([key]) => key.startsWith("foreign-"))),
    ]),
  ),
};
