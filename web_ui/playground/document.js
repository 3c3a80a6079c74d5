// A playground as the creator edits it: titles, and items in order. Reads and writes the JSON format. Pure.

import { checkWhole } from "./validation.js";
import { BUILT_IN } from "./declarations.js";
import { kindNamed, ROBOT } from "./kinds/index.js";
import { check, describe, Fault } from "./rules.js";

/** @typedef {import("./parts.js").Item} Item */
/**
 * @typedef {Readonly<{ title: string, description: string, translations: Readonly<Record<string, any>>,
 *   items: readonly Item[], draft?: string, mission?: import("./mission.js").Mission }>} Playground   draft: the name under
 *   which this device keeps it; mission: what makes it a mission; neither is in the file of a playground
 */

const { format: FORMAT, limits: LIMITS, titles: TITLES } = BUILT_IN;
const LANGUAGE = new RegExp(`^(${BUILT_IN.language})$`);

/** Parse a playground. Throws a Fault with location and reason. @param {string} text @returns {Playground} */
export function parse(text) {
  /** @type {unknown} */ let data;
  try {
    data = JSON.parse(text.replace(/^\uFEFF/, ""));
  } catch (error) {
    throw new Fault("", error instanceof Error ? error.message : String(error), { word: "fault.json" });
  }
  if (typeof data !== "object" || data === null || Array.isArray(data))
    throw new Fault("", describe(data), { word: "fault.object" });
  const {
    format,
    $schema,
    shapes = [],
    robots = [],
    translations = {},
    ...titles
  } = /** @type {Record<string, any>} */ (data);
  if (format !== FORMAT) throw new Fault("format", describe(format), { word: "fault.format" });
  if ($schema !== undefined && typeof $schema !== "string")
    throw new Fault("$schema", describe($schema), { word: "fault.line", values: { longest: 2000 } });
  check(TITLES, titles, "");
  checkTranslations(translations);
  const items = [
    ...list(shapes, "shapes", LIMITS.shapes).map((shape, index) => readShape(shape, index)),
    ...list(robots, "robots", LIMITS.robots).map((start, index) => readRobot(start, index)),
  ];
  const playground = { title: titles.title, description: titles.description ?? "", translations, items };
  checkWhole(playground);
  return playground;
}

/** The playground as text, one item per line, as the simulator writes it. @param {Playground} playground */
export function write({ title, description, translations, items }) {
  const shapes = items.filter(({ kind }) => kind !== "robot").map((item) => JSON.stringify(item));
  const robots = items.filter(({ kind }) => kind === "robot").map(({ kind: _kind, ...start }) => JSON.stringify(start));
  /** @param {string[]} lines */
  const array = (lines) => (lines.length === 0 ? "[]" : `[\n    ${lines.join(",\n    ")}\n  ]`);
  const members = [
    `"format": ${FORMAT}`,
    `"title": ${JSON.stringify(title)}`,
    `"description": ${JSON.stringify(description)}`,
    ...(Object.keys(translations).length > 0 ? [`"translations": ${JSON.stringify(translations)}`] : []),
    `"shapes": ${array(shapes)}`,
    `"robots": ${array(robots)}`,
  ];
  return `{\n  ${members.join(",\n  ")}\n}\n`;
}

/** The file name of a playground: letters and digits of its title. @param {string} title */
export function fileNameOf(title) {
  const stem = title
    .normalize("NFKD")
    .replace(/\p{M}/gu, "")
    .replace(/[^\w]+/g, "_")
    .replace(/^_+|_+$/g, "");
  return `${stem.slice(0, 60) || "playground"}.json`;
}

/**
 * The values without those that equal their defaults.
 *
 * @param {Record<string, any> & { kind: string, name: string }} item
 * @returns {Item}
 */
export function tidy(item) {
  const fields = kindNamed(item.kind)?.fields ?? {};
  return /** @type {Item} */ (
    Object.fromEntries(
      Object.entries(item).filter(([key, value]) => !(key in fields) || fields[key].required || value !== fields[key].default),
    )
  );
}

/** The path of an item in the file: `shapes[3]`. @param {Playground} playground @param {Item} item */
export function keyOf({ items }, item) {
  const isRobot = item.kind === "robot";
  const peers = items.filter(({ kind }) => (kind === "robot") === isRobot);
  return `${isRobot ? "robots" : "shapes"}[${peers.indexOf(item)}]`;
}

/** @param {unknown} value @param {string} key @param {number} most @returns {unknown[]} */
function list(value, key, most) {
  if (!Array.isArray(value)) throw new Fault(key, describe(value), { word: "fault.list" });
  if (value.length > most) throw new Fault(key, String(value.length), { word: "fault.most", values: { most } });
  return value;
}

/** @param {any} shape @param {number} index @returns {Item} */
function readShape(shape, index) {
  const key = `shapes[${index}]`;
  if (typeof shape !== "object" || shape === null || Array.isArray(shape))
    throw new Fault(key, describe(shape), { word: "fault.object" });
  if (typeof shape.kind !== "string" || shape.kind === "robot")
    throw new Fault(`${key}.kind`, describe(shape.kind), { word: "fault.kind" });
  const { kind, name = `${kind}_${index}`, ...values } = shape;
  check({ name: ROBOT.fields.name }, { name }, key);
  const known = kindNamed(kind);
  if (known !== undefined) check(known.fields, values, key); // the simulator checks those that are not installed here
  return Object.freeze({ kind, name, ...values });
}

/** @param {any} start @param {number} index @returns {Item} */
function readRobot(start, index) {
  check(ROBOT.fields, start, `robots[${index}]`);
  return Object.freeze({ kind: "robot", ...start });
}

/** @param {any} translations */
function checkTranslations(translations) {
  if (
    typeof translations !== "object" ||
    translations === null ||
    Array.isArray(translations) ||
    Object.keys(translations).length > LIMITS.translations
  ) {
    throw new Fault("translations", describe(translations), { word: "fault.object" });
  }
  for (const [language, titles] of Object.entries(translations)) {
    if (!LANGUAGE.test(language))
      throw new Fault(`translations.${language}`, describe(language), { word: "fault.language" });
    check(TITLES, titles, `translations.${language}`);
  }
}
