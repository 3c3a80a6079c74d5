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
  /** @param {string} verb @param {IconName} sign @param {string} name @param {string} key @param {() => void} act */
  const button = (verb, sign, name, key, act) =>
    h(
      "button",
      { type: "button", class: "btn line slim note", "data-verb": verb, title: `${name} (${key})`, "aria-label": name, onclick: act },
      icon(sign, { small: true }),
      h("span", { class: "blocks-name" }, name),
    );
  /** @param {string} verb @param {IconName} sign @param {string} name @param {string} key @param {() => void} act */
  const sign = (verb, sign, name, key, act) => {
    const attributes = { type: "button", class: "btn icon", "data-verb": verb, title: `${name} (${key})`, "aria-label": name };
    return h("button", { ...attributes, onclick: act }, icon(sign, { small: true }));
  };
  const back = sign("undo", "undo", t("view.undo"), "Ctrl+Z", () => undo(false));
  const again = sign("redo", "redo", t("view.redo"), "Ctrl+Y", () => undo(true));
  const halt = button("pause", "halt", editorText("debug.halt"), "F10", () => void commands.control("pause"));
  const next = button("step_line", "nextLine", t("view.next"), "F7", () => void commands.control("step_line"));
  const goOn = button("run-on", "goOn", editorText("debug.go"), "F9", () => void commands.control("run"));
  const text = h(
    "button",
    { type: "button", class: "btn soft slim note", "data-verb": "text", "aria-pressed": "false", "aria-label": t("view.text"), onclick: toggleText },
    icon("text", { small: true }),
    h("span", { class: "blocks-name" }, t("view.text")),
  );
  return {
    element: h("div", { class: "blocks-bar", role: "toolbar", "aria-label": t("view.tools") }, back, again, halt, next, goOn, text),
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
