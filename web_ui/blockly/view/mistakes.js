// What is wrong with blocks: what the generator finds, and what the compiler says about the line of a block. Pure.

import { sentence } from "../../editor/mistakes.js";
import { mistakesIn } from "../../input/check_service.js";
import { problemText } from "../messages.js";

/** @typedef {import("../../i18n/index.js").Translate} Translate */
/** @typedef {import("../../input/check_service.js").Verdict} Verdict */
/** @typedef {import("./document.js").BlocksDocument} BlocksDocument */
/** @typedef {{ id: string | null, text: string, isError: boolean }} BlockMistake */

/**
 * All mistakes and warnings, errors first.
 *
 * @param {BlocksDocument} document
 * @param {Verdict | null} verdict   of the compiler, for the program of the document
 * @param {Translate} t   of blockly.json
 * @returns {BlockMistake[]}
 */
export function blockMistakes(document, verdict, t) {
  const own = document.generated.problems.map((problem) => ({
    id: problem.id,
    text: problemText(problem, t),
    isError: problem.severity === "error" && !document.isOther, // of another program, blocks are not used
  }));
  const { blocks } = document;
  const compiler = mistakesIn(verdict).map(({ line, message }) => ({
    id: blocks[(line ?? 1) - 1] ?? null,
    text: sentence(message),
    isError: true,
  }));
  // Blocks with an error of their own are not in the program that the compiler saw.
  const all = own.some(({ isError }) => isError) ? own : [...own, ...compiler];
  return [...all.filter(({ isError }) => isError), ...all.filter(({ isError }) => !isError)];
}

/**
 * The mistakes in one sentence; empty: there are none.
 *
 * @param {readonly BlockMistake[]} mistakes
 * @param {Translate} t   of blockly.json
 */
export function summary(mistakes, t) {
  const errors = mistakes.filter(({ isError }) => isError);
  const [first] = errors.length > 0 ? errors : mistakes;
  if (first === undefined) return "";
  if (errors.length > 1) return t("view.mistakes", { count: errors.length, text: first.text });
  return errors.length === 1 ? t("view.mistake", { text: first.text }) : first.text;
}
