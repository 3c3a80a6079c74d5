// Line by line: halt the program, run one line, go on; and a menu with what is needed less often.

import { h, lock, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";

/** @typedef {import("../program_tab/commands.js").ProgramCommands} ProgramCommands */
/**
 * @typedef {object} Facts
 * @property {string} state     of the program
 * @property {string} robot     whose line is shown; empty: there is only one
 * @property {string} reason    why robots cannot be controlled; empty: they can
 */

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {ProgramCommands} options.commands
 * @param {{ isMarked: boolean, toggle: () => void }} options.mark   of the line with the cursor
 */
export function debugRow({ t, commands, mark }) {
  /**
   * @param {string} name @param {string} key @param {import("../ui/icons.js").IconName} sign @param {string} hint
   * @param {() => void} act
   */
  const button = (name, key, sign, hint, act) =>
    h(
      "button",
      { type: "button", class: "btn line slim note", "data-verb": name, title: `${t(key)} (${hint})`, onclick: act },
      icon(sign, { small: true }),
      h("span", {}, t(key)),
    );
  const halt = button("pause", "debug.halt", "halt", "F10", () => void commands.control("pause"));
  const next = button("step_line", "debug.next", "nextLine", "F7", () => void commands.control("step_line"));
  const goOn = button("run-on", "debug.go", "goOn", "F9", () => void commands.control("run"));
  /**
   * @param {string} name @param {string} label @param {import("../ui/icons.js").IconName} sign @param {() => void} act
   * @returns {import("../ui/menu.js").Entry}
   */
  const entry = (name, label, sign, act) => ({ label, icon: sign, act, attributes: { "data-verb": name } });
  const more = h(
    "button",
    { type: "button", class: "btn icon", id: "debug-more", title: t("debug.more"), "aria-label": t("debug.more") },
    icon("more", { small: true }),
  );
  const list = menu({
    id: "debug-menu",
    button: more,
    label: t("debug.more"),
    entries: () => [
      entry("mark", t(mark.isMarked ? "debug.unmark" : "debug.mark"), "halt", mark.toggle),
      entry("step", t("debug.instruction"), "step", () => void commands.control("step")),
      entry("reset", t("debug.first"), "reset", () => void commands.control("reset")),
    ],
  });
  const caption = h("span", { class: "cap", id: "debug-caption" });
  return {
    element: h(
      "div",
      { class: "debug-row", role: "toolbar", "aria-labelledby": "debug-caption" },
      caption,
      halt,
      next,
      goOn,
      list.element,
    ),
    /** @param {Facts} facts */
    render({ state, robot, reason }) {
      setText(caption, robot === "" ? t("debug") : t("debug.of", { robot }));
      const isHalted = state === "paused";
      const whenHalted = isHalted ? "" : t("debug.haltFirst");
      lock(halt, reason || (state === "running" ? "" : t("debug.notRunning")));
      lock(next, reason || whenHalted);
      lock(goOn, reason || whenHalted);
      lock(more, reason);
    },
  };
}
