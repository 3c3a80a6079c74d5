// The definitions that Blockly gets, as JSON, made from the descriptions of the blocks and the texts of a language.

import { BLOCKS } from "./blocks/index.js";

/** @typedef {import("./blocks/spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./blocks/spec.js").Arg} Arg */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {Record<string, any>} Definition */

/**
 * The definitions of all blocks that Blockly does not bring itself.
 *
 * @param {Translate} t  of blockly.json
 * @returns {Definition[]}
 */
export function definitions(t) {
  return [...BLOCKS.values()].filter(({ builtIn }) => !builtIn).map((spec) => definition(spec, t));
}

/**
 * The text of a block names its fields and inputs in the order of the language; bodies that it does not name follow
 * below, one per row.
 *
 * @param {BlockSpec} spec
 * @param {Translate} t
 * @returns {Definition}
 */
export function definition(spec, t) {
  const { type, shape, style } = spec;
  const key = `block.${type}`;
  const names = Object.fromEntries(spec.args.map(({ name }) => [name, `{${name}}`]));
  const isNamed = (/** @type {Arg} */ { name }) => t(key, names).includes(`{${name}}`);
  const first = spec.args.filter(isNamed);
  const numbers = Object.fromEntries(first.map(({ name }, index) => [name, `%${index + 1}`]));
  /** @type {Definition} */
  const result = {
    type,
    style,
    message0: t(key, numbers),
    args0: first.map((arg) => argument(arg, t)),
    inputsInline: true,
  };
  spec.args
    .filter((arg) => !isNamed(arg))
    .forEach((arg, index) => {
      result[`message${index + 1}`] = "%1";
      result[`args${index + 1}`] = [argument(arg, t)];
    });
  const tooltip = t(`tooltip.${type}`);
  if (tooltip !== `tooltip.${type}`) result.tooltip = tooltip;
  if (shape === "Number" || shape === "Boolean") result.output = spec.anywhere ? null : shape;
  if (shape === "statement") result.previousStatement = null;
  const isOpenHat = shape === "hat" && !spec.args.some(({ kind }) => kind === "body");
  if (shape === "statement" || isOpenHat) result.nextStatement = null;
  return result;
}

/** @param {Arg} arg @param {Translate} t @returns {Definition} */
function argument({ kind, name, set, options = [], initial, least, check }, t) {
  switch (kind) {
    case "choice": {
      const rows = options.map(([word, value]) => [t(`option.${set}.${word}`), value]);
      return { type: "field_dropdown", name, options: rows };
    }
    case "variable":
      return { type: "field_variable", name, variable: initial };
    case "integer":
      return { type: "field_number", name, value: initial, precision: 1, min: least };
    case "text":
      return { type: "field_input", name, text: initial };
    case "color":
      return { type: "field_colour", name, colour: initial }; // codespell:ignore colour
    case "body":
      return { type: "input_statement", name };
    case "value":
      return { type: "input_value", name, check: check ?? undefined };
  }
}
