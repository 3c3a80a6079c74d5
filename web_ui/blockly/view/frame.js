// What is around the blocks: the bar, the notice, the text, the foot, and the choice of the look.

import { textPane } from "../../program_tab/text_pane.js";
import { h } from "../../ui/dom.js";
import { blocksBar } from "./bar.js";
import { blocksFoot } from "./foot.js";
import { lookChoice } from "./look_choice.js";
import { fileNotice } from "./notice.js";

/** @typedef {import("../../i18n/index.js").Translate} Translate */

/**
 * @param {object} options
 * @param {Translate} options.t            of blockly.json
 * @param {Translate} options.editorText
 * @param {import("../../program_tab/commands.js").ProgramCommands} options.commands
 * @param {(again: boolean) => void} options.undo
 * @param {() => void} options.toggleText
 * @param {() => void} options.adopt                    makes the text from the blocks
 * @param {(line: number) => void} options.chooseLine   of the text, from 0
 * @param {(look: import("../toolbox.js").Look) => void} options.chooseLook
 * @param {() => void} options.goToMistake
 */
export function blocksFrame(options) {
  const { t, editorText, commands, undo, toggleText, adopt, chooseLine, chooseLook, goToMistake } = options;
  const area = h("div", { class: "blocks-place" });
  const hint = h("p", { class: "blocks-hint", hidden: true }, t("view.empty"));
  const bar = blocksBar({ t, editorText, commands, undo, toggleText });
  const notice = fileNotice({ t, adopt });
  const pane = textPane({ t: editorText, turn: () => void commands.detach(), choose: chooseLine });
  const foot = blocksFoot(goToMistake);
  const looks = lookChoice({ t, choose: chooseLook });
  const body = h("div", { class: "blocks-body" }, h("div", { class: "blocks-frame" }, area, hint), pane.element);
  const element = h("div", { class: "blocks" }, notice.element, body, foot.element);
  return { element, area, hint, bar, notice, pane, foot, looks };
}
