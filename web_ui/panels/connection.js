// Whether the simulator is there: a word in the header, and a sentence over the view when it is not.

import { h, setAttribute, setText } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function connectionPanel({ t, address, announce }) {
  const word = h("span", {});
  const element = h("div", { class: "chip" }, h("span", { class: "lamp", "aria-hidden": "true" }), word);
  const sentence = h("div", { class: "banner", hidden: true });
  document.querySelector(".stage")?.append(sentence);
  let was = "";
  return {
    slot: "header",
    element,
    render({ connection }) {
      if (connection === was) return;
      setText(word, t(`connection.${connection}`));
      setAttribute(element, "data-state", connection);
      const text = connection === "connected" ? "" : t(`connection.${connection}Long`, { address });
      setText(sentence, text);
      sentence.hidden = text === "";
      announce(connection === "connected" ? t("connection.back") : text);
      was = connection;
    },
  };
}
