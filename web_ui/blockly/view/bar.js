// Controls of the blocks, beside the badge: undo, redo, one block after the other, the text of the program.

import { h, lock, setAttribute } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";

/** @typedef {import("../../i18n/index.js").Translate} Translate */
/** @typedef {import("../../ui/icons.js").IconName} IconName */

/**
 * @param {object} options
 * @param {Translate} options.t            of blockly.json
 * @param {Translate} options.editorText
 * @param {import("../../program_tab/commands.js").ProgramCommands} options.commands
 * @param {(again: boolean) => void} options.undo
 * @param {() => void} options.toggleText
 */
export function blocksBar({ t, editorText, commands, undo, toggleText }) {
  /**
   * @param {string} verb @param {IconName} sign @param {string} name @param {string} key  "": none
   * @param {string} look @param {() => void} act @param {readonly HTMLElement[]} words
   */
  const button = (verb, sign, name, key, look, act, words) => {
    const title = key === "" ? name : `${name} (${key})`;
    const attributes = { type: "button", class: `btn ${look}`, "data-verb": verb, title, "aria-label": name };
    return h("button", { ...attributes, onclick: act }, icon(sign, { small: true }), ...words);
  };
  /** @param {string} name */
  const shown = (name) => [h("span", { class: "blocks-name" }, name)];
  const [haltName, nextName, goName, textName] = [
    editorText("debug.halt"),
    t("view.next"),
    editorText("debug.go"),
    t("view.text"),
  ];
  const slim = "line slim note";
  const back = button("undo", "undo", t("view.undo"), "Ctrl+Z", "icon line", () => undo(false), []);
  const again = button("redo", "redo", t("view.redo"), "Ctrl+Y", "icon line", () => undo(true), []);
  const halt = button("pause", "halt", haltName, "F10", slim, () => void commands.control("pause"), shown(haltName));
  const next = button("step_line", "nextLine", nextName, "F7", slim, () => void commands.control("step_line"), shown(nextName));
  const goOn = button("run-on", "goOn", goName, "F9", slim, () => void commands.control("run"), shown(goName));
  const text = button("text", "text", textName, "", "note", toggleText, shown(textName));
  const tools = [back, again, halt, next, goOn, text];
  return {
    element: h("div", { class: "blocks-bar", role: "toolbar", "aria-label": t("view.tools") }, ...tools),
    /**
     * @param {object} facts
     * @param {string} facts.reason      why robots cannot be controlled; empty: they can
     * @param {string} facts.state       of the program in the robot
     * @param {boolean} facts.canUndo
     * @param {boolean} facts.canRedo
     * @param {boolean} facts.isTextShown
     */
    render({ reason, state, canUndo, canRedo, isTextShown }) {
      lock(back, canUndo ? "" : t("view.noUndo"));
      lock(again, canRedo ? "" : t("view.noRedo"));
      const whenHalted = state === "paused" ? "" : editorText("debug.haltFirst");
      lock(halt, reason || (state === "running" ? "" : editorText("debug.notRunning")));
      lock(next, reason || whenHalted);
      lock(goOn, reason || whenHalted);
      setAttribute(text, "aria-pressed", String(isTextShown));
    },
  };
}
