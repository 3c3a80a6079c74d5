// Blockly itself, in one place. This module loads only when an editor of blocks opens: `import("./blockly/library.js")`.

import * as Blockly from "blockly/core";
import "blockly/blocks";
import { registerFieldColour } from "@blockly/field-colour";

import { definitions } from "./definitions.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */

/** Blockly's own texts by language: each is a file of its own. @type {Record<string, () => Promise<Record<string, unknown>>>} */
const MESSAGES = {
  en: () => import("blockly/msg/en"),
  de: () => import("blockly/msg/de"),
  fr: () => import("blockly/msg/fr"),
  it: () => import("blockly/msg/it"),
};

/**
 * Define all blocks in a language. Workspaces that exist keep the texts they have, so they are created again afterward.
 *
 * @param {string} language
 * @param {Translate} t  of blockly.json
 */
export async function defineBlocks(language, t) {
  const { default: nested, ...messages } = await (MESSAGES[language] ?? MESSAGES.en)();
  Blockly.setLocale(/** @type {Record<string, string>} */ (nested ?? messages));
  if (!Blockly.registry.hasItem(Blockly.registry.Type.FIELD, "field_colour")) registerFieldColour();
  const all = definitions(t);
  for (const { type } of all) delete Blockly.Blocks[type];
  Blockly.common.defineBlocks(Blockly.common.createBlockDefinitionsFromJsonArray(all));
}

export { Blockly };
