// Words of Aseba text with their look, for the text beside the blocks, which is not edited. Pure.

/** @typedef {"" | "key" | "event" | "number" | "comment"} Look */
/** @typedef {{ text: string, look: Look }} Piece */

const KEYWORDS =
  "var|const|if|then|elseif|else|end|when|do|for|in|step|while|call|callsub|sub|onevent|emit|return|and|or|not|abs";
/** A comment; or a word before a name, blanks and the name; a keyword; a number. */
const WORD = new RegExp(
  `(#.*)|\\b(?:(onevent|emit|sub|callsub)([ ]+)([\\w.]+)|(${KEYWORDS})|(0x[\\da-f]+|\\d+))\\b`,
  "g",
);

/** The pieces of a line. @param {string} line @returns {Piece[]} */
export function pieces(line) {
  /** @type {Piece[]} */ const found = [];
  let at = 0;
  /** @param {string | undefined} text @param {Look} look */
  const add = (text, look) => {
    if (text) found.push({ text, look });
  };
  for (const match of line.matchAll(WORD)) {
    add(line.slice(at, match.index), "");
    const [all, comment, opening, blanks, name, keyword, number] = match;
    add(comment, "comment");
    add(opening, "key");
    add(blanks, "");
    add(name, "event");
    add(keyword, "key");
    add(number, "number");
    at = match.index + all.length;
  }
  add(line.slice(at), "");
  return found;
}
