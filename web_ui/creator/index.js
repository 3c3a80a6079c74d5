// The creator of playgrounds on the page: hints over the view, tools and form beside it, the bar below it. Each part has its own
// module and acts on the session.

import "./creator.css";

import WORDS from "../i18n/creator.texts.js";
import { translator } from "../i18n/index.js";
import { h } from "../ui/dom.js";
import { bar } from "./bar.js";
import { CreatorSession } from "./creator_session.js";
import { filePanel } from "./file_panel.js";
import { itemForm } from "./form.js";
import { groundWarnings } from "./ground_warnings.js";
import { itemList } from "./item_list.js";
import { watchCreatorKeys } from "./keys.js";
import { Labels } from "./labels.js";
import { palette } from "./palette.js";
import { placingHint } from "./placing_hint.js";
import { watchCreatorPointer } from "./pointer.js";
import { readPicture } from "./read_picture.js";
import { sheetForm } from "./sheet.js";

export { CreatorSession, WORDS };

/** @typedef {import("../playground/rules.js").Phrase} Phrase */

export class Creator {
  /**
   * @param {object} options
   * @param {CreatorSession} options.session
   * @param {string} options.language
   * @param {(file: import("../i18n/page_texts.js").TextFile) => import("../i18n/index.js").Translate} options.text   of the page
   * @param {import("../scene/index.js").SceneView} options.scene
   * @param {(text: string) => void} options.announce
   * @param {() => void} options.tryIt
   * @param {() => void} options.close
   */
  constructor({ session, language, text, scene, announce, tryIt, close }) {
    const { model } = session;
    const { canvas } = scene;
    const stage = /** @type {HTMLElement} */ (canvas.parentElement);
    const t = translator(language, WORDS);
    const labels = new Labels(language, t);
    this.model = model;
    this.scene = scene;
    this.announce = announce;
    this.labels = labels;
    const setting = {
      labels,
      doors: () => model.playground.items.filter(({ kind }) => kind === "door").map(({ name }) => name),
      readPicture,
    };
    const report = this.report.bind(this);
    this.files = filePanel({ session, labels, text, scene, report, announce, tryIt, close });
    this.bar = bar(t, model);
    const form = itemForm(setting, model);
    const sheet = sheetForm(setting, model);
    const list = itemList(labels, model);
    const warnings = groundWarnings(t, model);
    const tools = palette({ labels, model, canvas });
    const hints = placingHint({ labels, model, canvas });
    this.parts = [tools, hints, this.bar, warnings, form, sheet, list];
    this.elements = {
      stage: h("div", { class: "creator-stage" }, hints.element),
      side: h(
        "div",
        { class: "creator", role: "region", "aria-label": t("creator") },
        this.files.head,
        tools.element,
        ...this.files.elements,
        ...warnings.elements,
        form.element,
        sheet.element,
        list.element,
        h("p", { class: "keys" }, t("keys")),
      ),
      footer: this.bar.element,
    };
    this.pointer = watchCreatorPointer({ stage, canvas, model, scene });
    this.removeKeys = watchCreatorKeys({
      stage,
      canvas,
      around: [this.elements.side, this.bar.element],
      model,
      editFields: () => {
        form.render();
        form.focus();
      },
    });
    this.canvasLabel = canvas.getAttribute("aria-label") ?? "";
    canvas.setAttribute("aria-label", t("canvas"));
  }

  /**
   * Call once per frame: applies pointer moves and updates the panels.
   *
   * @param {string} offline  why the simulator cannot be reached, else empty
   */
  render(offline) {
    this.pointer.flush();
    this.scene.camera.controls.enabled = this.model.cameraOn;
    this.files.render(offline);
    for (const part of this.parts) part.render();
  }

  /** Show and announce a message. @param {Phrase} phrase */
  report(phrase) {
    const text = this.labels.text(phrase);
    this.bar.report(text);
    this.announce(text);
  }

  /** Show the errors of a file; null clears them. @param {HTMLElement[] | null} fault */
  refuse(fault) {
    this.files.refuse(fault);
  }

  /** Open a playground file. @param {File} file */
  open(file) {
    this.files.open(file);
  }

  destroy() {
    this.pointer.destroy();
    this.removeKeys();
    this.scene.camera.controls.enabled = true;
    this.scene.canvas.setAttribute("aria-label", this.canvasLabel);
    for (const element of Object.values(this.elements)) element.remove();
  }
}
