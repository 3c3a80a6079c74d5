// Words of a line of Aseba, for its colors. Pure.

/** @typedef {"key" | "number" | "comment" | "event" | "call" | ""} WordKind */
/** @typedef {{ kind: WordKind, text: string }} Word */

const BRANCHES = "if then elseif else end when do for in step while";
const OTHERS = "var const onevent sub emit call callsub return and or not abs";
const KEYWORDS = new Set(`${BRANCHES} ${OTHERS}`.split(" "));
const WORDS = /(#.*$)|([A-Za-z_À-ÿ][\w.À-ÿ]*)|(\b\d+\b)|([^#A-Za-z_À-ÿ\d]+)/gm;

/** @param {string} line @returns {Word[]} */
export function wordsOf(line) {
  let before = "";
  return [...line.matchAll(WORDS)].map(([text, comment, name, number]) => {
    /** @type {WordKind} */ let kind = "";
    if (comment !== undefined) kind = "comment";
    else if (number !== undefined) kind = "number";
    else if (name !== undefined) {
      if (before === "onevent") kind = "event";
      else if (before === "call" || before === "callsub" || before === "sub") kind = "call";
      else if (KEYWORDS.has(name)) kind = "key";
      before = name;
    }
    return { kind, text };
  });
}
