// How to begin a program: one of the last programs, a sample of a language, or an example.

import { exampleList, languageOf } from "../examples/index.js";
import { fileButton, h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { acceptedFiles } from "./file_menu.js";
import { languageOf as languageOfFile, TEXT } from "./language_choice.js";
import { miniature } from "./miniature.js";

/** @typedef {import("../editor/file_store.js").StoredFile} StoredFile */
/** @typedef {import("../hosts/program_host.js").Language} Language */

/** @typedef {import("../hosts/program_host.js").Sample} Sample */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("./commands.js").ProgramCommands} ProgramCommands */
/**
 * @typedef {object} StartOptions
 * @property {Translate} t
 * @property {Translate} exampleText
 * @property {(kept: StoredFile) => string} draftLabel
 * @property {(time: number) => string} timeLabel
 * @property {ProgramCommands} commands
 * @property {readonly Language[]} languages
 */

export class StartPage {
  /** What decides the list of the last programs, as it was drawn last. */
  #listed = "";

  /** @param {StartOptions} options */
  constructor(options) {
    const { t, exampleText, commands, languages } = options;
    this.options = options;
    this.sections = languages.map((language) => samplesOf(options, language));
    this.samples = h("div", { class: "program-languages" }, ...this.sections);
    this.examples = exampleList({
      t: exampleText,
      choose: (name) => void commands.openExample(name),
      signOf: (name) => languageSign(options, languageOf(name)),
    });
    this.files = h("ul", { class: "program-own" });
    this.recentPart = part("start-recent", t("file.recent"), this.files);
    this.recentPart.hidden = true;
    this.examplePart = part("start-examples", t("file.examples"), this.examples.element);
    this.back = h(
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
    const title = h("h2", {}, t("new.title"));
    this.element = h(
      "div",
      { class: "program-start", hidden: true },
      h("div", { class: "program-start-head" }, title, h("div", { class: "row" }, this.back, open)),
      this.recentPart,
      this.samples,
      this.examplePart,
    );
    this.element.addEventListener("keydown", ({ key }) => key === "Escape" && !this.back.hidden && commands.back());
  }

  /** Show the samples of a language first. @param {string} id */
  prefer(id) {
    const first = this.sections.filter((section) => section.dataset.samples === id);
    this.samples.replaceChildren(...first, ...this.sections.filter((section) => !first.includes(section)));
    this.element.scrollTop = 0;
  }

  /** Focus the first program; the page stays at its start. */
  focus() {
    /** @type {HTMLElement | null} */ const first = this.element.querySelector(".program-own-card, .program-card");
    first?.focus({ preventScroll: true });
  }

  /**
   * @param {object} facts
   * @param {import("../state/index.js").State} facts.state
   * @param {string} facts.reason   why no example can be started; empty: it can
   * @param {readonly StoredFile[]} facts.recent
   * @param {boolean} facts.canGoBack   whether there is a program to return to
   * @param {readonly string[] | null} facts.allowed   languages that a mission allows; null: all
   */
  render({ state, reason, recent, canGoBack, allowed }) {
    this.back.hidden = !canGoBack;
    this.examples.render(state, reason);
    this.examplePart.hidden = state.behaviors.length === 0 || allowed !== null;
    for (const each of this.sections) each.hidden = !(allowed?.includes(each.dataset.samples ?? "") ?? true);
    this.recentPart.hidden = recent.length === 0;
    const now = JSON.stringify(recent.map(({ name, time, unsaved }) => [name, time, unsaved]));
    if (now === this.#listed) return;
    this.#listed = now;
    this.files.replaceChildren(...recent.map((kept) => recentCard(this.options, kept)));
  }
}

/** A part of the page. @param {string} id  of its title @param {string} title @param {HTMLElement} content */
function part(id, title, content) {
  return h("section", { "aria-labelledby": id }, h("h3", { id }, title), content);
}

/**
 * The samples of a language, below its name if there are several languages.
 *
 * @param {StartOptions} options
 * @param {Language} language
 */
function samplesOf({ t, commands, languages }, language) {
  const { id } = language;
  const title = h("h3", { id: `start-${id}` }, icon(language.icon, { small: true }), t(`language.${id}`));
  const words = h("small", { class: "muted" }, t(`language.${id}.text`));
  const cards = language.samples.map((sample) => sampleCard(t, commands, language, sample));
  const rows = (language.more ?? []).map((sample) => sampleRow(t, commands, language, sample));
  const summary = h("summary", {}, t("new.more"), h("span", { class: "turns" }, icon("caretDown", { small: true })));
  const more = h("details", { class: "disc program-more" }, summary, h("ul", { class: "program-files" }, ...rows));
  return h(
    "section",
    { class: "program-samples", "data-samples": id, "aria-labelledby": `start-${id}` },
    h("div", { class: "program-samples-head", hidden: languages.length < 2 }, title, words),
    h("ul", { class: "program-cards" }, ...cards),
    ...(rows.length === 0 ? [] : [more]),
  );
}

/** @param {Translate} t @param {ProgramCommands} commands @param {Language} language @param {Sample} sample */
function sampleCard(t, commands, language, { name, key, icon: sign }) {
  const attributes = {
    type: "button",
    class: "program-card",
    "data-new": language.id === TEXT ? name : `${language.id}-${name}`,
    onclick: () => void commands.begin(language, name),
  };
  const words = h("span", {}, h("b", {}, t(`new.${key}`)), " ", h("small", {}, t(`new.${key}.text`)));
  return h("li", {}, h("button", attributes, icon(sign), words));
}

/**
 * @param {Translate} t
 * @param {ProgramCommands} commands
 * @param {Language} language
 * @param {{ name: string, key: string }} sample
 */
function sampleRow(t, commands, language, { name, key }) {
  const attributes = { type: "button", class: "btn", "data-new": `${language.id}-${name}` };
  const act = () => void commands.begin(language, name);
  const sign = icon(language.icon, { small: true });
  return h("li", {}, h("button", { ...attributes, onclick: act }, sign, t(`new.${key}`)));
}

/** Which language an example is in, where there are several. @param {StartOptions} options @param {string} id */
function languageSign({ t, languages }, id) {
  const language = languages.find((each) => each.id === id);
  if (language === undefined || languages.length < 2) return null;
  return h("span", { class: "program-sign-of" }, icon(language.icon, { small: true }), t(`language.${id}`));
}

/** One of the last programs. @param {StartOptions} options @param {StoredFile} kept */
function recentCard({ commands, languages, draftLabel, timeLabel }, kept) {
  const language = languages.find(({ id }) => id === languageOfFile(kept, languages));
  const sign = language === undefined ? [] : [icon(language.icon, { small: true })];
  const attributes = {
    type: "button",
    class: "program-own-card",
    "data-recent": kept.name,
    title: kept.unsaved ? draftLabel(kept) : kept.name,
    onclick: () => commands.openRecent(kept),
  };
  const unsaved = h("i", { class: "program-unsaved", "aria-hidden": "true", hidden: !kept.unsaved });
  return h(
    "li",
    {},
    h(
      "button",
      attributes,
      h("span", { class: "program-picture" }, miniature(kept), ...sign),
      h("b", {}, kept.name.replace(/\.aesl$/i, "")),
      h("small", {}, timeLabel(kept.time), unsaved),
    ),
  );
}
