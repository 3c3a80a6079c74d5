// The current playground: choose a shipped playground or open a file; a rejected one changes nothing.

import { disabledReason } from "../state/disabled_reason.js";
import { uploadCause } from "../state/index.js";
import { buttonOf, fileButton, h, lock, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { galleryDialog } from "./gallery.js";
import { faultText, faultView } from "./refusal.js";

/** @typedef {import("../state/index.js").PlaygroundInfo} PlaygroundInfo */

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function currentPanel(context) {
  const { text, language, actions, announce, creator, store, workspace } = context;
  const t = text("playground");
  const pageText = text("page");
  const change = async () => {
    const text = await actions.playgroundText();
    try {
      if (text !== null) await creator.openText(text);
    } catch (error) {
      store.dispatch({ type: "notice", level: "error", text: error instanceof Error ? error.message : String(error) });
    }
  };
  const gallery = galleryDialog(context);
  const select = h("select", { id: "playground-choice", class: "select", "aria-label": t("playground.choose") });
  select.addEventListener("change", () => actions.loadPlayground(select.value));
  const description = h("p", { class: "description" });
  const summary = h("summary");
  const notes = h("ul");
  const remarks = h("details", { class: "remarks", hidden: true }, summary, notes);
  const fault = h("div", { class: "fault", hidden: true });
  const pictures = h(
    "button",
    { type: "button", class: "btn line", id: "gallery-open", title: t("gallery.help"), onclick: gallery.open },
    icon("image"),
    t("gallery.open"),
  );
  const copy = h(
    "button",
    { type: "button", class: "btn you", id: "playground-change", "data-edit": "", title: t("playground.editHelp"), onclick: change },
    icon("pen"),
    t("playground.edit"),
  );
  const file = fileButton({
    id: "playground-file",
    label: t("playground.open"),
    help: t("playground.openHelp"),
    accept: ".json,.playground,.xml,.zip",
    open: (chosen) => actions.loadFile(chosen),
  });
  const build = h(
    "button",
    {
      type: "button",
      class: "btn line",
      "data-build": "",
      title: t("creator.help"),
      onclick: () => void creator.open(),
    },
    icon("blocks"),
    t("creator"),
  );
  const controls = [select, pictures, copy, buttonOf(file)];
  const element = h(
    "section",
    { class: "current browse", "aria-label": t("playground") },
    select,
    h("div", { class: "row" }, copy, build, pictures, file),
    description,
    remarks,
    fault,
    gallery.element,
  );
  let listed = "";
  let noted = "";
  /** @type {import("../state/index.js").Upload | null} */ let shown = null;
  /** @param {import("../state/index.js").Upload | null} playground */
  const showUpload = (playground) => {
    shown = playground;
    fault.hidden = playground?.phase !== "refused";
    if (playground?.phase !== "refused") return;
    const headline = t("playground.refused", { name: playground.name });
    const close = h(
      "button",
      {
        type: "button",
        class: "btn icon",
        "aria-label": pageText("notice.dismiss"),
        onclick: () => store.dispatch({ type: "forget", what: "playground" }),
      },
      icon("close"),
    );
    fault.replaceChildren(close, ...faultView(t, headline, playground.fault));
    const words = `${headline} ${faultText(t, playground.fault)}`;
    announce(words);
    if (creator.isOpen || workspace.tab === "playground") return; // they show it
    store.dispatch({ type: "notice", level: "error", text: words, cause: uploadCause("playground") });
  };

  return {
    slot: "playground",
    element,
    watch(state) {
      const { playground } = state.uploads;
      if (playground !== shown) showUpload(playground);
    },
    render(state) {
      const { playgrounds, simulator, uploads } = state;
      if (creator.isOpen) return;
      gallery.render(state);
      const reason = disabledReason(state, pageText);
      for (const control of controls) lock(control, reason);
      const { playground } = uploads;
      const own =
        simulator !== null && !playgrounds.some(({ name }) => name === simulator.playground) ? simulator : null;
      const list = JSON.stringify([playgrounds, own?.title]);
      if (list !== listed) {
        listed = list;
        select.replaceChildren(
          ...playgrounds.map((info) => h("option", { value: info.name }, translated(info, language).title)),
        );
        if (own !== null)
          select.prepend(h("option", { value: own.playground }, t("playground.own", { title: own.title })));
      }
      const current = simulator?.playground ?? "";
      if (document.activeElement !== select || playground?.phase !== "sending") select.value = current;
      const chosen = playgrounds.find(({ name }) => name === current);
      setText(description, chosen === undefined ? "" : translated(chosen, language).description);
      const notesJson = JSON.stringify(simulator?.notes ?? []);
      if (notesJson !== noted) {
        noted = notesJson;
        const texts = simulator?.notes ?? [];
        setText(summary, t("playground.warnings", { count: texts.length }));
        notes.replaceChildren(...texts.map((text) => h("li", {}, text)));
        remarks.hidden = texts.length === 0;
      }
    },
  };
}

/** Title and description in a language, else in English. @param {PlaygroundInfo} info @param {string} language */
function translated(info, language) {
  return info.translations[language] ?? info;
}
