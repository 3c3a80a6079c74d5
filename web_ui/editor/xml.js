// A minimal XML parser for .aesl files with source positions: elements in order, attributes, characters.

/** @typedef {{ kind: "open" | "close" | "text" | "cdata" | "other", name: string, from: number, to: number, closed: boolean }} Part */
/** @typedef {{ character: string, from: number, to: number, cdata: boolean }} Unit  one UTF-16 unit and its source */
/** @typedef {{ value: string, from: number, to: number }} Attribute */

export class AeslError extends Error {
  /** @param {string} text @param {number} at @param {string} what */
  constructor(text, at, what) {
    super(what);
    this.name = "AeslError";
    const before = text.slice(0, at).split(/\r\n|\r|\n/);
    this.line = before.length;
    this.column = 1 + before[before.length - 1].length;
  }
}

const PART =
  /<!--[\s\S]*?-->|<\?[\s\S]*?\?>|<!\[CDATA\[[\s\S]*?\]\]>|<!DOCTYPE(?:[^>[]|\[[^\]]*\])*>|<\/([^\s<>/]+)\s*>|<([^\s<>/!?="']+)((?:\s+[^\s=<>/"']+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*)\s*(\/?)>|[^<]+/y;

/**
 * The parts of a text, properly nested. Throws AeslError if it is not XML.
 *
 * @param {string} text
 * @returns {Generator<Part>}
 */
export function* scan(text) {
  /** @type {{ name: string, from: number }[]} */ const open = [];
  PART.lastIndex = 0;
  let at = 0;
  while (at < text.length) {
    PART.lastIndex = at;
    const match = PART.exec(text);
    if (match === null) throw new AeslError(text, at, describeError(text, at));
    const [all, closing, opening, , slash] = match;
    const to = at + all.length;
    if (opening !== undefined) {
      if (slash === "") open.push({ name: opening, from: at });
      yield { kind: "open", name: opening, from: at, to, closed: slash !== "" };
    } else if (closing !== undefined) {
      const last = open.pop();
      if (last === undefined) throw new AeslError(text, at, `found </${closing}>, expected no closing tag: no element is open`);
      if (last.name !== closing) throw new AeslError(text, at, `found </${closing}>, expected </${last.name}>`);
      yield { kind: "close", name: closing, from: at, to, closed: false };
    } else {
      const kind = all.startsWith("<![CDATA[") ? "cdata" : all.startsWith("<") ? "other" : "text";
      if (kind === "text" && open.length === 0 && all.replace(/^\uFEFF/, "").trim() !== "")
        throw new AeslError(text, at, "found text outside of <network>, expected a tag or a comment");
      yield { kind, name: "", from: at, to, closed: false };
    }
    at = to;
  }
  const last = open.pop();
  if (last !== undefined) throw new AeslError(text, text.length, `found the end of the file, expected </${last.name}>`);
}

/** What is wrong with the markup at a position. @param {string} text @param {number} at */
function describeError(text, at) {
  if (text.startsWith("<!--", at)) return "found a comment without end, expected -->";
  const found = JSON.stringify(text.slice(at, at + 20));
  return `found ${found}, expected a tag; write '<' as &lt;`;
}

/** @param {string} text @param {Part} part @returns {Record<string, Attribute>} */
export function attributesOf(text, part) {
  /** @type {Record<string, Attribute>} */ const found = {};
  const source = text.slice(part.from, part.to);
  for (const match of source.matchAll(/([^\s=<>/"']+)\s*=\s*(?:"([^"]*)"|'([^']*)')/g)) {
    const raw = match[2] ?? match[3];
    const to = part.from + match.index + match[0].length - 1;
    const from = to - raw.length;
    const value = decoded(text, { kind: "text", name: "", from, to, closed: false })
      .map(({ character }) => character)
      .join("");
    found[match[1]] = { value, from, to };
  }
  return found;
}

const NAMED = /** @type {Record<string, string>} */ ({ lt: "<", gt: ">", amp: "&", quot: '"', apos: "'" });
const PIECE = /&(?:#x([0-9a-fA-F]+)|#(\d+)|(\w+));|\r\n|[\s\S]/g;

/**
 * The characters of a text or CDATA part. The second half of a surrogate pair from one entity has an empty source.
 *
 * @param {string} text
 * @param {Part} part
 * @returns {Unit[]}
 */
export function decoded(text, { kind, from, to }) {
  const cdata = kind === "cdata";
  const [start, end] = cdata ? [from + "<![CDATA[".length, to - "]]>".length] : [from, to];
  /** @type {Unit[]} */ const units = [];
  for (const match of text.slice(start, end).matchAll(cdata ? /\r\n|[\s\S]/g : PIECE)) {
    const at = start + match.index;
    const [piece, hexadecimal, decimal, name] = match;
    let characters = piece === "\r\n" || piece === "\r" ? "\n" : piece;
    if (name !== undefined) {
      if (!Object.hasOwn(NAMED, name)) throw new AeslError(text, at, `found &${name};, expected a known entity; write '&' as &amp;`);
      characters = NAMED[name];
    } else if (hexadecimal !== undefined || decimal !== undefined) {
      const code = hexadecimal !== undefined ? parseInt(hexadecimal, 16) : Number(decimal);
      if (code === 0 || code > 0x10ffff) throw new AeslError(text, at, `found ${piece}, expected the code of a character, from 1 to 10FFFF hexadecimal`);
      characters = String.fromCodePoint(code);
    } else if (piece === "&" && !cdata) throw new AeslError(text, at, "found '&', expected an entity; write '&' as &amp;");
    const after = at + piece.length;
    for (let index = 0; index < characters.length; index++) {
      units.push({ character: characters[index], from: index === 0 ? at : after, to: after, cdata });
    }
  }
  return units;
}

/**
 * Escape characters for a text or CDATA part.
 *
 * @param {string} characters
 * @param {boolean} cdata
 * @param {string} [newline]
 */
export function encoded(characters, cdata, newline = "\n") {
  const escaped = cdata
    ? characters.replaceAll("]]>", "]]]]><![CDATA[>")
    : characters.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
  return escaped.replaceAll("\n", newline);
}
