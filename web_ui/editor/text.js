// The text field: CodeMirror configured for Aseba, independent of robots.

import {
  autocompletion,
  closeBrackets,
  closeBracketsKeymap,
  snippet,
} from "@codemirror/autocomplete";
import { defaultKeymap, history, historyField, historyKeymap, indentWithTab, toggleLineComment } from "@codemirror/commands";
import {
  bracketMatching,
  codeFolding,
  foldGutter,
  foldKeymap,
  foldState,
  indentOnInput,
  indentUnit,
  syntaxTree,
} from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { gotoLine, highlightSelectionMatches, openSearchPanel, search, searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import {
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSpecialChars,
  hoverTooltip,
  keymap,
  lineNumbers,
} from "@codemirror/view";

import { breakpointField, breakpointGutter } from "./breakpoints.js";
import { completionKeys } from "./completion_keys.js";
import { explain, suggestions } from "./help.js";
import { aseba, INDENT } from "./language.js";
import { outline } from "./outline.js";

/** @typedef {import("./help.js").Vocabulary} Vocabulary */
/** @typedef {import("./help.js").Item} Item */

const TYPES = /** @type {Record<Item["kind"], string>} */ ({
  variable: "variable",
  constant: "constant",
  event: "interface",
  native: "function",
  subroutine: "method",
  keyword: "keyword",
});

/** Columns of a tab, which leave room beside the values. */
const TAB_COLUMNS = 2;

/** State of a text that outlives its field, beside content and cursor. */
const KEPT = { history: historyField, breakpoints: breakpointField, folds: foldState };
const READ_ONLY = [EditorState.readOnly.of(true), EditorView.editorAttributes.of({ class: "cm-read-only" })];

/**
 * @typedef {object} TextOptions
 * @property {HTMLElement} parent
 * @property {Map<string, any>} kept            stored states of texts, by key
 * @property {string} label
 * @property {Record<string, string>} phrases   CodeMirror's own texts, translated
 * @property {() => Omit<Vocabulary, "definitions">} vocabulary
 * @property {() => boolean} isReadOnly         whether the text that is shown next cannot be changed
 * @property {(code: string) => void} changed   called when the user changed the text
 * @property {(line: number) => void} toggleBreakpoint
 * @property {(text: string, repair: import("./marks.js").Repair) => string} repairLabel  label of a repair button
 * @property {() => void} correct               called when the user asks for the first repair
 * @property {import("@codemirror/state").Extension[]} extensions   of other modules
 */

export class TextField {
  /** Of the shown text. @type {string | null} */ #key = null;

  /** @param {TextOptions} options */
  constructor(options) {
    this.options = options;
    this.extensions = extensionsOf(options);
    this.view = new EditorView({
      parent: options.parent,
      state: EditorState.create({ extensions: this.extensions }),
    });
  }

  /**
   * Show another text. Each key has its own undo history, which is kept as long as the text is the same.
   *
   * @param {string} next
   * @param {string} code
   */
  show(next, code) {
    this.#keep();
    this.#key = next;
    const known = this.options.kept.get(next);
    const same = known !== undefined && known.doc === code;
    const extensions = [this.extensions, this.options.isReadOnly() ? READ_ONLY : []];
    this.view.setState(
      same ? EditorState.fromJSON(known, { extensions }, KEPT) : EditorState.create({ doc: code, extensions }),
    );
    if (same) this.view.dispatch({ scrollIntoView: true });
  }

  destroy() {
    this.#keep();
    this.view.destroy();
  }

  find() {
    openSearchPanel(this.view);
  }

  /** @param {import("./marks.js").Mark[]} marks */
  mark(marks) {
    const { doc } = this.view.state;
    const end = doc.length;
    const text = doc.toString();
    const fitting = marks.map(({ from, to, severity, message, hint, repair }) => ({
      from: Math.min(from, end),
      to: Math.min(to, end),
      severity,
      message: hint === undefined ? message : `${message}\n${hint}`,
      actions: repair
        ? [{ name: this.options.repairLabel(text, repair), apply: () => void this.repair(text, repair) }]
        : [],
    }));
    this.view.dispatch(setDiagnostics(this.view.state, fitting));
  }

  /**
   * Apply a repair if the text is still the checked one; returns whether it is.
   *
   * @param {string} checked
   * @param {import("./marks.js").Repair} repair
   */
  repair(checked, { from, to, insert }) {
    const { view } = this;
    if (view.state.readOnly || view.state.doc.toString() !== checked) return false;
    const anchor = from + insert.length;
    view.dispatch({
      changes: { from, to, insert },
      selection: { anchor },
      scrollIntoView: true,
      userEvent: "input.correct",
    });
    view.focus();
    return true;
  }

  #keep() {
    if (this.#key !== null) this.options.kept.set(this.#key, this.view.state.toJSON(KEPT));
  }
}

/**
 * How the text looks, and what it does. The order decides where gutters are, and which key comes first.
 *
 * @param {TextOptions} options
 */
function extensionsOf({ label, phrases, vocabulary, changed, toggleBreakpoint, correct, extensions }) {
  /** @param {EditorState} state @returns {Vocabulary} */
  const words = (state) => ({
    ...vocabulary(),
    definitions: outline(syntaxTree(state), (from, to) => state.sliceDoc(from, to)),
  });
  return [
    breakpointGutter(toggleBreakpoint),
    lineNumbers({
      domEventHandlers: {
        mousedown(view, line) {
          toggleBreakpoint(view.state.doc.lineAt(line.from).number);
          return true;
        },
      },
    }),
    lintGutter(),
    extensions,
    codeFolding(),
    foldGutter({ openText: "▾", closedText: "▸" }),
    highlightActiveLineGutter(),
    highlightSpecialChars(),
    history(),
    indentOnInput(),
    indentUnit.of(INDENT),
    EditorState.tabSize.of(TAB_COLUMNS),
    bracketMatching(),
    closeBrackets(),
    autocompletion({ override: [completion(words)], icons: false, defaultKeymap: false }),
    completionKeys,
    highlightActiveLine(),
    highlightSelectionMatches(),
    search({ top: true }),
    helpTooltip(words),
    aseba(),
    EditorState.phrases.of(phrases),
    EditorView.contentAttributes.of({ "aria-label": label, tabindex: "0", spellcheck: "false", autocapitalize: "off" }),
    // Leave dropped files to the page; CodeMirror would insert their content.
    EditorView.domEventHandlers({ drop: ({ dataTransfer }) => (dataTransfer?.files.length ?? 0) > 0 }),
    EditorView.updateListener.of((update) => {
      if (update.docChanged) changed(update.state.doc.toString());
    }),
    keys(toggleBreakpoint, correct),
  ];
}

/** @param {TextOptions["toggleBreakpoint"]} toggleBreakpoint @param {() => void} correct */
function keys(toggleBreakpoint, correct) {
  return keymap.of([
    {
      key: "Mod-b",
      run: ({ state }) => {
        toggleBreakpoint(state.doc.lineAt(state.selection.main.head).number);
        return true;
      },
    },
    { key: "Mod-g", run: gotoLine },
    { key: "Mod-.", run: () => (correct(), true) },
    { key: "Mod-d", run: toggleLineComment },
    ...closeBracketsKeymap,
    ...defaultKeymap,
    ...searchKeymap,
    ...historyKeymap,
    ...foldKeymap,
    ...lintKeymap,
    indentWithTab,
  ]);
}

/**
 * Suggestions for the word at the cursor.
 *
 * @param {(state: EditorState) => Vocabulary} words
 * @returns {import("@codemirror/autocomplete").CompletionSource}
 */
function completion(words) {
  return ({ state, pos, explicit }) => {
    const line = state.doc.lineAt(pos);
    const { from, items } = suggestions(state.sliceDoc(line.from, pos), words(state));
    if (items.length === 0 || (!explicit && line.from + from === pos)) return null;
    return { from: line.from + from, options: items.map(option), validFor: /^[\p{L}\p{N}_.]*$/u };
  };
}

/** Help for the word below the pointer. @param {(state: EditorState) => Vocabulary} words */
function helpTooltip(words) {
  return hoverTooltip((view, pos) => {
    const line = view.state.doc.lineAt(pos);
    const found = explain(line.text, pos - line.from, words(view.state));
    if (found === null || found.item.kind === "keyword") return null;
    const { from, to, item } = found;
    return { pos: line.from + from, end: line.from + to, above: true, create: () => ({ dom: helpOf(item) }) };
  });
}

/** @param {Item} item @param {number} place  index in the list @returns {import("@codemirror/autocomplete").Completion} */
function option(item, place) {
  const { name, kind, detail, help, native, rank } = item;
  const fields = native?.parameters.map((parameter) => `\${${parameter.name}}`).join(", ");
  return {
    label: name,
    sortText: `${rank}${String(place).padStart(5, "0")}`,
    type: TYPES[kind],
    detail,
    ...(help === "" ? {} : { info: help }),
    ...(fields === undefined ? {} : { apply: snippet(`${name}(${fields})`) }),
  };
}

/** @param {Item} item */
function helpOf({ name, detail, help }) {
  const dom = document.createElement("div");
  dom.className = "help";
  const head = document.createElement("code");
  head.textContent = name + (detail.startsWith("=") ? ` ${detail}` : detail);
  dom.append(head);
  if (help !== "") dom.append(Object.assign(document.createElement("p"), { textContent: help }));
  return dom;
}
