// A new playground fades in: the stage has `data-arriving` for the time of that.

import { h } from "../ui/dom.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function arrivalPanel({ motion }) {
  const element = h("span", { hidden: true });
  /** @type {string | null} */ let shown = null;
  /** @type {Element | null} */ let stage = null;
  const end = () => stage?.removeAttribute("data-arriving");
  return {
    slot: "messages",
    element,
    render({ simulator, markers }) {
      if (simulator === null || markers.size === 0 || simulator.playground === shown) return;
      const isFirst = shown === null;
      shown = simulator.playground;
      if (isFirst || motion.isCalm) return;
      if (stage === null) {
        stage = element.closest("#stage");
        stage?.addEventListener("animationend", end);
        stage?.addEventListener("animationcancel", end);
      }
      stage?.setAttribute("data-arriving", "");
    },
  };
}
