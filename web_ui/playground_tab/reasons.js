// Why a playground was rejected, as phrases for the page's languages. There are two sources: the Fault of the page's own
// reader, and the English message of the simulator, which reads other formats too. Pure.

import { parse } from "../playground/document.js";
import { Fault } from "../playground/rules.js";

/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/**
 * @typedef {object} Reason
 * @property {Phrase} phrase      what is wrong
 * @property {Phrase | null} place   the item or the line, if it is known
 * @property {string} technical   location, what was found, and what was expected; in English
 */
/** @typedef {{ place: string, found: string, expected: string }} Refusal */

/** Expectations that only a file of another kind violates. */
const FOREIGN = /^(?:JSON\b.*|XML|UTF-8 text|an object|<aseba-playground>|a complete zip archive|a plain zip archive|one world\.xml.*)$/s;
/** Keys of this project's files: a broken file with one of them is a damaged playground. */
const OWN_KEYS = /"(?:format|shapes|robots)"\s*:/;
/** Keys of the files of another simulator (thymio_sim_ros/sim/playground/importers/thesis.py). */
const OTHER_KEYS = ["playground", "planes", "thymios"];
const ITEM = /\b(shapes|robots)\[(\d+)\]\.?(.*)$/s;

/** What the simulator expects, and the phrase that says it. The first that fits counts. */
const EXPECTED = /** @type {[RegExp, (match: RegExpExecArray) => Phrase][]} */ ([
  [/^a number of (.+?) from (\S+) to (\S+)$/, ([, unit, low, high]) => number(unit, low, high)],
  [/^a number above (\S+)$/, ([, low]) => ({ word: "fault.above", values: { low } })],
  [/^(?:a number|finite numbers)$/, () => ({ word: "fault.digits" })],
  [/^one line of text, at most (\d+)/, ([, longest]) => ({ word: "fault.line", values: { longest } })],
  [/^a title$/, () => ({ word: "fault.missing", values: { key: "title" } })],
  [/^a ROS name/, () => ({ word: "fault.name" })],
  [/^a (?:CSS )?color/, () => ({ word: "fault.shade" })],
  [/^(\d+) to (\d+) points/, ([, fewest, most]) => ({ word: "fault.points", values: { fewest, most } })],
  [/^\[x, y\] in m$/, () => ({ word: "fault.point" })],
  [/^true or false$/, () => ({ word: "fault.flag" })],
  [/^a language code/, () => ({ word: "fault.language" })],
  [/^a unique name$/, () => ({ word: "fault.ownName" })],
  [/^a free position$/, () => ({ word: "fault.free" })],
  [/^(?:the name of a door|a declared door)/, () => ({ word: "fault.door" })],
  [/^at most (\d+)$/, ([, most]) => ({ word: "fault.most", values: { most } })],
  [/^a smaller file$/, () => ({ word: "fault.large" })],
  [/\b(?:image|images|PNG|SVG|svg|base64|viewBox|pixels?)\b/, () => ({ word: "fault.image" })],
  [/^(?:a simpler playground|fewer|shorter)/, () => ({ word: "fault.tooMuch" })],
  [/^(?:a list|an object)/, () => ({ word: "fault.list" })],
  [/^the name of one, as /, () => ({ word: "fault.several" })],
  [/^0 or at least half of the width/, () => ({ word: "fault.radius" })],
  [/^room for the arcs/, () => ({ word: "fault.corners" })],
  [/^two different points$/, () => ({ word: "fault.places" })],
]);

/**
 * Split the text of a rejection into its parts; null if it has another form.
 *
 * @param {string} text
 * @returns {Refusal | null}
 */
export function refusalOf(text) {
  const match = /^(?:([\s\S]*?): )?found ([\s\S]*?), expected ([\s\S]*)$/.exec(text);
  return match === null ? null : { place: match[1] ?? "", found: match[2], expected: match[3] };
}

/** The playgrounds of an archive with several, of which one is to be chosen; none for another rejection. @param {string} text */
export function partsOf(text) {
  const found = /found \d+ playgrounds in the archive \((.*)\)(?:, none of them .*)?, expected the name of one/s.exec(text);
  return found === null ? [] : /** @type {string[]} */ (JSON.parse(`[${found[1]}]`));
}

/**
 * Whether a rejected file is of another kind, rather than a playground with an error.
 *
 * @param {Refusal | null} refusal
 */
export function isForeign(refusal) {
  if (refusal === null) return false;
  const { place, expected } = refusal;
  return place === "format" || (FOREIGN.test(expected) && /^(?:line \d+(?:, column \d+)?)?$/.test(place));
}

/**
 * The reason of the simulator. With the text of the file the page reads it too, and knows more about the item.
 *
 * @param {import("../state/index.js").Fault} fault
 * @param {string | null} text  of the file, if it is at hand
 * @returns {Reason}
 */
export function reasonOfMessage({ text: message, line, column }, text = null) {
  const at = line === null ? "" : `line ${line}, column ${column ?? 1}: `;
  const technical = `${at}${message}`;
  if (text !== null) {
    if (text.trim() === "") return { phrase: { word: "fault.empty" }, place: null, technical };
    const own = faultOf(text);
    if (own !== null && (OWN_KEYS.test(text) || !isWhole(own))) return { ...reasonOfFault(own, text), technical };
  }
  const refusal = refusalOf(message);
  if (refusal === null) return { phrase: { word: "fault.other" }, place: null, technical };
  if (isForeign(refusal)) return { phrase: { word: "fault.json" }, place: null, technical };
  const { list, item, key } = placeOf(refusal.place);
  const phrase = phraseOf(refusal, key);
  if (text !== null && list !== null) return { ...reasonOfFault(new Fault(refusal.place, refusal.found, phrase), text), technical };
  return { phrase: { ...phrase, values: { key, ...phrase.values } }, place: item ?? lineOf(line, refusal.place), technical };
}

/**
 * The reason of the page's reader.
 *
 * @param {Fault} fault
 * @param {string} text  of the file
 * @returns {Reason}
 */
export function reasonOfFault(fault, text) {
  const { key, found, expected } = fault;
  const limits = Object.entries(expected.values ?? {}).map(([name, value]) => ` ${name} ${value}`);
  const technical = `${key === "" ? "" : `${key}: `}found ${found}, expected ${expected.word.replace("fault.", "")}${limits}`;
  if (isWhole(fault)) return { phrase: { word: wholeWord(text) }, place: null, technical };
  const { list, index, key: rest } = placeOf(key);
  const item = list === null ? null : memberOf(text, list, index);
  const kind = list === "robots" ? "robot" : String(item?.kind ?? "");
  const phrase = { word: found === "–" ? "fault.missing" : expected.word, values: { kind, key: rest, ...expected.values } };
  if (list === null) return { phrase, place: null, technical };
  const name = typeof item?.name === "string" ? item.name : "";
  const place = kind === "" || name === "" ? itemPhrase(list, index) : { word: "fault.item", values: { kind, name } };
  return { phrase, place, technical };
}

/**
 * A reason in one sentence.
 *
 * @param {import("../playground/labels.js").Labels} labels
 * @param {Reason} reason
 */
export function sentenceOf(labels, { phrase, place }) {
  const text = labels.text(phrase);
  return place === null ? text : labels.t("fault.at", { place: labels.text(place), text });
}

/** @param {string} text @returns {Fault | null} */
function faultOf(text) {
  try {
    parse(text);
    return null;
  } catch (error) {
    return error instanceof Fault ? error : null;
  }
}

/** Whether the file as a whole is wrong. @param {Fault} fault */
function isWhole({ key, expected }) {
  return expected.word === "fault.json" || (key === "" && expected.word === "fault.object") || key === "format";
}

/** What a file is that this page cannot read. @param {string} text */
function wholeWord(text) {
  if (text.trim() === "") return "fault.empty";
  const data = jsonOf(text);
  if (data === undefined) return OWN_KEYS.test(text) ? "fault.broken" : "fault.json";
  const isOther = typeof data === "object" && data !== null && OTHER_KEYS.some((key) => key in data) && !("format" in data);
  return isOther ? "fault.foreign" : "fault.json";
}

/** @param {string} text @returns {any}  undefined: no JSON */
function jsonOf(text) {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}

/** An item of the file. @param {string} text @param {string} list @param {number} index */
function memberOf(text, list, index) {
  return /** @type {Record<string, unknown> | null | undefined} */ (jsonOf(text)?.[list]?.[index]);
}

/** The item and the rest of a location. @param {string} place */
function placeOf(place) {
  const match = ITEM.exec(place);
  if (match === null) return { list: null, index: 0, item: null, key: /^[\w.[\]]*$/.test(place) ? place : "" };
  const [, list, index, key] = match;
  return { list, index: Number(index), item: itemPhrase(list, Number(index)), key: key.replace(/[()]/g, "") };
}

/** @param {string} list @param {number} index @returns {Phrase} */
function itemPhrase(list, index) {
  return { word: list === "robots" ? "fault.robot" : "fault.thing", values: { number: index + 1 } };
}

/** @param {number | null} line @param {string} place @returns {Phrase | null} */
function lineOf(line, place) {
  const found = line ?? /\bline (\d+)/.exec(place)?.[1] ?? null;
  return found === null ? null : { word: "fault.row", values: { line: found } };
}

/** @param {Refusal} refusal @param {string} key @returns {Phrase} */
function phraseOf({ found, expected }, key) {
  if (found === "nothing") return { word: "fault.missing" };
  if (found === "an unknown key") return { word: "fault.known" };
  if (key === "kind") return { word: "fault.kind" };
  for (const [pattern, phrase] of EXPECTED) {
    const match = pattern.exec(expected);
    if (match !== null) return phrase(match);
  }
  return { word: "fault.other" };
}

/** @param {string} unit @param {string} low @param {string} high @returns {Phrase} */
function number(unit, low, high) {
  return { word: "fault.number", values: { unit, low, high } };
}
