// Field types of playground files: the rules of the published schema, and reading values by them.
// Pure. `tests/web_ui/playground.test.js` compares these tables with playgrounds/playground.schema.json.

/**
 * @typedef {object} Rule
 * @property {"number" | "text" | "points" | "image" | "flag" | "object"} type
 * @property {string} [unit]     unit of a number
 * @property {number} [low]      minimum of a number
 * @property {number} [high]     maximum of a number
 * @property {RegExp} [pattern]  pattern of a text
 * @property {string} [meaning]  key of the description of a text
 * @property {number} [longest]  maximum number of characters
 * @property {number} [fewest]   minimum number of points
 * @property {Fields} [fields]   fields of an object
 */
/** @typedef {{ rule: Rule, required: boolean, defaultValue?: any }} Field   defaultValue: the default */
/** @typedef {Readonly<Record<string, Field>>} Fields */
/** @typedef {{ word: string, values?: Record<string, string | number> }} Phrase  a text key with the values to fill in */

const FAR_M = 100;
const MOST_POINTS = 1000;

/** @param {string} unit @param {number} low @param {number} high @returns {Rule} */
const number = (unit, low, high) => ({ type: "number", unit, low, high });
/** @param {string} expression @param {string} meaning @param {number} longest @returns {Rule} */
const text = (expression, meaning, longest) => ({
  type: "text",
  pattern: new RegExp(`^(${expression})$`, "u"),
  meaning,
  longest,
});

export const RULES = {
  coordinate: number("m", -FAR_M, FAR_M),
  extent: number("m", 0.001, FAR_M),
  radius: number("m", 0, FAR_M),
  penWidth: number("m", 0.001, 0.1),
  angle: number("rad", -2 * Math.PI, 2 * Math.PI),
  mass: number("kg", 0.001, 1000),
  friction: number("parts of the weight", 0, 2),
  restitution: number("parts of the speed", 0, 1),
  duration: number("s", 0.01, 3600),
  line: text("[^\\x00-\\x1f\\x7f\\ud800-\\udfff]*", "fault.line", 2000),
  name: text("[A-Za-z](_?[A-Za-z0-9])*", "fault.name", 60),
  shade: text("#[0-9A-Fa-f]{6}", "fault.shade", 7),
  points: /** @type {Rule} */ ({ type: "points", fewest: 2 }),
  area: /** @type {Rule} */ ({ type: "points", fewest: 3 }),
  image: /** @type {Rule} */ ({ type: "image", longest: 6_000_000 }),
  flag: /** @type {Rule} */ ({ type: "flag" }),
};

/** @param {Rule} rule @returns {Field} */
export const needed = (rule) => ({ rule, required: true });
/** @param {Rule} rule @param {any} defaultValue @returns {Field} */
export const optional = (rule, defaultValue) => ({ rule, required: false, defaultValue });
/** @param {Fields} fields @returns {Rule} */
export const object = (fields) => ({ type: "object", fields });

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
  for (const [name, { rule, required, defaultValue }] of Object.entries(fields)) {
    if (defaultValue === null && members[name] === null) continue;
    if (Object.hasOwn(members, name)) checkValue(rule, members[name], join(key, name));
    else if (required) throw new Fault(join(key, name), "–", expectation(rule));
  }
}

/** @param {Rule} rule @param {unknown} value @param {string} key */
export function checkValue(rule, value, key) {
  if (rule.type === "object") return check(rule.fields ?? {}, value, key);
  if (
    rule.type === "points" &&
    Array.isArray(value) &&
    value.length >= (rule.fewest ?? 0) &&
    value.length <= MOST_POINTS
  ) {
    value.forEach((point, index) => {
      if (!Array.isArray(point) || point.length !== 2)
        throw new Fault(`${key}[${index}]`, describe(point), { word: "fault.point" });
      point.forEach((part, axis) => checkValue(RULES.coordinate, part, `${key}[${index}][${axis}]`));
    });
    return;
  }
  if (!fits(rule, value)) throw new Fault(key, describe(value), expectation(rule));
}

/** @param {Rule} rule @param {unknown} value */
function fits({ type, low = -Infinity, high = Infinity, pattern, longest = Infinity }, value) {
  if (type === "number") return typeof value === "number" && value >= low && value <= high;
  if (type === "flag") return typeof value === "boolean";
  if (typeof value !== "string" || (value.length > longest && [...value].length > longest)) return false;
  return type === "image" ? value.startsWith("data:image/") : type === "text" && (pattern?.test(value) ?? true);
}

/** The expectation of a rule, as a phrase. @param {Rule} rule @returns {Phrase} */
export function expectation({ type, unit = "", low = 0, high = 0, meaning = "", longest = 0, fewest = 0 }) {
  if (type === "number") return { word: "fault.number", values: { unit, low: short(low), high: short(high) } };
  if (type === "text") return { word: meaning, values: { longest } };
  if (type === "points") return { word: "fault.points", values: { fewest, most: MOST_POINTS } };
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

/** @param {number} value */
function short(value) {
  return String(Number(value.toPrecision(6)));
}
