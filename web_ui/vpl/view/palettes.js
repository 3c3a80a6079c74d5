// The palettes: blocks to drag into a row, or to add by a click. Arrow keys move in a palette.

import { makeBlock, nameKey } from "../blocks.js";
import { offered } from "../toolbox.js";
import { h } from "../../ui/dom.js";
import { picture } from "./picture.js";

/** @typedef {import("../kinds.js").BlockType} BlockType */
/** @typedef {import("../kinds.js").Mode} Mode */

/** Values with which a block is easier to recognize than with its first ones, in the palette only. */
const SHOWN = /** @type {Record<string, number[]>} */ ({
  button: [0, 0, 0, 0, 1],
  prox: [0, 1, 1],
  proxground: [1, 2],
  move: [250, 250],
  colortop: [4, 24, 8],
  colorbottom: [32, 6, 4],
  timer: [1500],
  statefilter: [1, 0, 0, 2],
  setstate: [1, 0, 0, 2],
});

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {readonly BlockType[]} options.types   each below its name
 * @param {(name: string, isKey: boolean) => void} options.add   isKey: by the keyboard
 */
export function palette({ t, types, add }) {
  const element = h("div", { class: `vpl-palette ${types[0]}`, role: "group", "aria-label": t(`palette.${types[0]}`) });
  /** @param {string} name */
  const entry = (name) => {
    const title = t(nameKey(name));
    const attributes = { class: "vpl-new", "data-new-block": name, "data-drag": "", tabindex: "-1" };
    const click = (/** @type {MouseEvent} */ { detail }) => add(name, detail === 0);
    const button = h("button", { type: "button", ...attributes, onclick: click });
    button.innerHTML = picture(makeBlock(name, SHOWN[name]));
    button.append(h("span", {}, title));
    button.setAttribute("aria-label", t("palette.add", { name: title }));
    return button;
  };
  const buttons = () => /** @type {HTMLElement[]} */ ([...element.querySelectorAll(".vpl-new")]);
  element.addEventListener("keydown", (event) => {
    const all = buttons();
    const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
    const [next, last] = [at + 1, at - 1];
    const targets = { ArrowDown: next, ArrowRight: next, ArrowUp: last, ArrowLeft: last, Home: 0, End: all.length - 1 };
    const to = /** @type {Record<string, number>} */ (targets)[event.key];
    if (at < 0 || to === undefined || event.ctrlKey) return;
    event.preventDefault();
    const target = all[(to + all.length) % all.length];
    for (const each of all) each.tabIndex = each === target ? 0 : -1;
    target.focus();
  });
  let shown = "";
  return {
    element,
    focus() {
      buttons()
        .find(({ tabIndex }) => tabIndex === 0)
        ?.focus();
    },
    /** @param {import("../toolbox.js").Toolbox} toolbox @param {Mode} mode */
    render(toolbox, mode) {
      const lists = types.map((type) => ({ type, names: offered(toolbox, type, mode) }));
      const now = JSON.stringify(lists);
      if (now === shown) return;
      shown = now;
      element.replaceChildren(
        ...lists
          .filter(({ names }) => names.length > 0)
          .flatMap(({ type, names }) => [
            h("span", { class: "vpl-cap", "aria-hidden": "true" }, t(`palette.${type}`)),
            ...names.map(entry),
          ]),
      );
      const [first] = buttons();
      if (first !== undefined) first.tabIndex = 0;
    },
  };
}
