// The stop button, always visible and always the last.

import { disabledReason } from "../state/disabled_reason.js";
import { h, lock, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function stopPanel({ text, actions }) {
  const t = text("page");
  const word = h("span", {}, t("stop"));
  const element = h(
    "button",
    { type: "button", class: "btn stop", id: "stop", title: t("stop.help"), onclick: () => void actions.stop() },
    icon("stop"),
    word,
  );
  return {
    slot: "header",
    element,
    render({ connection, readOnly, toAll, robots }) {
      setText(word, toAll ? t("stop.all", { count: Object.keys(robots).length }) : t("stop"));
      lock(element, disabledReason({ connection, readOnly }, t));
    },
  };
}
