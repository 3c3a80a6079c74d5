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

/**
 * @param {object} options
 * @param {HTMLElement} options.parent
 * @param {Map<string, any>} options.kept            stored states of texts, by key
 * @param {string} options.label
 * @param {Record<string, string>} options.phrases   CodeMirror's own texts, translated
 * @param {() => Omit<Vocabulary, "definitions">} options.vocabulary
 * @param {() => boolean} options.isReadOnly         whether the text that is shown next cannot be changed
 * @param {(code: string) => void} options.changed   called when the user changed the text
 * @param {(line: number) => void} options.toggleBreakpoint
 * @param {(text: string, repair: import("./marks.js").Repair) => string} options.repairLabel  label of a repair button
 * @param {() => void} options.correct               called when the user asks for the first repair
 * @param {import("@codemirror/state").Extension[]} options.extensions   of other modules
 */
export function createText(options) {
  const { parent, kept, label, phrases, vocabulary, isReadOnly, changed, toggleBreakpoint, repairLabel, correct } = options;
  /** @param {EditorState} state @returns {Vocabulary} */
  const words = (state) => ({
    ...vocabulary(),
    definitions: outline(syntaxTree(state), (from, to) => state.sliceDoc(from, to)),
  });

  /** @param {import("@codemirror/autocomplete").CompletionContext} context */
  const complete = ({ state, pos, explicit }) => {
    const line = state.doc.lineAt(pos);
    const { from, items } = suggestions(state.sliceDoc(line.from, pos), words(state));
    if (items.length === 0 || (!explicit && line.from + from === pos)) return null;
    return { from: line.from + from, options: items.map(option), validFor: /^[\p{L}\p{N}_.]*$/u };
  };

  const extensions = [
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
    options.extensions,
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
    autocompletion({ override: [complete], icons: false, defaultKeymap: false }),
    completionKeys,
    highlightActiveLine(),
    highlightSelectionMatches(),
    search({ top: true }),
    hoverTooltip((view, pos) => {
      const line = view.state.doc.lineAt(pos);
      const found = explain(line.text, pos - line.from, words(view.state));
      if (found === null || found.item.kind === "keyword") return null;
      const { from, to, item } = found;
      return { pos: line.from + from, end: line.from + to, above: true, create: () => ({ dom: helpOf(item) }) };
    }),
    aseba(),
    EditorState.phrases.of(phrases),
    EditorView.contentAttributes.of({ "aria-label": label, tabindex: "0", spellcheck: "false", autocapitalize: "off" }),
    // Leave dropped files to the page; CodeMirror would insert their content.
    EditorView.domEventHandlers({ drop: ({ dataTransfer }) => (dataTransfer?.files.length ?? 0) > 0 }),
    EditorView.updateListener.of((update) => {
      if (update.docChanged) changed(update.state.doc.toString());
    }),
    keymap.of([
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
    ]),
  ];
  const readOnly = [EditorState.readOnly.of(true), EditorView.editorAttributes.of({ class: "cm-read-only" })];
  const all = () => [extensions, isReadOnly() ? readOnly : []];
  /** @type {string | null} */ let key = null;
  const view = new EditorView({ parent, state: EditorState.create({ extensions }) });
  const keep = () => {
    if (key !== null) kept.set(key, view.state.toJSON(KEPT));
  };
  return {
    view,
    /**
     * Show another text. Each key has its own undo history, which is kept as long as the text is the same.
     *
     * @param {string} next
     * @param {string} code
     */
    show(next, code) {
      keep();
      key = next;
      const known = kept.get(next);
      const same = known !== undefined && known.doc === code;
      view.setState(
        same ? EditorState.fromJSON(known, { extensions: all() }, KEPT) : EditorState.create({ doc: code, extensions: all() }),
      );
      if (same) view.dispatch({ scrollIntoView: true });
    },
    destroy() {
      keep();
      view.destroy();
    },
    find() {
      openSearchPanel(view);
    },
    /** @param {import("./marks.js").Mark[]} marks */
    mark(marks) {
      const { doc } = view.state;
      const end = doc.length;
      const fitting = marks.map(({ from, to, severity, message, hint, repair }) => ({
        from: Math.min(from, end),
        to: Math.min(to, end),
        severity,
        message: hint === undefined ? message : `${message}\n${hint}`,
        actions: repair
          ? [{ name: repairLabel(doc.toString(), repair), apply: () => void this.repair(doc.toString(), repair) }]
          : [],
      }));
      view.dispatch(setDiagnostics(view.state, fitting));
    },
    /**
     * Apply a repair if the text is still the checked one; returns whether it is.
     *
     * @param {string} checked
     * @param {import("./marks.js").Repair} repair
     */
    repair(checked, { from, to, insert }) {
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
    },
  };
}

/** @typedef {ReturnType<typeof createText>} TextField */

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
