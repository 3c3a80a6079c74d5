// The connection state: a word in the header, and an explanation over the view while there is no connection.

import { h, setAttribute, setText } from "../ui/dom.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function connectionPanel({ text, address, announce }) {
  const t = text("page");
  const word = h("span", { class: "word" });
  const chip = h("span", { class: "chip", id: "connection" }, h("span", { class: "lamp", "aria-hidden": "true" }), word);
  const badge = h(
    "span",
    { class: "chip wait", id: "read-only", title: t("access.readOnlyHelp"), hidden: true },
    t("access.readOnly"),
  );
  const element = h("div", { class: "access row grow" }, chip, badge);
  let previous = "";
  return {
    slot: "header",
    element,
    render({ connection, readOnly }) {
      const watches = readOnly && connection === "connected";
      if (watches && badge.hidden) announce(t("access.readOnlyHelp"));
      badge.hidden = !watches;
      if (connection === previous) return;
      previous = connection;
      setText(word, t(`connection.${connection}`));
      setAttribute(chip, "data-state", connection);
      announce(connection === "connected" ? t("connection.back") : t(`connection.${connection}Long`, { address }));
    },
  };
}
