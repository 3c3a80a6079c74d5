// The head of the tab: the language of the program, run and stop.

import { h, lock, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {readonly import("../hosts/program_host.js").Language[]} options.languages
 * @param {(id: string) => void} options.choose   shows the program in another language
 * @param {import("./commands.js").ProgramCommands} options.commands
 */
export function programHead({ t, languages, choose, commands }) {
  const choices = languages.map(({ id, icon: sign }) =>
    h(
      "button",
      {
        type: "button",
        class: "btn",
        "data-language": id,
        "aria-pressed": "false",
        "aria-label": t(`language.${id}`),
        title: t(`language.${id}`),
        onclick: () => choose(id),
      },
      icon(sign, { small: true }),
      h("span", {}, t(`language.${id}`)),
    ),
  );
  const group = { class: "seg", role: "group", "aria-label": t("language"), hidden: languages.length < 2 };
  const language = h("div", group, ...choices);
  const place = h("span", { class: "program-place" });
  const run = h(
    "button",
    {
      type: "button",
      class: "btn run",
      "data-verb": "run",
      title: `${t("editor.run")} (F9)`,
      onclick: () => void commands.run(),
    },
    icon("run"),
    h("span", {}, t("editor.run")),
  );
  const stop = h(
    "button",
    { type: "button", class: "btn line", "data-verb": "stop", onclick: () => void commands.control("stop") },
    icon("stop"),
    h("span", {}, t("editor.stop")),
  );
  return {
    element: h("div", { class: "program-head" }, language, place, h("span", { class: "grow" }), run, stop),
    /** Where the menu of the file is in a narrow tab. */
    place,
    /**
     * @param {object} facts
     * @param {string} facts.reason       why robots cannot be controlled; empty: they can
     * @param {boolean} facts.hasMistake
     * @param {boolean} facts.isStart     whether no program is shown, but the ways to begin one
     * @param {string} facts.shown        the language of the view
     * @param {readonly string[] | null} facts.allowed   languages that a mission allows; null: all
     */
    render({ reason, hasMistake, isStart, shown, allowed }) {
      for (const each of choices) each.hidden = !(allowed?.includes(each.dataset.language ?? "") ?? true);
      for (const each of choices) setAttribute(each, "aria-pressed", String(!isStart && each.dataset.language === shown));
      lock(run, reason || (isStart ? t("new.title") : hasMistake ? t("editor.runBlocked") : ""));
      lock(stop, reason || (commands.can("stop") ? "" : t("editor.unavailable")));
    },
  };
}
