// Keys of the list of completions: those of CodeMirror, except where the word is already written.

import { closeCompletion, completionKeymap, currentCompletions, selectedCompletionIndex } from "@codemirror/autocomplete";
import { Prec } from "@codemirror/state";
import { keymap } from "@codemirror/view";

/** @typedef {import("@codemirror/autocomplete").Completion} Completion */
/** @typedef {import("@codemirror/view").Command} Command */
/** @typedef {(word: string, options: readonly Completion[], selected: number | null) => boolean} Rule */

/**
 * Whether Enter breaks the line: the word is one of the completions, and no other one was chosen with the arrows. A
 * completion that inserts more than its name, such as the values of a function, is not written yet.
 *
 * @type {Rule}
 */
export const isWritten = (word, options, selected) =>
  (selected ?? 0) <= 0 && options.some(({ label, apply }) => label === word && apply === undefined);

/** Whether arrows move the cursor: there is nothing to choose. @type {Rule} */
export const isOnlyChoice = (word, options, selected) => options.length === 1 && isWritten(word, options, selected);

const RULES = /** @type {Record<string, Rule>} */ ({
  Enter: isWritten,
  ArrowDown: isOnlyChoice,
  ArrowUp: isOnlyChoice,
  PageDown: isOnlyChoice,
  PageUp: isOnlyChoice,
});

/** A command of the list, unless the rule holds: then the list closes, and the key has its usual effect.
 * @param {Command} command @param {Rule} rule @returns {Command} */
const unless = (command, rule) => (view) => {
  const { state } = view;
  const { head } = state.selection.main;
  const line = state.doc.lineAt(head);
  const [word] = /** @type {RegExpExecArray} */ (/[\p{L}\p{N}_.]*$/u.exec(state.sliceDoc(line.from, head)));
  if (!rule(word, currentCompletions(state), selectedCompletionIndex(state))) return command(view);
  closeCompletion(view);
  return false;
};

export const completionKeys = Prec.highest(
  keymap.of(
    completionKeymap.map((binding) => {
      const rule = RULES[binding.key ?? ""];
      return rule === undefined || binding.run === undefined ? binding : { ...binding, run: unless(binding.run, rule) };
    }),
  ),
);
