// The stop button, always visible and always the last.

import { robotNames } from "../browser/robot_names.js";
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
    render(state) {
      const { connection, readOnly } = state;
      setText(word, wordOf(state, t));
      lock(element, disabledReason({ connection, readOnly }, t));
    },
  };
}

/**
 * Which robots it stops: the robot, the chosen one of several by its name, or all of them.
 *
 * @param {Pick<import("../state/index.js").State, "robots" | "selected" | "toAll">} state
 * @param {import("../i18n/index.js").Translate} t
 */
export function wordOf({ robots, selected, toAll }, t) {
  const count = Object.keys(robots).length;
  if (count < 2) return t("stop");
  return toAll ? t("stop.all", { count }) : t("stop.one", { name: robotNames.title(selected) });
}
