// Panels of the playground creator: tools over the view, the form beside it, the bar below it. All of them act on the
// session.

import "./creator.css";

import { translator } from "../i18n/index.js";
import { download } from "../editor/download.js";
import { faultView, foreignView } from "../panels/fault.js";
import { fileButton, h, icon, lock, setText } from "../panels/dom.js";
import { parse } from "../playground/document.js";
import { lacksGround, itemsOffGround } from "../playground/validation.js";
import { kindNamed } from "../playground/kinds/index.js";
import { Fault } from "../playground/rules.js";
import { textOf } from "../browser/text_file.js";
import { bar } from "./bar.js";
import { newPlayground, withGround } from "./commands.js";
import { itemForm } from "./form.js";
import { CREATOR_ICONS } from "./icons.js";
import { watchCreatorKeys } from "./keys.js";
import { palette } from "./palette.js";
import { watchCreatorPointer } from "./pointer.js";
import { readPicture } from "./read_picture.js";
import { sheetForm } from "./sheet.js";
import { itemList } from "./item_list.js";
import WORDS from "../i18n/creator.texts.js";
import { CreatorSession } from "./creator_session.js";

export { CreatorSession, WORDS };

/** Expectations that only a file of another kind violates. */
const OF_ANOTHER_KIND = ["fault.json", "fault.object", "fault.format"];

/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/**
 * @typedef {object} Creator
 * @property {{ stage: HTMLElement, side: HTMLElement, footer: HTMLElement }} elements
 * @property {(offline: string) => void} render   once per frame: applies pointer moves and updates the panels; `offline` says
 * why the simulator cannot be reached, else it is empty
 * @property {(phrase: Phrase) => void} report
 * @property {(fault: HTMLElement[] | null) => void} refuse   shows the errors of a file; null clears them
 * @property {(file: File) => void} open   opens a playground file
 * @property {() => void} destroy
 */

/**
 * Translate a phrase, including kinds and nested descriptions of steps.
 *
 * @param {import("../i18n/index.js").Translate} t
 * @param {Phrase} phrase
 */
export function inWords(t, { word, values = {} }) {
  const filled = { ...values };
  if (typeof values.kind === "string" && kindNamed(values.kind) !== undefined) filled.kind = t(`kind.${values.kind}`);
  if (typeof values.change === "string") filled.change = t(values.change, values);
  return t(word, filled);
}

/**
 * @param {object} options
 * @param {CreatorSession} options.session
 * @param {string} options.language
 * @param {import("../i18n/index.js").Translate} options.pageText
 * @param {import("../scene/index.js").SceneView} options.scene
 * @param {(text: string) => void} options.announce
 * @param {() => void} options.tryIt
 * @param {() => void} options.close
 * @returns {Creator}
 */
export function createCreator({ session, language, pageText, scene, announce, tryIt, close }) {
  const t = translator(language, WORDS);
  const { model } = session;
  const { canvas } = scene;
  const stage = /** @type {HTMLElement} */ (canvas.parentElement);
  /** @param {Phrase} phrase */
  const say = (phrase) => inWords(t, phrase);
  const setting = {
    t,
    say,
    doors: () => model.playground.items.filter(({ kind }) => kind === "door").map(({ name }) => name),
    readPicture,
  };
  const tools = palette({ t, model, canvas });
  const below = bar(t, model);
  const form = itemForm(setting, model);
  const sheet = sheetForm(setting, model);
  const list = itemList(t, model);
  const fault = h("div", { class: "fault", role: "alert", hidden: true });
  const warning = h("p", { class: "warning", hidden: true });
  const groundless = h(
    "div",
    { class: "warning", role: "status", hidden: true },
    h("p", {}, t("warning.noGround")),
    h(
      "button",
      {
        type: "button",
        "data-verb": "ground",
        onclick: () => model.replacePlayground(withGround(model.playground), { word: "change.ground" }),
      },
      t("warning.addGround"),
    ),
  );
  const unsaved = h("span", { class: "unsaved", title: t("file.unsaved") });
  const name = h("strong", { class: "name" });
  const hint = h("p", { class: "hint building-hint" });
  /** Run an action, then return the keyboard focus to the view. @param {() => void} act */
  const thenFocusView = (act) => () => {
    act();
    canvas.focus();
  };
  const finish = h(
    "button",
    { type: "button", class: "finish", onclick: thenFocusView(() => model.placing?.finish()) },
    icon(CREATOR_ICONS.done),
    t("hint.finish"),
  );
  const cancel = h(
    "button",
    { type: "button", class: "cancel", onclick: thenFocusView(() => model.cancel()) },
    t("hint.cancel"),
  );
  const hints = h("div", { class: "building-hints" }, hint, finish, cancel);

  /** @param {HTMLElement[] | null} reported */
  const refuse = (reported) => {
    fault.hidden = reported === null;
    fault.replaceChildren(...(reported ?? []));
    if (reported !== null) announce(fault.textContent ?? "");
  };
  /** @param {File} file */
  const open = async (file) => {
    refuse(null);
    const content = await textOf(file);
    if (content === null) return refuse(faultView(pageText, pageText("file.notText", { name: file.name }), null));
    try {
      session.replacePlayground(parse(content), { word: "change.opened", values: { name: file.name } });
      refuse(null);
      scene.reframe();
      scene.setView("home");
      report({ word: "change.opened", values: { name: file.name } });
    } catch (error) {
      if (!(error instanceof Fault)) throw error;
      const text = `${error.key === "" ? "" : `${error.key}: `}found ${error.found}, expected ${say(error.expected)}`;
      const headline = t("file.refused", { name: file.name });
      const isWhole = error.key === "" || error.key === "format";
      if (isWhole && OF_ANOTHER_KIND.includes(error.expected.word)) refuse(foreignView(pageText, headline, text));
      else refuse(faultView(pageText, headline, { text, line: null, column: null }));
    }
  };
  const save = () => {
    download(session.fileName, session.text, "application/json");
    session.noteSaved();
    report({ word: "status.saved", values: { name: session.fileName } });
  };
  const fresh = () => {
    session.replacePlayground(newPlayground(t("new.title")), { word: "change.new" });
    refuse(null);
    scene.reframe();
    scene.setView("home");
    report({ word: "change.new" });
  };
  const trying = h(
    "button",
    { type: "button", class: "primary", id: "creator-try", title: t("file.tryHelp"), onclick: tryIt },
    t("file.try"),
  );
  const side = h(
    "div",
    { class: "creator", role: "region", "aria-label": t("creator") },
    h(
      "div",
      { class: "creator-head" },
      name,
      unsaved,
      h("button", { type: "button", class: "leave", onclick: close }, t("file.close")),
    ),
    h(
      "div",
      { class: "row" },
      trying,
      h(
        "button",
        { type: "button", id: "creator-save", title: t("file.saveHelp"), onclick: save },
        icon(CREATOR_ICONS.save),
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
        { type: "button", id: "creator-new", title: t("file.newHelp"), onclick: fresh },
        icon(CREATOR_ICONS.fresh),
        t("file.new"),
      ),
    ),
    fault,
    warning,
    groundless,
    form.element,
    sheet.element,
    list.element,
    h("p", { class: "keys" }, t("keys")),
  );

  /** @param {Phrase} phrase */
  function report(phrase) {
    const text = say(phrase);
    below.report(text);
    announce(text);
  }

  /** @type {import("../playground/document.js").Playground | null} */ let checked = null;
  const pointers = watchCreatorPointer({ stage, canvas, model, scene });
  const removeKeys = watchCreatorKeys({
    stage,
    canvas,
    around: [side, tools.element, below.element],
    model,
    editFields: () => {
      form.render();
      form.focus();
    },
  });
  const label = canvas.getAttribute("aria-label") ?? "";
  canvas.setAttribute("aria-label", t("canvas"));
  const onStage = h("div", { class: "creator-stage" }, tools.element, hints);

  return {
    elements: { stage: onStage, side, footer: below.element },
    report,
    refuse,
    open: (file) => void open(file),
    render(offline) {
      lock(trying, offline);
      pointers.flush();
      scene.camera.controls.enabled = model.cameraOn;
      setText(name, model.playground.title || t("new.title"));
      unsaved.hidden = !session.isUnsaved;
      if (model.playground !== checked) {
        checked = model.playground;
        const outside = itemsOffGround(checked.items).map((item) => item.name);
        warning.hidden = outside.length === 0;
        groundless.hidden = !lacksGround(checked.items);
        setText(warning, outside.length === 0 ? "" : t("warning.outside", { names: outside.join(", ") }));
      }
      const { placing } = model;
      const problem = model.ghost?.problem ?? null;
      const word = placing === null ? "" : placing.isPath ? `hint.${placing.kind}` : "hint.placing";
      setText(
        hint,
        problem !== null ? say(problem) : word === "" ? "" : say({ word, values: { kind: placing?.kind ?? "" } }),
      );
      hint.classList.toggle("taken", problem !== null);
      hints.hidden = hint.textContent === "";
      finish.hidden = placing?.kind !== "track" || placing.points.length < 2;
      cancel.hidden = placing === null;
      for (const part of [tools, below, form, sheet, list]) part.render();
    },
    destroy() {
      pointers.destroy();
      removeKeys();
      scene.camera.controls.enabled = true;
      canvas.setAttribute("aria-label", label);
      onStage.remove();
      side.remove();
      below.element.remove();
    },
  };
}
