// The playground: choose one of the shipped ones or open a file; a refused one leaves the old world.

import { card } from "./card.js";
import { fileButton, h, setText } from "./dom.js";

/** @typedef {import("../state/index.js").PlaygroundInfo} PlaygroundInfo */

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function playgroundPanel({ t, language, actions, announce }) {
  const select = h("select", { id: "playground-choice", "aria-label": t("playground.choose") });
  select.addEventListener("change", () => actions.loadPlayground(select.value));
  const description = h("p", { class: "description" });
  const summary = h("summary");
  const notes = h("ul");
  const remarks = h("details", { class: "remarks", hidden: true }, summary, notes);
  const fault = h("p", { class: "fault", hidden: true });
  const element = card(
    "playground",
    t("playground"),
    h(
      "div",
      { class: "row" },
      select,
      fileButton({
        id: "playground-file",
        label: t("playground.open"),
        help: t("playground.openHelp"),
        accept: ".json,.playground,.xml,.zip",
        open: (file) => actions.loadFile(file),
      }),
    ),
    description,
    remarks,
    fault,
  );
  let listed = "";
  let noted = "";
  /** @type {import("../state/index.js").Upload | null} */ let shown = null;
  return {
    slot: "side",
    element,
    render({ playgrounds, simulator, uploads }) {
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
      const told = JSON.stringify(simulator?.notes ?? []);
      if (told !== noted) {
        noted = told;
        const texts = simulator?.notes ?? [];
        setText(summary, t("playground.remarks", { count: texts.length }));
        notes.replaceChildren(...texts.map((text) => h("li", {}, text)));
        remarks.hidden = texts.length === 0;
      }
      if (playground === shown) return;
      shown = playground;
      const text =
        playground?.phase === "refused"
          ? `${t("playground.refused", { name: playground.name })} ${playground.fault?.text ?? ""}`
          : "";
      setText(fault, text);
      fault.hidden = text === "";
      if (text !== "") announce(text);
    },
  };
}

/** Title and description in a language, else in English. @param {PlaygroundInfo} info @param {string} language */
function translated(info, language) {
  return info.translations[language] ?? info;
}
