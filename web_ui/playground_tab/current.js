// The current playground: what it is, a copy to edit, a new one, one from a file; and why a file was rejected.

import { fileNameOf } from "../playground/document.js";
import { disabledReason } from "../state/disabled_reason.js";
import { uploadCause } from "../state/index.js";
import { buttonOf, fileButton, h, lock, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { translated } from "./gallery.js";
import { RefusalBox } from "./refusal_box.js";

/** @typedef {import("../state/index.js").Upload} Upload */

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../shell/context.js").Panel} Panel */
/** @typedef {import("../state/index.js").State} State */

/** @implements {Panel} */
class CurrentPanel {
  slot = /** @type {const} */ ("playground");
  /** @type {Upload | null} the last upload, as it is shown */ #shown = null;

  /** @param {Context} context */
  constructor(context) {
    const { text, opened, actions, store } = context;
    const t = text("playground");
    this.context = context;
    this.t = t;
    this.box = new RefusalBox(context);
    this.box.closed = () => {
      store.dispatch({ type: "forget", what: "playground" });
      store.dispatch({ type: "solved", cause: uploadCause("playground") });
    };
    this.headline = headline(context);
    this.remarks = remarks(t);
    this.copy = this.#copyButton();
    this.file = fileButton({
      id: "playground-file",
      label: t("open"),
      help: t("open.help"),
      accept: ".json,.playground,.xml,.zip",
      open: (chosen) => {
        opened.note(chosen);
        this.box.hide();
        void actions.loadFile(chosen);
      },
    });
    this.choices = h("div", { class: "row" }, this.copy, this.#newButton(), this.file, this.#shareButton());
    this.element = h(
      "section",
      { class: "current browse", "aria-label": t("current") },
      h("p", { class: "cap" }, t("current")),
      this.headline.element,
      this.remarks.element,
      this.choices,
      this.box.element,
    );
  }

  /** @param {State} state */
  watch({ uploads }) {
    const upload = uploads.playground;
    if (upload === this.#shown) return;
    this.#shown = upload;
    if (upload?.phase === "refused") void this.box.showUpload(upload);
    else this.box.hide();
    if (upload?.phase === "accepted") this.context.opened.forget();
  }

  /** @param {State} state */
  render(state) {
    const { creator, text } = this.context;
    if (creator.isOpen) return;
    const reason = disabledReason(state, text("page"));
    for (const control of [this.copy, buttonOf(this.file)]) lock(control, reason);
    this.choices.hidden = state.robots[state.selected]?.isReal ?? false;
    this.headline.render(state);
    this.remarks.render(state.simulator?.notes ?? []);
  }

  #copyButton() {
    const { t } = this;
    return h(
      "button",
      {
        type: "button",
        class: "btn you",
        id: "playground-change",
        "data-edit": "",
        title: t("edit.help"),
        onclick: () => void this.#edit(),
      },
      icon("pen"),
      t("edit"),
    );
  }

  #newButton() {
    const { t } = this;
    const { creator } = this.context;
    const act = () => void creator.openNew();
    return h(
      "button",
      { type: "button", class: "btn line", "data-new": "", title: t("new.help"), onclick: act },
      icon("blocks"),
      t("new"),
    );
  }

  #shareButton() {
    const { t } = this;
    const { store, actions, share } = this.context;
    const act = async () => {
      const content = await actions.playgroundText();
      if (content !== null) await share.sharePlayground(fileNameOf(store.state.simulator?.title ?? ""), content);
    };
    return h(
      "button",
      { type: "button", class: "btn line", "data-share": "playground", title: t("share.help"), onclick: () => void act() },
      icon("share"),
      t("share"),
    );
  }

  /** Open a copy in the creator. */
  async #edit() {
    const { actions, creator } = this.context;
    const content = await actions.playgroundText();
    if (content === null) return;
    this.box.hide();
    const fault = await creator.openText(content);
    if (fault !== null) await this.box.showFault(this.t("refused.edit"), fault, content);
  }
}

/** @param {Context} context @returns {Panel} */
export function currentPanel(context) {
  return new CurrentPanel(context);
}

/** Picture, title and description. @param {Context} context */
function headline({ text, language, scene, thumbnails }) {
  const t = text("playground");
  const picture = h("img", { alt: "", width: 240, height: 160, hidden: true });
  const title = h("h2");
  const description = h("p", { class: "description" });
  const frame = h("span", { class: "frame" }, icon("playground"), picture);
  let drawn = "";

  /** Show the thumbnail of a shipped playground. @param {string} name  empty: it is none of them */
  const draw = async (name) => {
    drawn = name;
    const sample = name === "" ? null : await thumbnails.sample(name);
    if (drawn !== name) return; // another one was loaded meanwhile
    picture.hidden = sample === null;
    if (sample !== null) picture.src = sample.picture;
    scene.invalidate();
  };
  return {
    element: h("div", { class: "current-head" }, frame, h("div", {}, title, description)),
    /** @param {State} state */
    render({ playgrounds, simulator, robots, selected }) {
      const shipped = playgrounds.find(({ name }) => name === simulator?.playground);
      const titles = shipped === undefined ? null : translated(shipped, language);
      const isReal = robots[selected]?.isReal ?? false;
      setText(title, titles?.title ?? simulator?.title ?? "");
      const about = isReal ? t("current.real") : simulator === null ? "" : t("current.file");
      setText(description, titles?.description ?? about);
      const name = shipped?.name ?? "";
      if (name !== drawn) void draw(name);
    },
  };
}

/** What the simulator remarks on the file. @param {import("../i18n/index.js").Translate} t */
function remarks(t) {
  const summary = h("summary");
  const list = h("ul");
  const element = h("details", { class: "remarks", hidden: true }, summary, list);
  let shown = "";
  return {
    element,
    /** @param {readonly string[]} notes */
    render(notes) {
      const now = JSON.stringify(notes);
      if (now === shown) return;
      shown = now;
      setText(summary, t("warnings", { count: notes.length }));
      list.replaceChildren(...notes.map((note) => h("li", { lang: "en" }, note)));
      element.hidden = notes.length === 0;
    },
  };
}
