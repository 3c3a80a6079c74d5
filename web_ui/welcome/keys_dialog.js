// All keys of the page, in a dialog.

import { translator } from "../i18n/index.js";
import keyTexts from "../i18n/keys.texts.js";
import { KEY_TABLE, keyLabel } from "../input/key_table.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @param {string} language */
export function openKeys(language) {
  const keysText = translator(language, keyTexts);
  /** @param {string} key */
  const cap = (key) => h("kbd", { class: "kbd" }, keyLabel(key, keysText));
  /** @param {import("../input/key_table.js").KeyRow} row */
  const rowOf = ({ held = [], keys, text }) =>
    h("div", {}, h("dt", {}, ...[...held, ...keys].map(cap)), h("dd", {}, keysText(text)));
  const dialog = h(
    "dialog",
    { class: "dialog welcome-keys", "aria-labelledby": "keys-title" },
    h(
      "div",
      { class: "welcome-head" },
      h("h2", { id: "keys-title" }, keysText("title")),
      h(
        "button",
        { type: "button", class: "btn icon", title: keysText("close"), "aria-label": keysText("close"), onclick: () => dialog.close() },
        icon("close"),
      ),
    ),
    h(
      "div",
      { class: "welcome-keys-groups", tabindex: "0" },
      ...KEY_TABLE.map(({ name, note, rows }) =>
        h(
          "section",
          {},
          h("h3", {}, keysText(name)),
          ...(note === undefined ? [] : [h("p", { class: "small muted" }, keysText(note))]),
          h("dl", {}, ...rows.map(rowOf)),
        ),
      ),
    ),
  );
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close(); // beside it
  });
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
