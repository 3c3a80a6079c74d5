// The head of the creator: back, title, where it is kept, more, "Try it"; below them why a file was rejected.

import { download } from "../browser/download.js";
import { textOf } from "../browser/text_file.js";
import { BUILT_IN } from "../playground/declarations.js";
import { parse } from "../playground/document.js";
import { problemsOf } from "../playground/mission.js";
import { pack, unpack } from "../playground/mission_archive.js";
import { Fault, fits } from "../playground/rules.js";
import { reasonOfFault, refusalView } from "../playground_tab/refusal.js";
import { h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";
import { newPlayground, titled } from "./commands.js";
import { usualText } from "./mission_goals.js";

/** @typedef {import("../browser/opened_file.js").Place} Place */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/**
 * @typedef {object} HeadOptions
 * @property {import("./creator_session.js").CreatorSession} session
 * @property {import("../playground/labels.js").Labels} labels
 * @property {import("../shell/context.js").Context} context
 * @property {(phrase: Phrase) => void} report
 * @property {() => void} tryIt
 * @property {() => void} close
 */

export class Head {
  /** @param {HeadOptions} options */
  constructor(options) {
    const { session, labels, tryIt, close } = options;
    const { t } = labels;
    this.options = options;
    this.words = { fresh: t("file.fresh"), device: t("file.kept"), file: t("file.saved"), none: t("file.notKept") };
    this.title = titleField(t, session.model);
    this.kept = h("p", { class: "kept", role: "status" });
    this.fault = h("div", { class: "fault", role: "alert", hidden: true });
    this.attempt = h(
      "button",
      { type: "button", class: "btn you", id: "creator-try", title: t("file.tryHelp"), onclick: tryIt },
      icon("run"),
      h("span", {}, t("file.try")),
    );
    this.tries = [t("file.try"), t("file.tryMission")];
    const leave = t("file.leave");
    const back = h(
      "button",
      { type: "button", class: "btn icon leave", title: leave, "aria-label": leave, onclick: close },
      icon("back"),
    );
    const file = this.#fileField();
    const element = h(
      "div",
      { class: "creator-head" },
      back,
      h("div", { class: "creator-title" }, ...this.title.elements, this.kept),
      this.#menu(file),
      this.attempt,
      file,
    );
    this.elements = [element, this.fault];
  }

  /** @param {string} offline  why the simulator cannot be reached, else empty */
  render(offline) {
    const { session } = this.options;
    const { kept } = session;
    lock(this.attempt, offline);
    const [playground, mission] = this.tries;
    setText(/** @type {Element} */ (this.attempt.lastElementChild), session.model.playground.mission === undefined ? playground : mission);
    this.title.render();
    setAttribute(this.kept, "data-kept", kept);
    setText(this.kept, this.words[kept]);
  }

  /**
   * Show why a file was rejected, at the place where it was dropped; null clears that.
   *
   * @param {Node[] | null} reasons
   * @param {Place | null} [place]
   */
  refuse(reasons, place = null) {
    const { messageAt, announce, text } = this.options.context;
    messageAt.hide();
    const isHere = reasons !== null && place === null;
    this.fault.hidden = !isHere;
    this.fault.replaceChildren(...(isHere ? reasons : []));
    if (isHere) announce(this.fault.textContent ?? "");
    else if (reasons !== null && place !== null) messageAt.show(place, reasons, text("page")("notice.dismiss"));
  }

  /** @param {File} chosen @param {Place | null} [place] */
  async open(chosen, place = null) {
    const { labels, context } = this.options;
    const { language } = context;
    this.refuse(null);
    const headline = labels.t("file.refused", { name: chosen.name });
    if (/\.zip$/i.test(chosen.name)) return this.#openMission(chosen, headline, place);
    const content = await textOf(chosen);
    if (content === null) {
      const reason = { phrase: { word: "fault.json" }, place: null, technical: chosen.type };
      return this.refuse(refusalView(language, headline, reason), place);
    }
    try {
      this.#replace(parse(content), { word: "change.opened", values: { name: chosen.name } }, true);
    } catch (error) {
      if (!(error instanceof Fault)) throw error;
      this.refuse(refusalView(language, headline, reasonOfFault(error, content)), place);
    }
  }

  /** @param {File} chosen @param {string} headline @param {Place | null} place */
  async #openMission(chosen, headline, place) {
    const bytes = new Uint8Array(await chosen.arrayBuffer());
    try {
      this.#replace(unpack(bytes), { word: "change.opened", values: { name: chosen.name } }, true);
    } catch (error) {
      if (!(error instanceof Fault)) throw error;
      const { key, expected, message } = error;
      const phrase = { ...expected, values: { key, ...expected.values } };
      this.refuse(refusalView(this.options.context.language, headline, { phrase, place: null, technical: message }), place);
    }
  }

  #fileField() {
    const field = h("input", {
      type: "file",
      id: "creator-file",
      accept: ".json,.zip",
      hidden: true,
      "aria-label": this.options.labels.t("file.openHelp"),
    });
    field.addEventListener("change", () => {
      const chosen = field.files?.[0];
      if (chosen !== undefined) void this.open(chosen);
      field.value = ""; // so that the same file can be opened again
    });
    return field;
  }

  /** @param {HTMLInputElement} file */
  #menu(file) {
    const { t } = this.options.labels;
    const label = t("file.more");
    const button = h(
      "button",
      { type: "button", class: "btn line icon", id: "creator-more", title: label, "aria-label": label },
      icon("more"),
    );
    return menu({
      id: "creator-menu",
      button,
      label,
      entries: () => [
        { label: t("file.save"), icon: "save", act: () => this.#save(), attributes: { "data-verb": "save" } },
        { label: t("file.share"), icon: "share", act: () => this.#share(), attributes: { "data-verb": "share" } },
        { label: t("file.open"), icon: "open", act: () => file.click(), attributes: { "data-verb": "open" } },
        { label: t("file.new"), icon: "file", act: () => this.#create(), attributes: { "data-verb": "new" } },
      ],
    }).element;
  }

  /** The file of the mission; null if something is missing in it, which is reported. */
  packMission() {
    const { session, report, labels } = this.options;
    const { playground } = session.model;
    const [problem] = problemsOf(playground);
    if (problem !== undefined) {
      report(problem.phrase);
      return null;
    }
    return { name: session.fileName.replace(/json$/, "zip"), content: pack(playground, (goal) => usualText(labels.t, goal)) };
  }

  /** Say which solutions of a mission do not pass. @param {{ name: string, content: Uint8Array }} file  as `packMission` gives it */
  async checkMission({ name, content }) {
    const { session, context, labels } = this.options;
    const { actions, store } = context;
    const hasSolutions = Object.keys(session.model.playground.mission?.solutions ?? {}).length > 0;
    if (!hasSolutions || store.state.connection !== "connected") return;
    const { failing, reason } = await actions.checkMission(name, content);
    const sentences = Object.entries(failing).map(([language, stars]) =>
      labels.t("mission.failing", { language: labels.t(`mission.language.${language}`), count: stars.filter(Boolean).length, all: stars.length }),
    );
    const text = reason || sentences.join(" ");
    if (text !== "") store.dispatch({ type: "notice", level: "warning", text });
  }

  #save() {
    const { session, report } = this.options;
    const isMission = session.model.playground.mission !== undefined;
    const file = isMission ? this.packMission() : { name: session.fileName, content: session.text };
    if (file === null) return;
    download(file.name, file.content, isMission ? "application/zip" : "application/json");
    session.noteSaved();
    report({ word: "status.saved", values: { name: file.name } });
    if (typeof file.content !== "string") void this.checkMission({ name: file.name, content: file.content });
  }

  #share() {
    const { session, context } = this.options;
    const { share } = context;
    if (session.model.playground.mission === undefined) return void share.sharePlayground(session.fileName, session.text);
    const file = this.packMission();
    if (file !== null) void share.shareMission(file.name, file.content);
  }

  #create() {
    this.#replace(newPlayground(this.options.labels.t("new.title")), { word: "change.new" }, false);
  }

  /**
   * @param {import("../playground/document.js").Playground} playground
   * @param {Phrase} change
   * @param {boolean} inFile
   */
  #replace(playground, change, inFile) {
    const { session, context, report } = this.options;
    session.replacePlayground(playground, change, inFile);
    this.refuse(null);
    context.scene.reframe();
    context.scene.setView("home");
    report(change);
  }
}

/**
 * The title of the playground, and what is wrong with a new one.
 *
 * @param {Translate} t
 * @param {import("./creator_model.js").CreatorModel} model
 */
function titleField(t, model) {
  const field = h("input", {
    type: "text",
    class: "title",
    "data-field": "title",
    "aria-label": t("field.title"),
    autocomplete: "off",
    spellcheck: "false",
  });
  const problem = h("small", { class: "problem", role: "alert", hidden: true });
  /** @type {string | null} */ let shown = null;
  field.addEventListener("change", () => {
    const fitting = fits(BUILT_IN.titles.title, field.value);
    problem.hidden = fitting;
    setText(problem, fitting ? "" : t("problem.line"));
    field.setAttribute("aria-invalid", String(!fitting));
    if (fitting) model.replacePlayground(titled(model.playground, { title: field.value }), { word: "change.titled" });
  });
  field.addEventListener("keydown", ({ key }) => {
    if (key === "Enter") field.blur(); // a change, and the heading looks like one again
  });
  return {
    elements: [field, problem],
    render() {
      const now = model.playground.title;
      if (now === shown) return;
      shown = now;
      field.value = now || t("new.title");
      problem.hidden = true;
    },
  };
}
