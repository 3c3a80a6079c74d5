// The playground panel: choose a shipped playground or open a file; a rejected one changes nothing.

import { galleryDialog } from "../gallery/index.js";
import { disabledReason } from "../state/disabled_reason.js";
import { card, showRefusal } from "./card.js";
import { buttonOf, fileButton, h, icon, ICONS, lock, setText } from "./dom.js";
import { faultText, faultView } from "./fault.js";

const PENCIL = "M3 17.500V21h3.500L17 10.500 13.500 7zM15 5.500 18.500 9l2-2L17 3.500z";
const PICTURES = "M4 4h7v7H4zM13 4h7v7h-7zM4 13h7v7H4zM13 13h7v7h-7z";

/** @typedef {import("../state/index.js").PlaygroundInfo} PlaygroundInfo */

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function playgroundPanel(context) {
  const { t, language, actions, announce, creator, store } = context;
  const change = async () => {
    const text = await actions.playgroundText();
    try {
      if (text !== null) await creator.openText(text);
    } catch (error) {
      store.dispatch({ type: "notice", level: "error", text: error instanceof Error ? error.message : String(error) });
    }
  };
  const gallery = galleryDialog(context);
  const select = h("select", { id: "playground-choice", "aria-label": t("playground.choose") });
  select.addEventListener("change", () => actions.loadPlayground(select.value));
  const description = h("p", { class: "description" });
  const summary = h("summary");
  const notes = h("ul");
  const remarks = h("details", { class: "remarks", hidden: true }, summary, notes);
  const fault = h("div", { class: "fault", hidden: true });
  const pictures = h(
    "button",
    { type: "button", id: "gallery-open", title: t("gallery.help"), onclick: gallery.open },
    icon(PICTURES),
    t("gallery.open"),
  );
  const copy = h(
    "button",
    { type: "button", id: "playground-change", title: t("playground.editHelp"), onclick: change },
    icon(PENCIL),
    t("playground.edit"),
  );
  const file = fileButton({
    id: "playground-file",
    label: t("playground.open"),
    help: t("playground.openHelp"),
    accept: ".json,.playground,.xml,.zip",
    open: (chosen) => actions.loadFile(chosen),
  });
  const controls = [select, pictures, copy, buttonOf(file)];
  const element = card(
    "playground",
    t("playground"),
    h("div", { class: "row" }, select),
    h(
      "div",
      { class: "row" },
      pictures,
      copy,
      file,
    ),
    description,
    remarks,
    fault,
    gallery.element,
  );
  let listed = "";
  let noted = "";
  /** @type {import("../state/index.js").Upload | null} */ let shown = null;
  return {
    slot: "side",
    element,
    render(state) {
      const { playgrounds, simulator, uploads } = state;
      gallery.render(state);
      const reason = disabledReason(state, t);
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
      if (playground === shown) return;
      shown = playground;
      fault.hidden = playground?.phase !== "refused";
      if (playground?.phase !== "refused") return;
      const headline = t("playground.refused", { name: playground.name });
      const close = h(
        "button",
        {
          type: "button",
          class: "plain",
          "aria-label": t("notice.dismiss"),
          onclick: () => store.dispatch({ type: "forget", what: "playground" }),
        },
        icon(ICONS.close),
      );
      fault.replaceChildren(close, ...faultView(t, headline, playground.fault));
      const words = `${headline} ${faultText(t, playground.fault)}`;
      announce(words);
      if (!creator.isOpen) showRefusal(element, store, words, "playground"); // it shows its own errors
    },
  };
}

/** Title and description in a language, else in English. @param {PlaygroundInfo} info @param {string} language */
function translated(info, language) {
  return info.translations[language] ?? info;
}
