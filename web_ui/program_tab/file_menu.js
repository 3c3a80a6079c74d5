// The file of the program: its name, new, open, save, load, and what the language adds. A sheet beside its button.

import { WHOLE } from "../editor/toolbox_file.js";
import { buttonOf, fileButton, h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";

/** Files of programs and of what languages import, as a file dialog offers them. @param {import("./commands.js").ProgramCommands} commands */
export const acceptedFiles = ({ imports }) => [".aesl", ".aseba", ".txt", ".json", ...imports].join();

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {import("../editor/editor_session.js").EditorSession} options.session
 * @param {import("./commands.js").ProgramCommands} options.commands
 * @param {() => void} options.redraw
 */
export function fileMenu({ t, session, commands, redraw }) {
  const { workspace } = session;
  const shownName = h("span", { class: "name" });
  const unsaved = h("i", {
    class: "program-unsaved",
    role: "img",
    "aria-label": t("file.unsaved"),
    title: t("file.unsaved"),
  });
  const button = h(
    "button",
    { type: "button", class: "select quiet", id: "file-menu" },
    icon("file", { small: true }),
    shownName,
    unsaved,
    icon("caretDown", { small: true }),
  );
  const sheet = h("div", { id: "file-sheet", class: "program-sheet", role: "group", "aria-label": t("file") });
  const close = () => sheet.hidePopover();

  /**
   * @param {string} name @param {import("../ui/icons.js").IconName} sign @param {string} text @param {string} key
   * @param {() => void} act
   */
  const entry = (name, sign, text, key, act) =>
    h(
      "button",
      { type: "button", class: "btn", "data-verb": name, onclick: () => (close(), act()) },
      icon(sign, { small: true }),
      h("span", { class: "grow" }, t(text)),
      ...(key === "" ? [] : [h("kbd", { class: "kbd" }, key)]),
    );
  const name = h("input", { class: "file-name input", spellcheck: "false", autocomplete: "off" });
  name.addEventListener("change", () => {
    workspace.rename(name.value);
    redraw();
  });
  name.addEventListener("keydown", ({ key }) => key === "Enter" && close());
  const nodes = h("select", {
    class: "select",
    "aria-label": t("editor.nodes"),
    onchange: () => workspace.chooseNode(Number(nodes.value)),
  });
  const open = fileButton({
    id: "editor-file",
    label: t("file.open"),
    help: t("file.open"),
    accept: acceptedFiles(commands),
    open: (file) => void commands.open(file),
    look: "btn",
  });
  buttonOf(open).addEventListener("click", close);
  const load = entry("load", "give", "file.load", "", () => void commands.put());
  const allBlocks = entry("all-blocks", "blocks", "toolbox.showAll", "", () => commands.showAllBlocks());
  const own = h("div", { class: "program-entries" });
  sheet.append(
    h("label", { class: "field" }, h("span", { class: "small muted" }, t("file.name")), name),
    nodes,
    entry("new", "file", "file.new", "", () => commands.newFile()),
    open,
    entry("save", "save", "file.save", "Ctrl+S", () => commands.save()),
    load,
    entry("examples", "list", "file.examples", "", () => commands.newFile()),
    allBlocks,
    own,
  );
  makeSheet(button, sheet);

  let nodesShown = "";
  return {
    element: h("span", { class: "menu program-file" }, button, sheet),
    /** Show what the language adds. @param {readonly HTMLElement[]} entries */
    setEntries(entries) {
      own.replaceChildren(...entries);
    },
    /** @param {{ reason: string, isUnsaved: boolean, hasMistake: boolean }} facts */
    render({ reason, isUnsaved, hasMistake }) {
      const { current, file } = workspace;
      setText(shownName, current.name);
      setAttribute(button, "aria-label", `${t("file")}: ${current.name}`);
      unsaved.hidden = !isUnsaved;
      allBlocks.hidden = session.toolbox === WHOLE;
      lock(load, reason || (hasMistake ? t("editor.runBlocked") : ""));
      if (name !== document.activeElement && name.value !== current.name) name.value = current.name;
      const names = file.nodes.map((node) => `${node.name} ${node.id}`);
      nodes.hidden = names.length < 2;
      if (names.join() !== nodesShown) {
        nodesShown = names.join();
        nodes.replaceChildren(...names.map((each, index) => h("option", { value: index }, each)));
      }
      if (nodes.value !== String(current.node)) nodes.value = String(current.node);
    },
  };
}
