// The button that opens and closes the Aseba editor.

import { h, icon, setAttribute } from "./dom.js";

const CODE = "M8.500 6.500 3 12l5.500 5.500 1.500-1.500L6 12l4-4zM15.500 6.500 14 8l4 4-4 4 1.500 1.500L21 12z";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function editorSwitchPanel({ t, editor }) {
  const element = h(
    "button",
    {
      type: "button",
      id: "editor-switch",
      title: t("editor.help"),
      onclick: () => (editor.isOpen ? editor.close() : editor.open()),
    },
    icon(CODE),
    h("span", {}, t("editor")),
  );
  return { slot: "header", element, render: () => setAttribute(element, "aria-pressed", String(editor.isOpen)) };
}
