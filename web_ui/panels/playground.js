// The playground: choose one of the shipped ones or open a file; a refused one leaves the old world.

import { card } from "./card.js";
import { fileButton, h, setText } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function playgroundPanel({ t, actions, announce }) {
  const select = h("select", { id: "playground-choice", "aria-label": t("playground.choose") });
  select.addEventListener("change", () => actions.loadPlayground(select.value));
  const description = h("p", { class: "description" });
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
        accept: ".json",
        open: (file) => actions.loadFile(file),
      }),
    ),
    description,
    fault,
  );
  let listed = "";
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
        select.replaceChildren(...playgrounds.map(({ name, title }) => h("option", { value: name }, title)));
        if (own !== null)
          select.prepend(h("option", { value: own.playground }, t("playground.own", { title: own.title })));
      }
      const current = simulator?.playground ?? "";
      if (document.activeElement !== select || playground?.phase !== "sending") select.value = current;
      setText(description, playgrounds.find(({ name }) => name === current)?.description ?? "");
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
