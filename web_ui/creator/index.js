// The creator of playgrounds on the page: hints and the bar of the selected item over the view, tools and form beside it,
// a bar below it. Each part has its own module and acts on the session.

import "./creator.css";

import WORDS from "../i18n/creator.texts.js";
import { translator } from "../i18n/index.js";
import { Labels } from "../playground/labels.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { bar } from "./bar.js";
import { newPlayground } from "./commands.js";
import { contextBar } from "./context_bar.js";
import { CreatorSession } from "./creator_session.js";
import { ItemForm } from "./form.js";
import { Head } from "./head.js";
import { itemList } from "./item_list.js";
import { watchCreatorKeys } from "./keys.js";
import { missionForm } from "./mission_form.js";
import { palette } from "./palette.js";
import { placingHint } from "./placing_hint.js";
import { playgroundForm } from "./playground_form.js";
import { watchCreatorPointer } from "./pointer.js";
import { readPicture } from "./read_picture.js";
import { stageTools } from "./stage_tools.js";
import { warnings } from "./warnings.js";

export { CreatorSession, newPlayground, WORDS };

/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {import("../browser/opened_file.js").Place} Place */

export class Creator {
  /**
   * @param {object} options
   * @param {CreatorSession} options.session
   * @param {import("../shell/context.js").Context} options.context
   * @param {() => void} options.tryIt
   * @param {() => void} options.close
   */
  constructor({ session, context, tryIt, close }) {
    const { model } = session;
    const { scene, language } = context;
    const { canvas } = scene;
    const stage = /** @type {HTMLElement} */ (canvas.parentElement);
    const t = translator(language, WORDS);
    const labels = new Labels(language, t);
    this.model = model;
    this.scene = scene;
    this.announce = context.announce;
    this.labels = labels;
    const setting = {
      labels,
      doors: () => model.playground.items.filter(({ kind }) => kind === "door").map(({ name }) => name),
      readPicture,
    };
    const report = this.report.bind(this);
    this.head = new Head({ session, labels, context, report, tryIt, close });
    this.bar = bar(labels, model);
    const form = new ItemForm(setting, model);
    const whole = playgroundForm(setting, model);
    const mission = missionForm({ setting, model, openProgram: () => context.program.openProgram() });
    const list = itemList(labels, model);
    const notes = warnings(labels, model);
    const tools = palette({ labels, model, canvas });
    const hints = placingHint({ labels, model, canvas });
    const over = contextBar({ labels, model, scene });
    const views = stageTools({ labels, model, canvas });
    this.parts = [tools, views, hints, over, this.bar, notes, form, whole, mission, list];
    const caret = h("span", { class: "turns" }, icon("caretDown", { small: true }));
    const summary = h("summary", {}, icon("keys", { small: true }), h("span", { class: "grow" }, t("keys.title")), caret);
    this.elements = {
      views: views.element,
      hints: hints.element,
      stage: h("div", { class: "creator-stage" }, over.element),
      side: h(
        "div",
        { class: "creator", role: "region", "aria-label": t("creator") },
        ...this.head.elements,
        tools.element,
        ...notes.elements,
        form.element,
        whole.element,
        mission.element,
        list.element,
        h("details", { class: "creator-keys disc" }, summary, h("p", { class: "small muted" }, t("keys"))),
      ),
      footer: this.bar.element,
    };
    this.pointer = watchCreatorPointer({ stage, canvas, model, scene });
    this.removeKeys = watchCreatorKeys({
      stage,
      canvas,
      around: [this.elements.side, this.bar.element, over.element, views.element],
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
    this.head.render(offline);
    for (const part of this.parts) part.render();
  }

  /** Show and announce a message. @param {Phrase} phrase */
  report(phrase) {
    const text = this.labels.text(phrase);
    this.bar.report(text);
    this.announce(text);
  }

  /** Show why the simulator rejected the playground; null clears it. @param {Node[] | null} reasons */
  refuse(reasons) {
    this.head.refuse(reasons);
  }

  /** The file of the mission that is being made; null if something is missing in it, which is shown. */
  packMission() {
    return this.head.packMission();
  }

  /** Say which solutions of the mission do not pass. @param {{ name: string, content: Uint8Array }} file */
  checkMission(file) {
    return this.head.checkMission(file);
  }

  /** Open a playground file that was dropped. @param {File} file @param {Place} place */
  open(file, place) {
    void this.head.open(file, place);
  }

  destroy() {
    this.pointer.destroy();
    this.removeKeys();
    this.scene.camera.controls.enabled = true;
    this.scene.canvas.setAttribute("aria-label", this.canvasLabel);
    for (const element of Object.values(this.elements)) element.remove();
  }
}
