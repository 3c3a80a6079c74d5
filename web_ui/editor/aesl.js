// Reads .aesl files with source positions, so that an edit replaces only what changed and the rest stays byte for byte
// (docs/spec/aseba-language.md section 13).

import { AeslError, attributesOf, decoded, encoded, scan } from "./xml.js";

export { AeslError } from "./xml.js";

/** @typedef {import("./xml.js").Unit} Unit */
/** @typedef {{ from: number, to: number }} Span */
/** @typedef {Span & { name: string, value: number, written: Span | null }} Entry   written: the number; null: missing, so 0 */
/**
 * @typedef {object} Node
 * @property {string} name
 * @property {string} id
 * @property {Span} tag         span of its opening tag
 * @property {boolean} empty    whether it is written as <node …/>
 * @property {number} end       start of its closing tag
 * @property {Unit[]} units     characters of the code with their positions in the file
 * @property {string} code
 */
/**
 * @typedef {object} Aesl
 * @property {string} text
 * @property {Span & { inner: number, empty: boolean }} root
 * @property {Entry[]} events
 * @property {Entry[]} constants
 * @property {Node[]} nodes
 * @property {boolean} vpl      whether a node contains VPL data
 */

export const LEAST = -32768;
export const GREATEST = 32767;
/** Maximum number of words of an event (docs/aseba_ros.md, `limits.event_values`). */
export const LARGEST_EVENT = 258;
/** Elements in which editors store a VPL program. */
const VPL = ["ThymioVisualProgramming", "ThymioVPL", "vplroot"];
/** Names of the event that a program of VPL emits with the index of a row, each time the row has run. */
export const REPORTS = ["pair_run", "PairExecuted"];
const VPL_EVENTS = [
  { name: "pair_run", value: 1 },
  { name: "debug_log", value: 14 },
];

/**
 * A new file with this code for one Thymio.
 *
 * @param {string} [code]
 */
export function newAesl(code = "") {
  return [
    "<!DOCTYPE aesl-source>",
    "<network>",
    "<!--list of global events-->",
    "<!--list of constants-->",
    "<!--show keywords state-->",
    '<keywords flag="true"/>',
    "<!--node thymio-II-->",
    `<node nodeId="1" name="thymio-II">${encoded(code, false)}</node>`,
    "</network>",
    "",
  ].join("\n");
}

/**
 * Events that a program can use: those of the file, plus the implicit events of VPL in a VPL file.
 *
 * @param {Aesl} aesl
 * @returns {{ name: string, value: number }[]}
 */
export function allEvents({ events, vpl }) {
  const added = vpl ? VPL_EVENTS.filter(({ name }) => !events.some((event) => event.name === name)) : [];
  return [...events, ...added];
}

/** Whether a text looks like .aesl rather than bare Aseba code. @param {string} text */
export function looksLikeAesl(text) {
  return /^\uFEFF?\s*</.test(text);
}

/**
 * Parse a file. Throws AeslError with the position of the error.
 *
 * @param {string} text
 * @returns {Aesl}
 */
export function readAesl(text) {
  const root = { from: 0, to: 0, inner: 0, empty: false };
  /** @type {Aesl} */
  const aesl = { text, root, events: [], constants: [], nodes: [], vpl: false };
  let depth = 0;
  let rootSeen = false;
  /** @type {Node | null} */ let node = null;
  /** @type {Entry | null} */ let listed = null; // written as <event …></event>, if it is open still
  for (const part of scan(text)) {
    if (part.kind === "open") {
      if (depth === 0) {
        if (rootSeen) throw new AeslError(text, part.from, `found a second root element <${part.name}>, expected one root element`);
        rootSeen = true;
        if (part.name !== "network") throw new AeslError(text, part.from, `found <${part.name}>, expected <network>`);
        aesl.root = { from: part.from, to: text.length, inner: part.to, empty: part.closed };
      } else if (depth === 1 && part.name === "node") {
        const { name, nodeId } = attributesOf(text, part);
        node = {
          name: name?.value ?? "",
          id: nodeId?.value ?? "",
          tag: { from: part.from, to: part.to },
          empty: part.closed,
          end: part.to,
          units: [],
          code: "",
        };
        aesl.nodes.push(node);
      } else if (depth === 1 && part.name === "event") {
        aesl.events.push((listed = entry(text, part, "size", 0, GREATEST)));
      } else if (depth === 1 && part.name === "constant") {
        aesl.constants.push((listed = entry(text, part, "value", LEAST, GREATEST)));
      }
      if (depth > 2 && node !== null && VPL.includes(part.name)) aesl.vpl = true;
      if (!part.closed) depth += 1;
    } else if (part.kind === "close") {
      depth -= 1;
      if (depth === 0) aesl.root.to = part.from;
      if (depth === 1 && part.name === "node" && node !== null) node.end = part.from;
      if (depth === 1 && listed !== null) listed.to = part.to;
    } else if ((part.kind === "text" || part.kind === "cdata") && node !== null && depth === 2) {
      for (const unit of decoded(text, part)) node.units.push(unit); // too many for the arguments of one call
    }
    if (depth < 2) listed = null;
    if (depth < 2 && !(part.kind === "open" && part.name === "node")) node = null;
  }
  if (!rootSeen) throw new AeslError(text, text.length, "found the end of the file, expected <network>");
  for (const each of aesl.nodes) each.code = each.units.map(({ character }) => character).join("");
  return aesl;
}

/**
 * The file with new code in one of its nodes; only the difference is replaced.
 *
 * @param {string} text
 * @param {number} index  index of the node
 * @param {string} code
 */
export function withCode(text, index, code) {
  const { nodes } = readAesl(text);
  const { units, code: old, tag, empty } = nodes[index];
  if (code === old) return text;
  const newline = /\r\n/.test(text) ? "\r\n" : "\n";
  if (units.length === 0) {
    const inside = encoded(code, false, newline);
    if (!empty) return text.slice(0, tag.to) + inside + text.slice(tag.to);
    const open = text.slice(tag.from, tag.to).replace(/\s*\/>$/, ">");
    return `${text.slice(0, tag.from)}${open}${inside}</node>${text.slice(tag.to)}`;
  }
  let start = 0;
  while (start < old.length && start < code.length && old[start] === code[start]) start += 1;
  let end = 0;
  while (end < old.length - start && end < code.length - start && old.at(-1 - end) === code.at(-1 - end)) end += 1;
  while (start > 0 && start < units.length && units[start].from === units[start].to) start -= 1;
  while (end > 0 && units[old.length - end].from === units[old.length - end].to) end -= 1;
  const middle = code.slice(start, code.length - end);
  const gone = units.slice(start, old.length - end);
  const anchor = gone[0] ?? units[start - 1] ?? units[0];
  let result = "";
  let at = 0;
  /** @param {number} from @param {number} to @param {string} by */
  const replace = (from, to, by) => {
    result += text.slice(at, from) + by;
    at = to;
  };
  const put = encoded(middle, anchor.cdata, newline);
  if (gone.length === 0) {
    const place = start > 0 ? units[start - 1].to : units[0].from;
    replace(place, place, put);
  }
  gone.forEach(({ from, to }, position) => replace(from, to, position === 0 ? put : ""));
  result += text.slice(at);
  // If the kept CDATA and the insertion would form "]]>" together, the whole code is rewritten.
  if (!units.some(({ cdata }) => cdata) || isCode(result, index, code)) return result;
  return text.slice(0, tag.to) + encoded(code, false, newline) + text.slice(nodes[index].end);
}

/**
 * Whether a node of a file contains exactly this code.
 *
 * @param {string} text
 * @param {number} index
 * @param {string} code
 */
function isCode(text, index, code) {
  try {
    return readAesl(text).nodes[index]?.code === code;
  } catch {
    return false;
  }
}

/**
 * Insert text at the end of the root element, which may be written as <network/>.
 *
 * @param {string} text
 * @param {string} added
 */
export function withLast(text, added) {
  const { root } = readAesl(text);
  if (!root.empty) return text.slice(0, root.to) + added + text.slice(root.to);
  const open = text.slice(root.from, root.inner).replace(/\s*\/>$/, ">");
  return `${text.slice(0, root.from)}${open}\n${added}</network>${text.slice(root.inner)}`;
}

/**
 * Set an event or constant; new ones are appended, null removes one.
 *
 * @param {string} text
 * @param {"event" | "constant"} kind
 * @param {string} name
 * @param {number | null} value  size of an event, or value of a constant
 */
export function withEntry(text, kind, name, value) {
  const aesl = readAesl(text);
  if (aesl.root.empty && value !== null) return withEntry(withLast(text, ""), kind, name, value);
  const entries = kind === "event" ? aesl.events : aesl.constants;
  const attribute = kind === "event" ? "size" : "value";
  const old = entries.find((each) => each.name === name);
  if (old !== undefined) {
    if (value !== null && old.written !== null) return text.slice(0, old.written.from) + String(value) + text.slice(old.written.to);
    if (value !== null) {
      const at = old.from + `<${kind}`.length;
      return `${text.slice(0, at)} ${attribute}="${value}"${text.slice(at)}`;
    }
    const line = /\r?\n[ \t]*$/.exec(text.slice(0, old.from));
    return text.slice(0, old.from - (line?.[0].length ?? 0)) + text.slice(old.to);
  }
  if (value === null) return text;
  const element = `<${kind} ${attribute}="${value}" name="${encoded(name, false).replaceAll('"', "&quot;")}"/>`;
  const comment = `<!--list of ${kind === "event" ? "global events" : "constants"}-->`;
  const listed = text.indexOf(comment);
  const last = entries.at(-1)?.to ?? (listed < 0 ? aesl.root.inner : listed + comment.length);
  const newline = /\r\n/.test(text) ? "\r\n" : "\n";
  return `${text.slice(0, last)}${newline}${element}${text.slice(last)}`;
}

/**
 * @param {string} text
 * @param {import("./xml.js").Part} part
 * @param {string} attribute
 * @param {number} least
 * @param {number} greatest
 * @returns {Entry}
 */
function entry(text, part, attribute, least, greatest) {
  const attributes = attributesOf(text, part);
  const { name, [attribute]: number } = attributes;
  if (name === undefined) throw new AeslError(text, part.from, `<${part.name}>: found no attribute name, expected one`);
  if (number === undefined) return { from: part.from, to: part.to, name: name.value, value: 0, written: null };
  const value = Number(number.value);
  if (!/^[+-]?\d+$/.test(number.value.trim()) || value < least || value > greatest) {
    const expected = `expected a whole number from ${least} to ${greatest}`;
    throw new AeslError(text, number.from, `<${part.name}> ${attribute}: found '${number.value}', ${expected}`);
  }
  return { from: part.from, to: part.to, name: name.value, value, written: { from: number.from, to: number.to } };
}
