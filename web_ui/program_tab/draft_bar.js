// A text that was not saved at an earlier visit: restore or discard it.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {(kept: import("../editor/file_store.js").StoredFile) => string} options.draftLabel
 * @param {import("../editor/workspace.js").Workspace} options.workspace
 * @param {() => void} options.redraw
 */
export function draftBar({ t, draftLabel, workspace, redraw }) {
  const element = h("div", { class: "program-draft", hidden: true });
  /** @type {import("../editor/file_store.js").StoredFile | null} */ let shown = null;
  /** @param {string} key @param {string} look @param {() => void} act */
  const button = (key, look, act) =>
    h(
      "button",
      { type: "button", class: `btn note ${look}`, "data-draft": key, onclick: () => (act(), redraw()) },
      t(`editor.${key}`),
    );
  return {
    element,
    render() {
      const kept = workspace.draft;
      if (kept === shown) return;
      shown = kept;
      element.hidden = kept === null;
      if (kept === null) return;
      element.replaceChildren(
        icon("file", { small: true }),
        h("span", { class: "grow" }, draftLabel(kept)),
        button("restore", "line", () => workspace.restoreDraft()),
        button("discard", "", () => workspace.forgetDraft()),
      );
    },
  };
}
