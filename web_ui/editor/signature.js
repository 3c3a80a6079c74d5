// The parameters of a call while it is being written, above the cursor.

import { StateField } from "@codemirror/state";
import { showTooltip } from "@codemirror/view";

import { h } from "../ui/dom.js";

/** @typedef {import("./state.js").Native} Native */
/** @typedef {{ name: string, open: number, argument: number }} Call   `argument` counts from 0, `open` is the column of "(" */

const CALL = /\bcall\s+([\p{L}_][\p{L}\p{N}_.]*)\s*\(/gu;

/**
 * The unfinished call at the end of a text of one line; null if there is none.
 *
 * @param {string} before   the line up to the cursor
 * @returns {Call | null}
 */
export function callAt(before) {
  const match = [...before.matchAll(CALL)].at(-1);
  if (match === undefined || before.slice(0, match.index).includes("#")) return null;
  const open = match.index + match[0].length - 1;
  let depth = 0;
  let argument = 0;
  for (const character of before.slice(open)) {
    if (character === "(" || character === "[") depth += 1;
    else if (character === ")" || character === "]") depth -= 1;
    else if (character === "," && depth === 1) argument += 1;
    else if (character === "#") return null;
    if (depth === 0) return null;
  }
  return { name: match[1], open, argument };
}

/**
 * @param {(name: string) => Native | null} nativeOf
 * @returns {import("@codemirror/state").Extension}
 */
export function signatureHelp(nativeOf) {
  /** @param {import("@codemirror/state").EditorState} state @returns {import("@codemirror/view").Tooltip | null} */
  const tooltip = (state) => {
    const { head, empty } = state.selection.main;
    if (!empty) return null;
    const line = state.doc.lineAt(head);
    const call = callAt(state.sliceDoc(line.from, head));
    const native = call && nativeOf(call.name);
    if (call === null || !native || native.parameters.length === 0) return null;
    return { pos: line.from + call.open, above: true, create: () => ({ dom: signatureOf(native, call.argument) }) };
  };
  return StateField.define({
    create: () => /** @type {import("@codemirror/view").Tooltip | null} */ (null),
    // Opening a program or clicking into a finished call shows nothing: only who writes wants it.
    update(shown, change) {
      const isWritten = change.isUserEvent("input") || change.isUserEvent("delete");
      const isMoved = shown !== null && (change.docChanged || change.selection !== undefined);
      return isWritten || isMoved ? tooltip(change.state) : shown;
    },
    provide: (field) => showTooltip.from(field),
  });
}

/** @param {Native} native @param {number} argument  the one that is being written */
function signatureOf({ name, parameters, help }, argument) {
  const listed = parameters.flatMap((parameter, index) => {
    const size = parameter.size === 1 ? "" : `[${parameter.size > 0 ? parameter.size : ""}]`;
    const words = `${parameter.name}${size}`;
    const part = index === argument ? h("b", { class: "signature-argument" }, words) : words;
    return index === 0 ? [part] : [", ", part];
  });
  return h(
    "div",
    { class: "help signature" },
    h("code", {}, `${name}(`, ...listed, ")"),
    ...(help === "" ? [] : [h("p", {}, help)]),
  );
}
