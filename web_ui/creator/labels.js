// Names of kinds and fields as people read them: from the page's texts, from the declaration of a plug-in, or made of
// the name in files.

import { kindNamed } from "../playground/kinds/index.js";

/** The unit at the end of a field's name. */
const UNIT = /_(m|rad|kg|s)$/;

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

  /** The name of the tool that places a kind. @param {string} name  of a kind */
  tool(name) {
    return this.#word(`tool.${name}`) ?? this.kind(name);
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

  /** @param {Record<string, string> | undefined} labels  by language */
  #declared(labels = {}) {
    return labels[this.language] ?? labels.en ?? Object.values(labels)[0];
  }

  /**
   * A phrase as text; kinds and nested descriptions of steps in it are put into words too.
   *
   * @param {import("../playground/rules.js").Phrase} phrase
   */
  text({ word, values = {} }) {
    const filled = { ...values };
    if (typeof values.kind === "string" && kindNamed(values.kind) !== undefined) filled.kind = this.kind(values.kind);
    if (typeof values.change === "string") filled.change = this.t(values.change, values);
    return this.t(word, filled);
  }

  /** The page's text; undefined if there is none. @param {string} key */
  #word(key) {
    const text = this.t(key);
    return text === key ? undefined : text;
  }
}

/** @param {string} name */
function readable(name) {
  const words = name.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}
