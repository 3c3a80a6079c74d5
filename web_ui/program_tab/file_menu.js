// The file of the program: its name, new, open, save, load, and what the language adds. A sheet beside its button.

import { isPython } from "../browser/python_name.js";
import { WHOLE } from "../editor/toolbox_file.js";
import { buttonOf, fileButton, h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";

/** Files of programs and of what languages import, as a file dialog offers them. @param {import("./commands.js").ProgramCommands} commands */
export const acceptedFiles = ({ imports }) => [".aesl", ".aseba", ".txt", ".json", ".py", ...imports].join();

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../editor/workspace.js").Workspace} Workspace */

/**
 * @param {object} options
 * @param {Translate} options.t
 * @param {import("../editor/editor_session.js").EditorSession} options.session
 * @param {import("./commands.js").ProgramCommands} options.commands
 * @param {import("../hosts/share_host.js").ShareHost} options.share
 * @param {() => void} options.redraw
 */
export function fileMenu({ t, session, commands, share, redraw }) {
  const { workspace } = session;
  const sheet = h("div", { id: "file-sheet", class: "program-sheet", role: "group", "aria-label": t("file") });
  const close = () => sheet.hidePopover();
  const button = menuButton(t);
  const name = nameField(workspace, redraw, close);
  const nodes = nodeChoice(t, workspace);
  const open = fileButton({
    id: "editor-file",
    label: t("file.open"),
    help: t("file.open"),
    accept: acceptedFiles(commands),
    open: (file) => void commands.open(file),
    look: "btn",
  });
  buttonOf(open).addEventListener("click", close);
  /**
   * @param {string} verb
   * @param {import("../ui/icons.js").IconName} sign
   * @param {string} text   key of its text
   * @param {() => void} act
   * @param {string} [key]  of the keyboard
   */
  const entry = (verb, sign, text, act, key = "") =>
    h(
      "button",
      { type: "button", class: "btn", "data-verb": verb, onclick: () => (close(), act()) },
      icon(sign, { small: true }),
      h("span", { class: "grow" }, t(text)),
      ...(key === "" ? [] : [h("kbd", { class: "kbd" }, key)]),
    );
  const load = entry("load", "give", "file.load", () => void commands.put());
  const allBlocks = entry("all-blocks", "blocks", "toolbox.showAll", () => commands.showAllBlocks());
  const own = h("div", { class: "program-entries" });
  sheet.append(
    h("label", { class: "field" }, h("span", { class: "small muted" }, t("file.name")), name.element),
    nodes.element,
    entry("new", "file", "file.new", () => commands.newFile()),
    open,
    entry("save", "save", "file.save", () => commands.save(), "Ctrl+S"),
    load,
    entry("share", "share", "file.share", () => void share.shareProgram(workspace.current.name, workspace.current.text)),
    entry("open-link", "link", "file.link", () => void share.openField()),
    entry("examples", "list", "file.examples", () => commands.newFile()),
    allBlocks,
    own,
  );
  makeSheet(button.element, sheet);
  return {
    element: h("span", { class: "menu program-file" }, button.element, sheet),
    /** Show what the language adds. @param {readonly HTMLElement[]} entries */
    setEntries(entries) {
      own.replaceChildren(...entries);
    },
    /** @param {{ reason: string, isUnsaved: boolean, hasMistake: boolean }} facts */
    render({ reason, isUnsaved, hasMistake }) {
      button.render(workspace.current.name, isUnsaved);
      allBlocks.hidden = session.toolbox === WHOLE;
      load.hidden = isPython(workspace.current.name); // nodes are in no robot
      lock(load, reason || (hasMistake ? t("editor.runBlocked") : ""));
      name.render();
      nodes.render();
    },
  };
}

/** The button with the name of the file. @param {Translate} t */
function menuButton(t) {
  const name = h("span", { class: "name" });
  const label = t("file.unsaved");
  const unsaved = h("i", { class: "program-unsaved", role: "img", "aria-label": label, title: label });
  const element = h(
    "button",
    { type: "button", class: "select quiet", id: "file-menu" },
    icon("file", { small: true }),
    name,
    unsaved,
    icon("caretDown", { small: true }),
  );
  return {
    element,
    /** @param {string} current @param {boolean} isUnsaved */
    render(current, isUnsaved) {
      setText(name, current);
      setAttribute(element, "aria-label", `${t("file")}: ${current}`);
      unsaved.hidden = !isUnsaved;
    },
  };
}

/** @param {Workspace} workspace @param {() => void} redraw @param {() => void} close */
function nameField(workspace, redraw, close) {
  const element = h("input", { class: "file-name input", spellcheck: "false", autocomplete: "off" });
  element.addEventListener("change", () => {
    workspace.rename(element.value);
    redraw();
  });
  element.addEventListener("keydown", ({ key }) => key === "Enter" && close());
  return {
    element,
    render() {
      const { name } = workspace.current;
      if (element !== document.activeElement && element.value !== name) element.value = name;
    },
  };
}

/** The node of the file that is shown, where there are several. @param {Translate} t @param {Workspace} workspace */
function nodeChoice(t, workspace) {
  const element = h("select", {
    class: "select",
    "aria-label": t("editor.nodes"),
    onchange: () => workspace.chooseNode(Number(element.value)),
  });
  let shown = "";
  return {
    element,
    render() {
      const { current, file } = workspace;
      const names = file.nodes.map((node) => `${node.name} ${node.id}`);
      element.hidden = names.length < 2;
      if (names.join() !== shown) {
        shown = names.join();
        element.replaceChildren(...names.map((each, index) => h("option", { value: index }, each)));
      }
      if (element.value !== String(current.node)) element.value = String(current.node);
    },
  };
}
