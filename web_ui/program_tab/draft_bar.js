// A text that was not saved at an earlier visit: restore it, or discard it, which can be undone.

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
  let wasDiscarded = false;
  /** @param {string} key @param {string} look @param {() => void} act @param {string} [label] */
  const button = (key, look, act, label = t(`editor.${key}`)) =>
    h("button", { type: "button", class: `btn note ${look}`, "data-draft": key, onclick: () => (act(), redraw()) }, label);
  /** @param {import("../editor/file_store.js").StoredFile} kept */
  const offer = (kept) => [
    h("span", { class: "grow" }, draftLabel(kept)),
    button("restore", "line", () => workspace.restoreDraft()),
    button("discard", "", () => workspace.forgetDraft()),
  ];
  /** @param {import("../editor/file_store.js").StoredFile} kept */
  const wayBack = ({ name }) => [
    h("span", { class: "grow", role: "status" }, t("editor.discarded", { name })),
    button("undo", "line", () => workspace.undoForget(), t("detach.undo")),
    button("done", "", () => workspace.settleForget(), t("detach.done")),
  ];
  return {
    element,
    render() {
      const discarded = workspace.discarded.get(workspace.tab);
      const kept = workspace.draft ?? discarded ?? null;
      const isDiscarded = kept !== null && kept === discarded;
      if (kept === shown && isDiscarded === wasDiscarded) return;
      [shown, wasDiscarded] = [kept, isDiscarded];
      element.hidden = kept === null;
      if (kept === null) return;
      const hadFocus = element.contains(document.activeElement);
      element.replaceChildren(icon("file", { small: true }), ...(isDiscarded ? wayBack(kept) : offer(kept)));
      if (hadFocus) element.querySelector("button")?.focus();
    },
  };
}
