// Blockly itself, in one place. This module loads only when an editor of blocks opens:
// `import("./blockly/library.js")`.

import * as Blockly from "blockly/core";
import "blockly/blocks";
import { registerFieldColour } from "@blockly/field-colour";

import OWN_MESSAGES from "../i18n/blockly_core.texts.js";
import { definitions } from "./definitions.js";
import { injectOptions } from "./options.js";
import { allBlocks } from "./state.js";
import { theme } from "./themes.js";
import { NEW_VARIABLE, subroutineFlyout, subroutineNames, toolbox, variableFlyout } from "./toolbox.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("./toolbox.js").Look} Look */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */

/**
 * Blockly's own texts by language: each is a file of its own.
 *
 * @type {Record<string, () => Promise<Record<string, unknown>>>}
 */
const MESSAGES = {
  en: () => import("blockly/msg/en"),
  de: () => import("blockly/msg/de"),
  fr: () => import("blockly/msg/fr"),
  it: () => import("blockly/msg/it"),
};

/**
 * Define all blocks in a language. Blockly's own texts are completed: some of them are not translated yet. Workspaces that exist keep the texts they have, so they are created again afterward.
 *
 * @param {string} language
 * @param {Translate} t  of blockly.json
 */
export async function defineBlocks(language, t) {
  const { default: nested, ...messages } = await (MESSAGES[language] ?? MESSAGES.en)();
  const own = /** @type {Record<string, string>} */ (nested ?? messages);
  const addresses = Object.keys(own).filter((key) => key.endsWith("_HELPURL"));
  Blockly.setLocale(own);
  Blockly.setLocale({
    ...OWN_MESSAGES[language],
    ...Object.fromEntries(addresses.map((key) => [key, ""])), // nothing opens a page of another host
    PROCEDURES_DEFNORETURN_COMMENT: "", // each definition without a comment would get this one: a file would change
  });
  if (!Blockly.registry.hasItem(Blockly.registry.Type.FIELD, "field_colour")) registerFieldColour();
  const all = definitions(t);
  for (const { type } of all) delete Blockly.Blocks[type];
  Blockly.common.defineBlocks(Blockly.common.createBlockDefinitionsFromJsonArray(all));
}

/**
 * Show an editor of blocks in an element of the page. Blocks must be defined.
 *
 * @param {HTMLElement} element
 * @param {Look} look
 * @param {import("./options.js").EditorOptions} options
 * @returns {Blockly.WorkspaceSvg}
 */
export function openWorkspace(element, look, options) {
  const { t, hidden = new Set() } = options;
  const { base, ...colors } = theme(look);
  const parent = base === "zelos" ? Blockly.Themes.Zelos : Blockly.Themes.Classic;
  const workspace = Blockly.inject(element, {
    ...injectOptions(look, options),
    theme: Blockly.Theme.defineTheme(colors.name, {
      ...colors,
      base: parent,
      fontStyle: { family: getComputedStyle(element).fontFamily }, // texts are measured with it
    }),
  });
  workspace.registerButtonCallback(NEW_VARIABLE, () => Blockly.Variables.createVariableButtonHandler(workspace));
  fillCategories(workspace, look, t, hidden);
  return workspace;
}

/**
 * Offer other blocks than before.
 *
 * @param {Blockly.WorkspaceSvg} workspace
 * @param {Look} look
 * @param {Translate} t
 * @param {ReadonlySet<string>} hidden
 */
export function offerBlocks(workspace, look, t, hidden) {
  fillCategories(workspace, look, t, hidden);
  workspace.updateToolbox(toolbox(look, t, hidden));
}

/**
 * The categories whose content depends on the program.
 *
 * @param {Blockly.WorkspaceSvg} workspace
 * @param {Look} look
 * @param {Translate} t
 * @param {ReadonlySet<string>} hidden
 */
function fillCategories(workspace, look, t, hidden) {
  workspace.registerToolboxCategoryCallback("variables", () => {
    const variables = workspace.getVariableMap().getAllVariables();
    return variableFlyout(
      variables.map((variable) => ({ name: variable.getName(), id: variable.getId() })),
      look,
      t,
      hidden,
    );
  });
  workspace.registerToolboxCategoryCallback("subroutines", () =>
    subroutineFlyout(subroutineNames(allBlocks(saveState(workspace))), hidden),
  );
}

/** Replace what is in a workspace. @param {Blockly.WorkspaceSvg} workspace @param {WorkspaceState} state */
export function loadState(workspace, state) {
  Blockly.serialization.workspaces.load(/** @type {Record<string, any>} */ (state), workspace);
}

/** What is in a workspace. @param {Blockly.Workspace} workspace @returns {WorkspaceState} */
export function saveState(workspace) {
  return Blockly.serialization.workspaces.save(workspace);
}

export { Blockly };
