// The head of the creator's panel: name of the playground, and the buttons that try, save, open, create and leave; below
// them why a file was rejected.

import { textOf } from "../browser/text_file.js";
import { download } from "../editor/download.js";
import { fileButton, h, lock, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { faultView, foreignView } from "../playground_tab/refusal.js";
import { parse } from "../playground/document.js";
import { Fault } from "../playground/rules.js";
import { newPlayground } from "./commands.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */

/** Expectations that only a file of another kind violates. */
const OF_ANOTHER_KIND = ["fault.json", "fault.object", "fault.format"];

/**
 * @param {object} options
 * @param {import("./creator_session.js").CreatorSession} options.session
 * @param {import("./labels.js").Labels} options.labels
 * @param {(file: import("../i18n/page_texts.js").TextFile) => Translate} options.text   the texts of the page
 * @param {import("../scene/index.js").SceneView} options.scene
 * @param {(phrase: import("../playground/rules.js").Phrase) => void} options.report
 * @param {(text: string) => void} options.announce
 * @param {() => void} options.tryIt
 * @param {() => void} options.close
 */
export function filePanel({ session, labels, text: textOfPage, scene, report, announce, tryIt, close }) {
  const { t } = labels;
  const pageText = textOfPage("page");
  const playgroundText = textOfPage("playground");
  const { model } = session;
  const name = h("strong", { class: "name" });
  const unsaved = h("span", { class: "unsaved", title: t("file.unsaved") });
  const leave = h("button", { type: "button", class: "btn line leave", onclick: close }, t("file.close"));
  const head = h("div", { class: "creator-head" }, name, unsaved, leave);
  const fault = h("div", { class: "fault", role: "alert", hidden: true });
  const attempt = h(
    "button",
    { type: "button", class: "btn you", id: "creator-try", title: t("file.tryHelp"), onclick: tryIt },
    t("file.try"),
  );
  const row = h(
    "div",
    { class: "row" },
    attempt,
    h(
      "button",
      { type: "button", class: "btn line", id: "creator-save", title: t("file.saveHelp"), onclick: save },
      icon("save"),
      t("file.save"),
    ),
    fileButton({
      id: "creator-file",
      label: t("file.open"),
      help: t("file.openHelp"),
      accept: ".json",
      open: (file) => void open(file),
    }),
    h(
      "button",
      { type: "button", class: "btn line", id: "creator-new", title: t("file.newHelp"), onclick: create },
      icon("file"),
      t("file.new"),
    ),
  );

  /** Show why a file was rejected; null clears that. @param {HTMLElement[] | null} reasons */
  function refuse(reasons) {
    fault.hidden = reasons === null;
    fault.replaceChildren(...(reasons ?? []));
    if (reasons !== null) announce(fault.textContent ?? "");
  }

  /**
   * @param {import("../playground/document.js").Playground} playground
   * @param {import("../playground/rules.js").Phrase} change
   */
  function replace(playground, change) {
    session.replacePlayground(playground, change);
    refuse(null);
    scene.reframe();
    scene.setView("home");
    report(change);
  }

  /** @param {File} file */
  async function open(file) {
    refuse(null);
    const content = await textOf(file);
    if (content === null) return refuse(faultView(playgroundText, pageText("file.notText", { name: file.name }), null));
    try {
      replace(parse(content), { word: "change.opened", values: { name: file.name } });
    } catch (error) {
      if (!(error instanceof Fault)) throw error;
      const text = `${error.key === "" ? "" : `${error.key}: `}found ${error.found}, expected ${labels.text(error.expected)}`;
      const headline = t("file.refused", { name: file.name });
      const isWhole = error.key === "" || error.key === "format";
      if (isWhole && OF_ANOTHER_KIND.includes(error.expected.word)) refuse(foreignView(playgroundText, headline, text));
      else refuse(faultView(playgroundText, headline, { text, line: null, column: null }));
    }
  }

  function save() {
    download(session.fileName, session.text, "application/json");
    session.noteSaved();
    report({ word: "status.saved", values: { name: session.fileName } });
  }

  function create() {
    replace(newPlayground(t("new.title")), { word: "change.new" });
  }

  return {
    head,
    elements: [row, fault],
    refuse,
    /** @param {File} file */
    open: (file) => void open(file),
    /** @param {string} offline  why the simulator cannot be reached, else empty */
    render(offline) {
      lock(attempt, offline);
      setText(name, model.playground.title || t("new.title"));
      unsaved.hidden = !session.isUnsaved;
    },
  };
}
