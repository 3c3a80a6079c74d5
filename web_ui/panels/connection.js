// The connection state: a word in the header, and an explanation over the view while there is no connection.

import { h, setAttribute, setText } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function connectionPanel({ t, address, announce }) {
  const word = h("span", {});
  const chip = h("div", { class: "chip" }, h("span", { class: "lamp", "aria-hidden": "true" }), word);
  const badge = h("div", { class: "chip", id: "read-only", title: t("access.readOnlyHelp"), hidden: true }, t("access.readOnly"));
  const element = h("div", { class: "access" }, chip, badge);
  const sentence = h("div", { class: "banner", hidden: true });
  document.querySelector(".stage")?.append(sentence);
  let previous = "";
  return {
    slot: "header",
    element,
    render({ connection, readOnly }) {
      const watches = readOnly && connection === "connected";
      if (watches && badge.hidden) announce(t("access.readOnlyHelp"));
      badge.hidden = !watches;
      if (connection === previous) return;
      setText(word, t(`connection.${connection}`));
      setAttribute(chip, "data-state", connection);
      const text = connection === "connected" ? "" : t(`connection.${connection}Long`, { address });
      setText(sentence, text);
      sentence.hidden = text === "";
      announce(connection === "connected" ? t("connection.back") : text);
      previous = connection;
    },
  };
}
