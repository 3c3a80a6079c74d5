// The current playground: what it is, a copy to edit, a new one, one from a file; and why a file was rejected.

import { disabledReason } from "../state/disabled_reason.js";
import { uploadCause } from "../state/index.js";
import { buttonOf, fileButton, h, lock, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { translated } from "./gallery.js";
import { RefusalBox } from "./refusal_box.js";

/** @typedef {import("../state/index.js").Upload} Upload */

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function currentPanel(context) {
  const { text, language, actions, creator, opened, scene, store, thumbnails } = context;
  const t = text("playground");
  const pageText = text("page");
  const box = new RefusalBox(context);
  const picture = h("img", { alt: "", width: 240, height: 160, hidden: true });
  const title = h("h2");
  const description = h("p", { class: "description" });
  const summary = h("summary");
  const notes = h("ul");
  const remarks = h("details", { class: "remarks", hidden: true }, summary, notes);
  const edit = async () => {
    const content = await actions.playgroundText();
    if (content === null) return;
    box.hide();
    const fault = await creator.openText(content);
    if (fault !== null) await box.showFault(t("refused.edit"), fault, content);
  };
  const copy = h(
    "button",
    {
      type: "button",
      class: "btn you",
      id: "playground-change",
      "data-edit": "",
      title: t("edit.help"),
      onclick: () => void edit(),
    },
    icon("pen"),
    t("edit"),
  );
  const file = fileButton({
    id: "playground-file",
    label: t("open"),
    help: t("open.help"),
    accept: ".json,.playground,.xml,.zip",
    open: (chosen) => {
      opened.note(chosen);
      box.hide();
      void actions.loadFile(chosen);
    },
  });
  const build = h(
    "button",
    { type: "button", class: "btn line", "data-new": "", title: t("new.help"), onclick: () => void creator.openNew() },
    icon("blocks"),
    t("new"),
  );
  const choices = h("div", { class: "row" }, copy, build, file);
  const element = h(
    "section",
    { class: "current browse", "aria-label": t("current") },
    h("p", { class: "cap" }, t("current")),
    h("div", { class: "current-head" }, h("span", { class: "frame" }, icon("playground"), picture), h("div", {}, title, description)),
    remarks,
    choices,
    box.element,
  );
  let drawn = "";
  let noted = "";
  /** @type {Upload | null} */ let shown = null;

  /** Show the thumbnail of a shipped playground. @param {string} name  empty: it is none of them */
  const draw = async (name) => {
    drawn = name;
    const sample = name === "" ? null : await thumbnails.sample(name);
    if (drawn !== name) return; // another one was loaded meanwhile
    picture.hidden = sample === null;
    if (sample !== null) picture.src = sample.picture;
    scene.invalidate();
  };
  /** @param {Upload | null} upload */
  const showUpload = (upload) => {
    shown = upload;
    if (upload?.phase === "refused") void box.showUpload(upload);
    else box.hide();
    if (upload?.phase === "accepted") opened.forget();
  };
  box.closed = () => {
    store.dispatch({ type: "forget", what: "playground" });
    store.dispatch({ type: "solved", cause: uploadCause("playground") });
  };

  return {
    slot: "playground",
    element,
    watch(state) {
      const { playground } = state.uploads;
      if (playground !== shown) showUpload(playground);
    },
    render(state) {
      if (creator.isOpen) return;
      const { playgrounds, simulator } = state;
      const reason = disabledReason(state, pageText);
      for (const control of [copy, buttonOf(file)]) lock(control, reason);
      const shipped = playgrounds.find(({ name }) => name === simulator?.playground);
      const isReal = state.robots[state.selected]?.isReal ?? false;
      choices.hidden = isReal;
      const titles = shipped === undefined ? null : translated(shipped, language);
      setText(title, titles?.title ?? simulator?.title ?? "");
      setText(description, titles?.description ?? (isReal ? t("current.real") : simulator === null ? "" : t("current.file")));
      if ((shipped?.name ?? "") !== drawn) void draw(shipped?.name ?? "");
      const texts = simulator?.notes ?? [];
      const notesJson = JSON.stringify(texts);
      if (notesJson === noted) return;
      noted = notesJson;
      setText(summary, t("warnings", { count: texts.length }));
      notes.replaceChildren(...texts.map((note) => h("li", { lang: "en" }, note)));
      remarks.hidden = texts.length === 0;
    },
  };
}
