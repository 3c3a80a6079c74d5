// The text of an Aseba program: what the text field does with it, independent of robots.

import { autocompletion, snippet } from "@codemirror/autocomplete";
import { indentUnit, syntaxTree } from "@codemirror/language";
import { lintGutter } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { hoverTooltip, lineNumbers } from "@codemirror/view";

import { breakpointField, breakpointGutter } from "./breakpoints.js";
import { completionKeys } from "./completion_keys.js";
import { explain, suggestions } from "./help.js";
import { aseba, INDENT } from "./language.js";
import { outline } from "./outline.js";
import { basics } from "./text_field.js";

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

/**
 * @typedef {object} TextOptions
 * @property {string} label
 * @property {Record<string, string>} phrases   CodeMirror's own texts, translated
 * @property {() => Omit<Vocabulary, "definitions">} vocabulary
 * @property {(code: string) => void} changed   called when the user changed the text
 * @property {(line: number) => void} toggleBreakpoint
 * @property {() => void} correct               called when the user asks for the first repair
 * @property {import("@codemirror/state").Extension[]} extensions   of other modules
 */

/** State of a text that is stored. */
export const FIELDS = { breakpoints: breakpointField };

/**
 * How the text looks, and what it does. The order decides where gutters are, and which key comes first.
 *
 * @param {TextOptions} options
 * @returns {import("@codemirror/state").Extension}
 */
export function asebaText({ label, phrases, vocabulary, changed, toggleBreakpoint, correct, extensions }) {
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
    basics({ label, phrases, changed, keys: keys(toggleBreakpoint, correct) }),
    indentUnit.of(INDENT),
    EditorState.tabSize.of(TAB_COLUMNS),
    autocompletion({ override: [completion(words)], icons: false, defaultKeymap: false }),
    completionKeys,
    helpTooltip(words),
    aseba(),
  ];
}

/**
 * @param {TextOptions["toggleBreakpoint"]} toggleBreakpoint
 * @param {() => void} correct
 * @returns {import("@codemirror/view").KeyBinding[]}
 */
function keys(toggleBreakpoint, correct) {
  return [
    {
      key: "Mod-b",
      run: ({ state }) => {
        toggleBreakpoint(state.doc.lineAt(state.selection.main.head).number);
        return true;
      },
    },
    { key: "Mod-.", run: () => (correct(), true) },
  ];
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
