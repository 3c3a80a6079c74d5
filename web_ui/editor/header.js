// The header: robot tabs, node, file name, saved and loaded state, and a draft to restore.

import { h, icon, ICONS, setAttribute } from "../panels/dom.js";
import { isInRobot, isUnsaved } from "./documents.js";
import { ALL } from "./workspace.js";

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {(kept: import("./file_store.js").StoredFile) => string} options.draftLabel   text about an unsaved draft
 * @param {import("./editor_session.js").EditorSession} options.session
 * @param {(robot: string) => void} options.select   called when the tab of a robot is chosen
 * @param {() => void} options.redraw
 * @param {() => void} options.close
 */
export function header({ t, draftLabel, session, select, redraw, close }) {
  const { workspace } = session;
  const tabs = h("div", { class: "tabs", role: "tablist", "aria-label": t("editor.robots") });
  const nodes = h("select", {
    "aria-label": t("editor.nodes"),
    onchange: () => workspace.chooseNode(Number(nodes.value)),
  });
  const name = h("input", { class: "file-name", "aria-label": t("editor.file"), spellcheck: "false" });
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
  const element = h(
    "div",
    { class: "editor-head" },
    tabs,
    nodes,
    name,
    unsaved,
    notLoaded,
    h(
      "button",
      {
        type: "button",
        class: "plain close",
        "aria-label": t("editor.close"),
        title: t("editor.close"),
        onclick: close,
      },
      icon(ICONS.close),
    ),
  );

  let tabsShown = "";
  /** @param {string[]} wanted */
  const drawTabs = (wanted) => {
    if (wanted.join() !== tabsShown) {
      tabsShown = wanted.join();
      tabs.hidden = wanted.length < 2;
      tabs.replaceChildren(
        ...wanted.map((tab) =>
          h(
            "button",
            {
              type: "button",
              role: "tab",
              "data-tab": tab,
              onclick() {
                workspace.choose(tab);
                if (tab !== ALL) select(tab);
                redraw();
              },
            },
            tab === ALL ? t("editor.all") : tab,
          ),
        ),
      );
    }
    for (const tab of tabs.children)
      setAttribute(tab, "aria-selected", String(tab.getAttribute("data-tab") === workspace.tab));
  };

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
      h("button", { type: "button", "data-draft": key, onclick: () => (act(), redraw()) }, t(`editor.${key}`));
    draft.replaceChildren(
      h("span", {}, draftLabel(kept)),
      button("restore", () => workspace.restoreDraft()),
      button("discard", () => workspace.forgetDraft()),
    );
  };

  return {
    element,
    draft,
    /** @param {string[]} wanted  the tabs to show @param {import("./aesl.js").Aesl} file */
    render(wanted, file) {
      drawTabs(wanted);
      drawFile(file);
      drawDraft();
    },
  };
}
