// How to begin a program: one of the last programs, a sample of a language, or an example.

import { exampleList, languageOf } from "../examples/index.js";
import { fileButton, h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { acceptedFiles } from "./file_menu.js";
import { languageOf as languageOfFile, TEXT } from "./language_choice.js";
import { miniature } from "./miniature.js";

/** @typedef {import("../editor/file_store.js").StoredFile} StoredFile */
/** @typedef {import("../hosts/program_host.js").Language} Language */

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {import("../i18n/index.js").Translate} options.exampleText
 * @param {(kept: StoredFile) => string} options.draftLabel
 * @param {(time: number) => string} options.timeLabel
 * @param {import("./commands.js").ProgramCommands} options.commands
 * @param {readonly Language[]} options.languages
 */
export function startPage({ t, exampleText, draftLabel, timeLabel, commands, languages }) {
  /** @param {Language} language @param {import("../hosts/program_host.js").Sample} sample */
  const card = (language, { name, key, icon: sign }) =>
    h(
      "li",
      {},
      h(
        "button",
        {
          type: "button",
          class: "program-card",
          "data-new": language.id === TEXT ? name : `${language.id}-${name}`,
          onclick: () => void commands.begin(language, name),
        },
        icon(sign),
        h("span", {}, h("b", {}, t(`new.${key}`)), " ", h("small", {}, t(`new.${key}.text`))),
      ),
    );
  /** @param {Language} language @param {string} name @param {string} key */
  const row = (language, name, key) => {
    const attributes = { type: "button", class: "btn", "data-new": `${language.id}-${name}` };
    const act = () => void commands.begin(language, name);
    const sign = icon(language.icon, { small: true });
    return h("li", {}, h("button", { ...attributes, onclick: act }, sign, t(`new.${key}`)));
  };
  /** The samples of a language, below its name if there are several languages. @param {Language} language */
  const sectionOf = (language) => {
    const { id } = language;
    const title = h("h3", { id: `start-${id}` }, icon(language.icon, { small: true }), t(`language.${id}`));
    const words = h("small", { class: "muted" }, t(`language.${id}.text`));
    const cards = h("ul", { class: "program-cards" }, ...language.samples.map((sample) => card(language, sample)));
    const rows = (language.more ?? []).map(({ name, key }) => row(language, name, key));
    const summary = h("summary", {}, t("new.more"), h("span", { class: "turns" }, icon("caretDown", { small: true })));
    const more = h("details", { class: "disc program-more" }, summary, h("ul", { class: "program-files" }, ...rows));
    return h(
      "section",
      { class: "program-samples", "data-samples": language.id, "aria-labelledby": `start-${language.id}` },
      h("div", { class: "program-samples-head", hidden: languages.length < 2 }, title, words),
      cards,
      ...(rows.length === 0 ? [] : [more]),
    );
  };
  const sections = languages.map(sectionOf);
  const samples = h("div", { class: "program-languages" }, ...sections);
  /** @param {string} name  of an example */
  const signOf = (name) => {
    const language = languages.find(({ id }) => id === languageOf(name));
    if (language === undefined || languages.length < 2) return null;
    return h("span", { class: "program-sign-of" }, icon(language.icon, { small: true }), t(`language.${language.id}`));
  };
  const examples = exampleList({ t: exampleText, choose: (name) => void commands.openExample(name), signOf });
  const files = h("ul", { class: "program-own" });
  const recentPart = h(
    "section",
    { "aria-labelledby": "start-recent", hidden: true },
    h("h3", { id: "start-recent" }, t("file.recent")),
    files,
  );
  const examplePart = h(
    "section",
    { "aria-labelledby": "start-examples" },
    h("h3", { id: "start-examples" }, t("file.examples")),
    examples.element,
  );
  const back = h(
    "button",
    { type: "button", class: "btn line", "data-new": "back", onclick: () => commands.back() },
    icon("back", { small: true }),
    t("new.back"),
  );
  const open = fileButton({
    id: "start-file",
    label: t("file.open"),
    help: t("file.open"),
    accept: acceptedFiles(commands),
    open: (file) => void commands.open(file),
  });
  const element = h(
    "div",
    { class: "program-start", hidden: true },
    h("div", { class: "program-start-head" }, h("h2", {}, t("new.title")), h("div", { class: "row" }, back, open)),
    recentPart,
    samples,
    examplePart,
  );
  element.addEventListener("keydown", ({ key }) => key === "Escape" && !back.hidden && commands.back());
  /** @param {StoredFile} kept */
  const ownCard = (kept) => {
    const language = languages.find(({ id }) => id === languageOfFile(kept.text, languages));
    const sign = language === undefined ? [] : [icon(language.icon, { small: true })];
    const title = kept.name.replace(/\.aesl$/i, "");
    return h(
      "li",
      {},
      h(
        "button",
        {
          type: "button",
          class: "program-own-card",
          "data-recent": kept.name,
          title: kept.unsaved ? draftLabel(kept) : kept.name,
          onclick: () => commands.openRecent(kept),
        },
        h("span", { class: "program-picture" }, miniature(kept.text), ...sign),
        h("b", {}, title),
        h("small", {}, timeLabel(kept.time), h("i", { class: "program-unsaved", "aria-hidden": "true", hidden: !kept.unsaved })),
      ),
    );
  };
  let listed = "";
  return {
    element,
    /** Show the samples of a language first. @param {string} id */
    prefer(id) {
      const first = sections.filter((section) => section.dataset.samples === id);
      samples.replaceChildren(...first, ...sections.filter((section) => !first.includes(section)));
      element.scrollTop = 0;
    },
    focus() {
      /** @type {HTMLElement | null} */ (element.querySelector(".program-own-card, .program-card"))?.focus();
    },
    /**
     * @param {object} facts
     * @param {import("../state/index.js").State} facts.state
     * @param {string} facts.reason   why no example can be started; empty: it can
     * @param {readonly StoredFile[]} facts.recent
     * @param {boolean} facts.canGoBack   whether there is a program to return to
     */
    render({ state, reason, recent, canGoBack }) {
      back.hidden = !canGoBack;
      examples.render(state, reason);
      examplePart.hidden = state.behaviors.length === 0;
      recentPart.hidden = recent.length === 0;
      const now = JSON.stringify(recent.map(({ name, time, unsaved }) => [name, time, unsaved]));
      if (now === listed) return;
      listed = now;
      files.replaceChildren(...recent.map(ownCard));
    },
  };
}
