// The rules of fields of playground files, as the Python dataclasses declare them (`declarations.json`), and the check
// of values by them. Pure.

import { BUILT_IN } from "./declarations.js";

/** @typedef {import("./declarations.js").DeclaredField} Field   a rule, and whether the field is required */
/** @typedef {Readonly<Record<string, Field>>} Fields */
/** @typedef {{ word: string, values?: Record<string, string | number> }} Phrase  a text key with the values to fill in */

/** Text keys of the expectations of texts; the others do not fit for a reason that only a plug-in's English says. */
const FORMATS = { line: "fault.line", name: "fault.name", color: "fault.shade" };

/** @type {Map<string, RegExp | null>} */ const PATTERNS = new Map();

/** A rejected value: location, what was found, and what was expected. */
export class Fault extends Error {
  /** @param {string} key @param {string} found @param {Phrase} expected */
  constructor(key, found, expected) {
    super(`${key}: found ${found}, expected ${expected.word}`);
    this.key = key;
    this.found = found;
    this.expected = expected;
  }
}

/**
 * Check the members of an object. Throws a Fault with the path of the wrong key.
 *
 * @param {Fields} fields
 * @param {unknown} data
 * @param {string} key
 */
export function check(fields, data, key) {
  if (typeof data !== "object" || data === null || Array.isArray(data)) {
    throw new Fault(key, describe(data), { word: "fault.object" });
  }
  const members = /** @type {Record<string, unknown>} */ (data);
  for (const name of Object.keys(members)) {
    if (!Object.hasOwn(fields, name))
      throw new Fault(join(key, name), `"${name}"`, {
        word: "fault.known",
        values: { names: Object.keys(fields).join(", ") },
      });
  }
  for (const [name, field] of Object.entries(fields)) {
    if (field.nullable && members[name] === null) continue;
    if (Object.hasOwn(members, name)) checkValue(field, members[name], join(key, name));
    else if (field.required) throw new Fault(join(key, name), "–", expectation(field));
  }
}

/** @param {Field} field @param {unknown} value @param {string} key */
export function checkValue(field, value, key) {
  if (field.type === "object") return check(field.fields ?? {}, value, key);
  if (
    field.type === "points" &&
    Array.isArray(value) &&
    value.length >= (field.fewest ?? 0) &&
    value.length <= (field.most ?? Infinity)
  ) {
    value.forEach((point, index) => {
      if (!Array.isArray(point) || point.length !== 2)
        throw new Fault(`${key}[${index}]`, describe(point), { word: "fault.point" });
      point.forEach((part, axis) => checkValue(BUILT_IN.coordinate, part, `${key}[${index}][${axis}]`));
    });
    return;
  }
  if (!fits(field, value)) throw new Fault(key, describe(value), expectation(field));
}

/**
 * Whether a value that is neither an object nor a list follows the rule of a field.
 *
 * @param {Field} field
 * @param {unknown} value
 */
export function fits({ type, low = -Infinity, high = Infinity, pattern, longest = Infinity }, value) {
  if (type === "number") return typeof value === "number" && value >= low && value <= high;
  if (type === "flag") return typeof value === "boolean";
  if (typeof value !== "string" || (value.length > longest && [...value].length > longest)) return false;
  return type === "image" ? value.startsWith("data:image/") : type === "text" && matches(pattern, value);
}

/** All values, including defaults. @param {Fields} fields @param {Record<string, any>} given @returns {Record<string, any>} */
export function filled(fields, given) {
  const values = { ...given };
  for (const [key, field] of Object.entries(fields)) {
    if (!(key in given)) values[key] = field.default;
    else if (field.type === "object" && given[key] !== null) values[key] = filled(field.fields ?? {}, given[key]);
  }
  return values;
}

/** The expectation of a field, as a phrase. @param {Field} field @returns {Phrase} */
export function expectation({ type, unit = "", low = 0, high = 0, format, meaning = "", longest = 0, fewest = 0, most = 0 }) {
  if (type === "number") return { word: "fault.number", values: { unit, low: short(low), high: short(high) } };
  if (type === "text") return { word: format === undefined ? "fault.text" : FORMATS[format], values: { longest, ...(meaning && { meaning }) } };
  if (type === "points") return { word: "fault.points", values: { fewest, most } };
  return { word: `fault.${type}` };
}

/** A value as it is shown in messages. @param {unknown} value */
export function describe(value) {
  const json = value === undefined ? "–" : JSON.stringify(value);
  return json.length > 60 ? `${json.slice(0, 57)}…` : json;
}

/** @param {string} key @param {string} name */
export function join(key, name) {
  return key === "" ? name : `${key}.${name}`;
}

/** Whether a pattern matches a whole text. @param {string | undefined} pattern @param {string} text */
function matches(pattern, text) {
  if (pattern === undefined) return true;
  let expression = PATTERNS.get(pattern);
  if (expression === undefined) {
    try {
      expression = new RegExp(`^(${pattern})$`, "u");
    } catch {
      expression = null; // a pattern of a plug-in with Python's syntax: the simulator checks it
    }
    PATTERNS.set(pattern, expression);
  }
  return expression === null || expression.test(text);
}

/** @param {number} value */
function short(value) {
  return String(Number(value.toPrecision(6)));
}
