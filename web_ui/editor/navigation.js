// Rename a name everywhere, go to where it is defined, choose from the outline: by key, menu, and Ctrl-click.

import { ensureSyntaxTree, syntaxTree } from "@codemirror/language";
import { EditorSelection } from "@codemirror/state";
import { EditorView, keymap, showDialog } from "@codemirror/view";

import { h } from "../ui/dom.js";
import { definitionOf, nameAt, names, samePlaces, whyNotRename } from "./names.js";
import { outline } from "./outline.js";

/** @typedef {import("./names.js").Place} Place */
/** @typedef {import("@codemirror/state").EditorState} EditorState */

/** Most of a program has been parsed within this time; the rest counts as text without names. */
const PARSE_MS = 500;

/** The word before each kind of definition in the outline. */
const WORDS = { variable: "var", constant: "const", subroutine: "sub", event: "onevent" };

/** @param {EditorState} state */
function treeOf(state) {
  return ensureSyntaxTree(state, state.doc.length, PARSE_MS) ?? syntaxTree(state);
}

/** @param {EditorState} state @returns {Place[]} */
function placesIn(state) {
  return names(treeOf(state), (from, to) => state.sliceDoc(from, to));
}

/** @param {EditorView} view @param {number} from @param {number} [to] */
function select(view, from, to = from) {
  const effects = EditorView.scrollIntoView(from, { y: "center" });
  view.dispatch({ selection: EditorSelection.single(from, to), effects, userEvent: "select" });
  view.focus();
}

/**
 * @typedef {object} NavigationOptions
 * @property {import("../i18n/index.js").Translate} t
 * @property {(name: string, kind: Place["kind"]) => boolean} isTaken   by the robot, the file or the language
 * @property {(text: string, kind: "good" | "warning") => void} report
 */

export class Navigation {
  /** @param {NavigationOptions} options */
  constructor(options) {
    this.options = options;
    this.extension = [
      keymap.of([
        { key: "F12", run: (view) => this.goToDefinition(view) },
        { key: "F2", run: (view) => this.rename(view) },
        { key: "Mod-Shift-o", run: (view) => this.openOutline(view) },
      ]),
      EditorView.domEventHandlers({
        mousedown: (event, view) => {
          if (event.button !== 0 || !(event.ctrlKey || event.metaKey)) return false;
          const position = view.posAtCoords({ x: event.clientX, y: event.clientY });
          return position !== null && this.#goTo(view, position);
        },
      }),
    ];
  }

  /** @param {EditorView} view */
  goToDefinition(view) {
    const { t, report } = this.options;
    if (!this.#goTo(view, view.state.selection.main.head)) report(t("goto.none"), "warning");
    return true;
  }

  /** @param {EditorView} view */
  rename(view) {
    const { t, report } = this.options;
    if (view.state.readOnly) return false;
    const places = placesIn(view.state);
    const place = nameAt(places, view.state.selection.main.head);
    if (place === null) report(t("goto.none"), "warning");
    else if (place.kind === "event" || definitionOf(places, place) === null) this.#explainMissing(place);
    else void this.#askName(view, place.from, t("rename.to", { name: place.name }), place.name);
    return true;
  }

  /** @param {EditorView} view */
  openOutline(view) {
    const { t, report } = this.options;
    const { state } = view;
    const parts = outline(treeOf(state), (from, to) => state.sliceDoc(from, to));
    if (parts.length === 0) {
      report(t("outline.empty"), "warning");
      return true;
    }
    showDialog(view, {
      content: (_, close) => h("div", {}, h("form", { "aria-label": t("outline") }, outlineList(view, parts, close))),
      class: "cm-outline",
      focus: true,
      top: true,
    });
    return true;
  }

  /** @param {EditorView} view @param {number} position @returns {boolean} whether there is a name */
  #goTo(view, position) {
    const places = placesIn(view.state);
    const place = nameAt(places, position);
    if (place === null) return false;
    const definition = definitionOf(places, place);
    if (definition === null) this.#explainMissing(place);
    else select(view, definition.from, definition.to);
    return true;
  }

  /** @param {Place} place */
  #explainMissing({ name, kind }) {
    const { t, isTaken, report } = this.options;
    report(t(isTaken(name, kind) ? "goto.elsewhere" : "goto.nowhere", { name }), "warning");
  }

  /**
   * Ask for the new name, again if it does not fit, then change all places in one step that can be undone.
   *
   * @param {EditorView} view
   * @param {number} position
   * @param {string} label
   * @param {string} value  to begin with
   * @returns {Promise<void>}
   */
  async #askName(view, position, label, value) {
    const { t, isTaken, report } = this.options;
    const { result } = showDialog(view, {
      label,
      input: { name: "to", value, spellcheck: "false", autocapitalize: "off", autocomplete: "off" },
      submitLabel: t("rename.do"),
      class: "cm-rename",
      focus: true,
      top: true,
    });
    /** @type {HTMLInputElement | null} */ (view.dom.querySelector(".cm-rename input"))?.select();
    const form = await result;
    const wanted = String(new FormData(form ?? undefined).get("to") ?? "").trim();
    const places = placesIn(view.state);
    const place = nameAt(places, position);
    if (form === null || place === null || wanted === place.name) return view.focus();
    const why = whyNotRename(places, place, wanted, (name) => isTaken(name, place.kind));
    if (why !== null) return this.#askName(view, position, t(why.key, why.values), wanted);
    const same = samePlaces(places, place);
    view.dispatch({ changes: same.map(({ from, to }) => ({ from, to, insert: wanted })), userEvent: "input.rename" });
    view.focus();
    report(t("rename.done", { name: place.name, to: wanted, count: same.length }), "good");
  }
}

/**
 * The parts of the program, to go to one.
 *
 * @param {EditorView} view
 * @param {ReturnType<typeof outline>} parts
 * @param {() => void} close
 */
function outlineList(view, parts, close) {
  const buttons = parts.map(({ kind, name, from }) => {
    const go = () => {
      close();
      select(view, from, from + name.length);
    };
    const line = String(view.state.doc.lineAt(from).number);
    return h(
      "button",
      { type: "button", class: "btn", onclick: go },
      h("span", { class: "outline-word" }, WORDS[kind]),
      h("span", { class: "grow" }, name),
      h("span", { class: "muted" }, line),
    );
  });
  const list = h("div", { class: "outline-list" }, ...buttons);
  list.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1, Enter: 0 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    event.stopPropagation(); // CodeMirror would submit the form at Enter
    const index = buttons.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
    if (step === 0) buttons[index].click();
    else buttons[(index + step + buttons.length) % buttons.length].focus();
  });
  return list;
}
