// Undo, redo, the mode, and whether the text is shown.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { menu } from "../../ui/menu.js";

/** @typedef {import("../kinds.js").Mode} Mode */

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {() => void} options.undo
 * @param {() => void} options.redo
 * @param {(mode: Mode) => void} options.choose
 * @param {() => void} options.toggleText
 */
export function vplBar({ t, undo, redo, choose, toggleText }) {
  /** @param {"undo" | "redo"} name @param {string} key @param {() => void} act */
  const arrow = (name, key, act) => {
    const words = t(`bar.${name}`);
    const attributes = { type: "button", class: "btn icon line", "aria-label": words, title: `${words} (${key})` };
    return h("button", { ...attributes, "data-vpl": name, onclick: act }, icon(name));
  };
  const back = arrow("undo", "Ctrl+Z", undo);
  const forth = arrow("redo", "Ctrl+Y", redo);
  const shownMode = h("span", {});
  const modeButton = h(
    "button",
    { type: "button", class: "btn note line", "data-vpl": "mode" },
    shownMode,
    icon("caretDown", { small: true }),
  );
  /** @type {readonly Mode[]} */ let modes = [];
  /** @type {Mode} */ let mode = "basic";
  const modeMenu = menu({
    id: "vpl-modes",
    button: modeButton,
    label: t("modes"),
    isChoice: true,
    entries: () =>
      modes.map((each) => ({
        label: t(`modes.${each}`),
        chosen: each === mode,
        attributes: { "data-mode": each },
        act: () => choose(each),
      })),
  });
  const text = h(
    "button",
    { type: "button", class: "btn note", "data-vpl": "text", "aria-label": t("bar.text"), onclick: toggleText },
    icon("text", { small: true }),
    h("span", {}, t("bar.text")),
  );
  return {
    element: h("div", { class: "vpl-bar" }, back, forth, modeMenu.element, text),
    /**
     * @param {{ canUndo: boolean, canRedo: boolean, modes: readonly Mode[], mode: Mode, isTextShown: boolean }} facts
     */
    render(facts) {
      modes = facts.modes.includes(facts.mode) ? facts.modes : [facts.mode, ...facts.modes];
      mode = facts.mode;
      if (back.disabled === facts.canUndo) back.disabled = !facts.canUndo;
      if (forth.disabled === facts.canRedo) forth.disabled = !facts.canRedo;
      modeButton.hidden = modes.length < 2;
      setText(shownMode, t(`modes.${mode}`));
      setAttribute(modeButton, "aria-label", `${t("modes")}: ${t(`modes.${mode}`)}`);
      setAttribute(text, "aria-pressed", String(facts.isTextShown));
    },
  };
}
