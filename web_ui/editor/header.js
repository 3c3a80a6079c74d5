// The header: node, file name, saved and loaded state, and a draft to restore.

import { h } from "../ui/dom.js";
import { isInRobot, isUnsaved } from "./documents.js";

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {(kept: import("./file_store.js").StoredFile) => string} options.draftLabel   text about an unsaved draft
 * @param {import("./editor_session.js").EditorSession} options.session
 * @param {() => void} options.redraw
 */
export function header({ t, draftLabel, session, redraw }) {
  const { workspace } = session;
  const nodes = h("select", {
    class: "select",
    "aria-label": t("editor.nodes"),
    onchange: () => workspace.chooseNode(Number(nodes.value)),
  });
  const name = h("input", { class: "file-name input", "aria-label": t("editor.file"), spellcheck: "false" });
  name.addEventListener("change", () => {
    workspace.rename(name.value);
    redraw();
  });
  const unsaved = h(
    "span",
    { class: "unsaved", role: "img", "aria-label": t("editor.unsaved"), title: t("editor.unsaved") },
    "●",
  );
  const notLoaded = h("small", {}, t("editor.notLoaded"));
  const draft = h("div", { class: "draft", hidden: true });
  const element = h("div", { class: "editor-head" }, nodes, name, unsaved, notLoaded);

  let nodesShown = "";
  /** @param {import("./aesl.js").Aesl} file */
  const drawFile = (file) => {
    const document = workspace.current;
    const names = file.nodes.map((node) => `${node.name} ${node.id}`);
    nodes.hidden = names.length < 2;
    if (names.join() !== nodesShown) {
      nodesShown = names.join();
      nodes.replaceChildren(...names.map((each, index) => h("option", { value: index }, each)));
    }
    nodes.value = String(document.node);
    if (name !== name.ownerDocument.activeElement) name.value = document.name;
    unsaved.hidden = !isUnsaved(document);
    notLoaded.hidden = isInRobot(document);
  };

  /** @type {import("./file_store.js").StoredFile | null} */ let draftShown = null;
  const drawDraft = () => {
    const kept = workspace.draft;
    if (kept === draftShown) return;
    draftShown = kept;
    draft.hidden = kept === null;
    if (kept === null) return;
    /** @param {string} key @param {() => void} act */
    const button = (key, act) =>
      h("button", { type: "button", class: "btn line", "data-draft": key, onclick: () => (act(), redraw()) }, t(`editor.${key}`));
    draft.replaceChildren(
      h("span", {}, draftLabel(kept)),
      button("restore", () => workspace.restoreDraft()),
      button("discard", () => workspace.forgetDraft()),
    );
  };

  return {
    element,
    draft,
    /** @param {import("./aesl.js").Aesl} file */
    render(file) {
      drawFile(file);
      drawDraft();
    },
  };
}
