// Parses `ros2msg` schema text, as a Foxglove channel advertises it, into a definition for `cdr.js`:
// the message's own fields first, then one section per type it depends on,
// separated by a line of "=" and a line `MSG: package/Type`.

/**
 * @typedef {object} Field
 * @property {string} name
 * @property {string} type        primitive name, or a key of `Definition.types`
 * @property {boolean} complex    true if `type` names another message
 * @property {boolean} isArray
 * @property {number | null} size fixed length of an array; null for a sequence or a single value
 *
 * @typedef {object} Definition
 * @property {Field[]} fields
 * @property {Map<string, Field[]>} types  fields of the dependencies, by "package/Type"
 */

/** Primitive types and their names in older definitions. */
const PRIMITIVES = new Map([
  ["bool", "bool"],
  ["byte", "uint8"],
  ["char", "uint8"],
  ["int8", "int8"],
  ["uint8", "uint8"],
  ["int16", "int16"],
  ["uint16", "uint16"],
  ["int32", "int32"],
  ["uint32", "uint32"],
  ["int64", "int64"],
  ["uint64", "uint64"],
  ["float32", "float32"],
  ["float64", "float64"],
  ["string", "string"],
  ["wstring", "wstring"],
]);

/** Types that definitions may use without a package (genmsg habit, kept by rosbag tools). */
const BARE_TYPES = new Map([
  ["Header", "std_msgs/Header"],
  ["time", "builtin_interfaces/Time"],
  ["duration", "builtin_interfaces/Duration"],
]);

/** Well-known types that a schema may leave out. */
const BUILTIN_TYPES = new Map([
  ["builtin_interfaces/Time", "int32 sec\nuint32 nanosec"],
  ["builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"],
]);

const FIELD = /^([A-Za-z][\w/]*)(?:<=\d+)?(\[(?:<=)?(\d*)\])?\s+([A-Za-z]\w*)(.*)$/;

export class SchemaError extends Error {
  /** @param {string} message */
  constructor(message) {
    super(message);
    this.name = "SchemaError";
  }
}

/**
 * Parse the schema of `schemaName` ("package/msg/Type" or "package/Type").
 *
 * @param {string} schemaName
 * @param {string} text
 * @returns {Definition}
 */
export function parseSchema(schemaName, text) {
  const parts = text.split(/^={3,}[^\S\n]*$/m);
  /** @type {Map<string, Field[]>} */
  const types = new Map();
  for (const part of parts.slice(1)) {
    const [, name, body] = /^\s*MSG:\s*(\S+)[^\S\n]*\n?([\s\S]*)$/.exec(part) ?? [];
    if (name === undefined) throw new SchemaError(`${schemaName}: a part has no "MSG: package/Type" line`);
    types.set(shortName(name), parseFields(body ?? "", packageOf(name)));
  }
  for (const [name, body] of BUILTIN_TYPES) {
    if (!types.has(name)) types.set(name, parseFields(body, packageOf(name)));
  }
  const fields = parseFields(parts[0] ?? "", packageOf(schemaName));
  for (const [owner, list] of [[schemaName, fields], ...types]) {
    for (const field of /** @type {Field[]} */ (list)) {
      if (field.complex && !types.has(field.type)) {
        throw new SchemaError(`${owner}.${field.name}: type ${field.type} is not defined`);
      }
    }
  }
  return { fields, types };
}

/**
 * @param {string} text
 * @param {string} packageName
 * @returns {Field[]}
 */
function parseFields(text, packageName) {
  /** @type {Field[]} */
  const fields = [];
  for (const raw of text.split("\n")) {
    const line = raw.replace(/\r$/, "").replace(/#.*$/, "").trim();
    if (line === "") continue;
    const match = FIELD.exec(line);
    if (match === null) throw new SchemaError(`${packageName}: not a field: ${JSON.stringify(line)}`);
    const [, type, array, size, name, rest] = match;
    if (/^\s*=/.test(rest)) continue; // constants are not part of the encoded message
    const primitive = PRIMITIVES.get(type);
    const bounded = array !== undefined && array.startsWith("[<=");
    fields.push({
      name,
      type: primitive ?? qualified(type, packageName),
      complex: primitive === undefined,
      isArray: array !== undefined,
      size: array !== undefined && !bounded && size !== "" ? Number(size) : null,
    });
  }
  return fields;
}

/** @param {string} type @param {string} packageName */
function qualified(type, packageName) {
  return BARE_TYPES.get(type) ?? (type.includes("/") ? shortName(type) : `${packageName}/${type}`);
}

/** "package/msg/Type" → "package/Type". @param {string} name */
function shortName(name) {
  const parts = name.split("/");
  return `${parts[0]}/${parts[parts.length - 1]}`;
}

/** @param {string} name */
function packageOf(name) {
  return name.split("/")[0];
}
