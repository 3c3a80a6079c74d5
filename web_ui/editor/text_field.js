// A text field: CodeMirror with what all languages of texts share, independent of robots.

import { closeBrackets, closeBracketsKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyField, historyKeymap, indentWithTab, toggleLineComment } from "@codemirror/commands";
import { bracketMatching, codeFolding, foldGutter, foldKeymap, foldState, indentOnInput } from "@codemirror/language";
import { lintKeymap, setDiagnostics } from "@codemirror/lint";
import { gotoLine, highlightSelectionMatches, openSearchPanel, search, searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import { EditorView, highlightActiveLine, highlightActiveLineGutter, highlightSpecialChars, keymap } from "@codemirror/view";

/** State of a text that outlives its field, beside content and cursor. */
const KEPT = { history: historyField, folds: foldState };
const READ_ONLY = [EditorState.readOnly.of(true), EditorView.editorAttributes.of({ class: "cm-read-only" })];

/**
 * @typedef {object} FieldOptions
 * @property {HTMLElement} parent
 * @property {Map<string, any>} kept            stored states of texts, by key
 * @property {() => boolean} isReadOnly         whether the text that is shown next cannot be changed
 * @property {import("@codemirror/state").Extension} extensions   how the text looks, and what it does
 * @property {Record<string, import("@codemirror/state").StateField<any>>} [fields]   further state that is stored
 * @property {(text: string, repair: import("./marks.js").Repair) => string} [repairLabel]  label of a repair button
 */

export class TextField {
  /** Of the shown text. @type {string | null} */ #key = null;

  /** @param {FieldOptions} options */
  constructor(options) {
    this.options = options;
    this.fields = { ...KEPT, ...options.fields };
    this.view = new EditorView({
      parent: options.parent,
      state: EditorState.create({ extensions: options.extensions }),
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
    const extensions = [this.options.extensions, this.options.isReadOnly() ? READ_ONLY : []];
    this.view.setState(
      same ? EditorState.fromJSON(known, { extensions }, this.fields) : EditorState.create({ doc: code, extensions }),
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
        ? [{ name: this.options.repairLabel?.(text, repair) ?? "", apply: () => void this.repair(text, repair) }]
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
    if (this.#key !== null) this.options.kept.set(this.#key, this.view.state.toJSON(this.fields));
  }
}

/**
 * What the texts of all languages have behind their gutters.
 *
 * @param {object} options
 * @param {string} options.label
 * @param {Record<string, string>} options.phrases   CodeMirror's own texts, translated
 * @param {(code: string) => void} options.changed   called when the user changed the text
 * @param {readonly import("@codemirror/view").KeyBinding[]} [options.keys]   of the language; they come first
 */
export function basics({ label, phrases, changed, keys = [] }) {
  return [
    codeFolding(),
    foldGutter({ openText: "▾", closedText: "▸" }),
    highlightActiveLineGutter(),
    highlightSpecialChars(),
    history(),
    indentOnInput(),
    bracketMatching(),
    closeBrackets(),
    highlightActiveLine(),
    highlightSelectionMatches(),
    search({ top: true }),
    EditorState.phrases.of(phrases),
    EditorView.contentAttributes.of({ "aria-label": label, tabindex: "0", spellcheck: "false", autocapitalize: "off" }),
    // Leave dropped files to the page; CodeMirror would insert their content.
    EditorView.domEventHandlers({ drop: ({ dataTransfer }) => (dataTransfer?.files.length ?? 0) > 0 }),
    EditorView.updateListener.of((update) => {
      if (update.docChanged) changed(update.state.doc.toString());
    }),
    keymap.of([
      ...keys,
      { key: "Mod-g", run: gotoLine },
      { key: "Mod-d", run: toggleLineComment },
      ...closeBracketsKeymap,
      ...defaultKeymap,
      ...searchKeymap,
      ...historyKeymap,
      ...foldKeymap,
      ...lintKeymap,
      indentWithTab,
    ]),
  ];
}
