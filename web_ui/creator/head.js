// The head of the creator: back, title, where it is kept, more, "Try it"; below them why a file was rejected.

import { download } from "../browser/download.js";
import { textOf } from "../browser/text_file.js";
import { BUILT_IN } from "../playground/declarations.js";
import { parse } from "../playground/document.js";
import { Fault, fits } from "../playground/rules.js";
import { reasonOfFault, refusalView } from "../playground_tab/refusal.js";
import { h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";
import { newPlayground, titled } from "./commands.js";

/** @typedef {import("../browser/opened_file.js").Place} Place */

/**
 * @param {object} options
 * @param {import("./creator_session.js").CreatorSession} options.session
 * @param {import("../playground/labels.js").Labels} options.labels
 * @param {import("../shell/context.js").Context} options.context
 * @param {(phrase: import("../playground/rules.js").Phrase) => void} options.report
 * @param {() => void} options.tryIt
 * @param {() => void} options.close
 */
export function head({ session, labels, context, report, tryIt, close }) {
  const { t } = labels;
  const { scene, announce, messageAt, language } = context;
  const pageText = context.text("page");
  const { model } = session;
  const title = h("input", {
    type: "text",
    class: "title",
    "data-field": "title",
    "aria-label": t("field.title"),
    autocomplete: "off",
    spellcheck: "false",
  });
  const kept = h("p", { class: "kept", role: "status" });
  const problem = h("small", { class: "problem", role: "alert", hidden: true });
  const fault = h("div", { class: "fault", role: "alert", hidden: true });
  const file = h("input", {
    type: "file",
    id: "creator-file",
    accept: ".json",
    hidden: true,
    "aria-label": t("file.openHelp"),
  });
  const attempt = h(
    "button",
    { type: "button", class: "btn you", id: "creator-try", title: t("file.tryHelp"), onclick: tryIt },
    icon("run"),
    t("file.try"),
  );
  const back = h(
    "button",
    { type: "button", class: "btn icon leave", title: t("file.leave"), "aria-label": t("file.leave"), onclick: close },
    icon("back"),
  );
  const more = h(
    "button",
    { type: "button", class: "btn line icon", id: "creator-more", title: t("file.more"), "aria-label": t("file.more") },
    icon("more"),
  );
  const list = menu({
    id: "creator-menu",
    button: more,
    label: t("file.more"),
    entries: () => [
      { label: t("file.save"), icon: "save", act: save, attributes: { "data-verb": "save" } },
      { label: t("file.open"), icon: "open", act: () => file.click(), attributes: { "data-verb": "open" } },
      { label: t("file.new"), icon: "file", act: create, attributes: { "data-verb": "new" } },
    ],
  });
  const element = h(
    "div",
    { class: "creator-head" },
    back,
    h("div", { class: "creator-title" }, title, problem, kept),
    list.element,
    attempt,
    file,
  );
  /** @type {string | null} */ let shown = null;

  title.addEventListener("change", () => {
    const fitting = fits(BUILT_IN.titles.title, title.value);
    problem.hidden = fitting;
    setText(problem, fitting ? "" : t("problem.line"));
    title.setAttribute("aria-invalid", String(!fitting));
    if (fitting) model.replacePlayground(titled(model.playground, { title: title.value }), { word: "change.titled" });
  });
  title.addEventListener("keydown", ({ key }) => {
    if (key === "Enter") title.blur(); // a change, and the heading looks like one again
  });
  file.addEventListener("change", () => {
    const chosen = file.files?.[0];
    if (chosen !== undefined) void open(chosen);
    file.value = ""; // so that the same file can be opened again
  });

  /** Show why a file was rejected, at the place where it was dropped; null clears that. @param {Node[] | null} reasons @param {Place | null} [place] */
  function refuse(reasons, place = null) {
    messageAt.hide();
    const isHere = reasons !== null && place === null;
    fault.hidden = !isHere;
    fault.replaceChildren(...(isHere ? reasons : []));
    if (isHere) announce(fault.textContent ?? "");
    else if (reasons !== null && place !== null) messageAt.show(place, reasons, pageText("notice.dismiss"));
  }

  /**
   * @param {import("../playground/document.js").Playground} playground
   * @param {import("../playground/rules.js").Phrase} change
   * @param {boolean} inFile
   */
  function replace(playground, change, inFile) {
    session.replacePlayground(playground, change, inFile);
    refuse(null);
    scene.reframe();
    scene.setView("home");
    report(change);
  }

  /** @param {File} chosen @param {Place | null} [place] */
  async function open(chosen, place = null) {
    refuse(null);
    const content = await textOf(chosen);
    const headline = t("file.refused", { name: chosen.name });
    if (content === null) {
      return refuse(refusalView(language, headline, { phrase: { word: "fault.json" }, place: null, technical: chosen.type }), place);
    }
    try {
      replace(parse(content), { word: "change.opened", values: { name: chosen.name } }, true);
    } catch (error) {
      if (!(error instanceof Fault)) throw error;
      refuse(refusalView(language, headline, reasonOfFault(error, content)), place);
    }
  }

  function save() {
    download(session.fileName, session.text, "application/json");
    session.noteSaved();
    report({ word: "status.saved", values: { name: session.fileName } });
  }

  function create() {
    replace(newPlayground(t("new.title")), { word: "change.new" }, false);
  }

  const words = { fresh: t("file.fresh"), device: t("file.kept"), file: t("file.saved"), none: t("file.notKept") };
  return {
    elements: [element, fault],
    refuse,
    open,
    /** @param {string} offline  why the simulator cannot be reached, else empty */
    render(offline) {
      lock(attempt, offline);
      const now = model.playground.title;
      if (now !== shown) {
        shown = now;
        title.value = now || t("new.title");
        problem.hidden = true;
      }
      const state = session.kept;
      setAttribute(kept, "data-kept", state);
      setText(kept, words[state]);
    },
  };
}
