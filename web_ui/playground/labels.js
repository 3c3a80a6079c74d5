// Names of kinds and fields as people read them: from the page's texts, from the declaration of a plug-in, or made of
// the name in files.

import { kindNamed } from "./kinds/index.js";
import { toDisplay, unitOf } from "./units.js";

/** @typedef {import("./rules.js").Phrase} Phrase */

/** The unit at the end of a field's name. */
const UNIT = /_(m|rad|kg|s)$/;
/** Members of a key such as `walls.height_m` or `points_m[3][0]`. */
const MEMBER = /[A-Za-z_]\w*/g;

export class Labels {
  /** @param {string} language @param {import("../i18n/index.js").Translate} t */
  constructor(language, t) {
    this.language = language;
    this.t = t;
  }

  /** @param {string} name  of a kind */
  kind(name) {
    return this.#declared(kindNamed(name)?.labels) ?? this.#word(`kind.${name}`) ?? readable(name);
  }

  /** What the tool of a kind is for, where its name does not say it. @param {string} name  of a kind */
  help(name) {
    return this.#word(`help.${name}`) ?? this.kind(name);
  }

  /** The name of a kind of ground, as one of several to choose from. @param {string} name  of a kind */
  ground(name) {
    return this.#word(`ground.${name}`) ?? this.kind(name);
  }

  /** @param {string} kind @param {string} key */
  field(kind, key) {
    const declared = this.#declared(kindNamed(kind)?.fieldLabels[key]);
    return declared ?? this.#word(`field.${key}`) ?? readable(key.replace(UNIT, ""));
  }

  /** The name of a field inside others: "Walls – Height". An unknown key has no name. @param {string} kind @param {string} key */
  path(kind, key) {
    const names = (key.match(MEMBER) ?? []).map((member) =>
      member in (kindNamed(kind)?.fields ?? {}) ? this.field(kind, member) : this.#word(`field.${member}`),
    );
    return names.filter((name) => name !== undefined).join(" – ") || this.t("fault.something");
  }

  /** @param {Record<string, string> | undefined} labels  by language */
  #declared(labels = {}) {
    return labels[this.language] ?? labels.en ?? Object.values(labels)[0];
  }

  /**
   * A phrase as text. Kinds, nested phrases and limits in it are put into words and the units of the page too.
   *
   * @param {Phrase} phrase
   */
  text({ word, values = {} }) {
    const filled = { ...values };
    if (typeof values.kind === "string" && kindNamed(values.kind) !== undefined) filled.kind = this.kind(values.kind);
    if (typeof values.change === "string") filled.change = this.t(values.change, values);
    if (typeof values.key === "string") filled.field = this.path(String(values.kind ?? ""), values.key);
    if (typeof values.unit === "string") Object.assign(filled, inUnitsOfThePage(values));
    if (typeof values.reason === "string") filled.reason = this.t(values.reason, filled);
    return this.t(word, filled);
  }

  /** The page's text; undefined if there is none. @param {string} key */
  #word(key) {
    const text = this.t(key);
    return text === key ? undefined : text;
  }
}

/**
 * Limits of a number in the units that the page shows; the unit with a space before it.
 *
 * @param {Record<string, string | number>} values
 */
function inUnitsOfThePage({ unit: inFile, low, high }) {
  const name = String(inFile).trim();
  const { unit } = unitOf(name);
  /** @param {string | number | undefined} limit */
  const shown = (limit) => (Number.isFinite(Number(limit)) ? Number(toDisplay(Number(limit), name).toFixed(2)) : (limit ?? ""));
  return { unit: unit === "" || unit === "°" ? unit : ` ${unit}`, low: shown(low), high: shown(high) };
}

/** @param {string} name */
function readable(name) {
  const words = name.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}
