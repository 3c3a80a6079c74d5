// The footer: compiler message, state of the robot, memory usage.

import { h, setAttribute, setText } from "../ui/dom.js";

/** @typedef {[used: number, size: number] | null} Share */

/** @param {import("../i18n/index.js").Translate} t @param {() => void} go  goes to the position of the message */
export function footer(t, go) {
  const words = h("button", { type: "button", class: "plain verdict", onclick: go });
  const stateElement = h("span", { class: "state" });
  const bars = /** @type {const} */ (["variables", "bytecode", "stack"]).map((name) => {
    const fill = h("span", { class: "fill" });
    const text = h("span", {});
    const element = h("span", { class: "memory", title: t(`memory.${name}`), hidden: true }, fill, text);
    return { name, fill, text, element };
  });
  const element = h(
    "div",
    { class: "editor-foot" },
    words,
    stateElement,
    h("span", { class: "memories" }, ...bars.map((bar) => bar.element)),
  );
  return {
    element,
    /** @param {{ kind: "good" | "warning" | "error" | "", text: string }} verdict */
    report({ kind, text }) {
      setText(words, text);
      setAttribute(words, "data-kind", kind);
    },
    /** @param {string} state @param {string} text */
    robot(state, text) {
      setText(stateElement, text);
      setAttribute(stateElement, "data-state", state);
    },
    /** @param {Record<"variables" | "bytecode" | "stack", Share>} use */
    memories(use) {
      for (const { name, fill, text, element } of bars) {
        const share = use[name];
        element.hidden = share === null;
        if (share === null) continue;
        const [used, size] = share;
        const percent = Math.round((100 * used) / Math.max(size, 1));
        fill.style.width = `${Math.min(percent, 100)}%`;
        setText(text, `${t(`memory.${name}`)} ${used}/${size} (${percent} %)`);
        setAttribute(element, "data-full", String(percent > 90));
      }
    },
  };
}
