// The next step of a mission: what a solution has first that the pupil's program lacks, in the words of its language.

import { AeslError, readAesl } from "../editor/aesl.js";
import { translator } from "../i18n/index.js";

const BLOCK = /<(?:[\w-]+:)?block\b[^>]*\btype="([^"]+)"[^>]*>((?:\s*<(?:[\w-]+:)?(?:mutation[^>]*\/|field[^>]*>[^<]*<\/(?:[\w-]+:)?field)>)*)/g;
const FIELD = /\bname="([^"]+)"[^>]*>([^<]*)</g;

/**
 * The first part of a list that another list does not have as often; null: it has all of them.
 *
 * @param {readonly string[]} wanted
 * @param {readonly string[]} present
 */
export function firstMissing(wanted, present) {
  const left = [...present];
  for (const part of wanted) {
    const at = left.indexOf(part);
    if (at < 0) return part;
    left.splice(at, 1);
  }
  return null;
}

/** The lines with code, without indentation and comments. @param {string} text  of an .aesl file */
export function codeLines(text) {
  try {
    const code = readAesl(text).nodes.map((node) => node.code).join("\n");
    return code
      .split(/\r\n|\r|\n/)
      .map((line) => line.replace(/#.*$/, "").replace(/\s+/g, " ").trim())
      .filter((line) => line !== "");
  } catch (error) {
    if (!(error instanceof AeslError)) throw error;
    return [];
  }
}

/**
 * The blocks of a file in words, in order; those without words, such as numbers, are left out.
 *
 * @param {string} text   of an .aesl file
 * @param {Readonly<Record<string, string>>} table   texts `block.<type>`
 */
export function blockWords(text, table) {
  return [...text.matchAll(BLOCK)].flatMap(([, type, fields]) => {
    const words = table[`block.${type}`];
    if (words === undefined) return [];
    const values = Object.fromEntries([...fields.matchAll(FIELD)].map(([, name, value]) => [name, value]));
    return [words.replace(/\{(\w+)\}/g, (_all, name) => values[name] ?? "…")];
  });
}

/** The rows of a VPL program in words. @param {string} text @param {string} language */
async function vplRows(text, language) {
  const [{ readVpl }, { blocksOf, isEmptyRow }, { sentence }, { default: texts }] = await Promise.all([
    import("../vpl/file.js"),
    import("../vpl/program.js"),
    import("../vpl/view/sentences.js"),
    import("../i18n/vpl.texts.js"),
  ]);
  const t = translator(language, texts);
  const rows = readVpl(text).program.rows.filter((row) => !isEmptyRow(row));
  return rows.map((row) => blocksOf(row).filter(({ name }) => name !== "statefilter" || row.conditions.length > 0).map((block) => sentence(block, t)).join(" → "));
}

/** @param {string} language  of the page */
async function blockTexts(language) {
  const { default: texts } = await import("../i18n/blockly.texts.js");
  return { ...texts.en, ...texts[language] };
}

/**
 * The next step in words; null: the program has all parts of the solution.
 *
 * @param {object} options
 * @param {string} options.kind        language of the program
 * @param {string} options.solution
 * @param {string} options.own
 * @param {string} options.language    of the page
 */
export async function nextStep({ kind, solution, own, language }) {
  if (kind === "vpl") {
    const rows = await vplRows(own, language).catch(() => []); // an own program may be of another language
    return firstMissing(await vplRows(solution, language), rows);
  }
  if (kind === "blocks" || kind === "scratch") {
    const table = await blockTexts(language);
    return firstMissing(blockWords(solution, table), blockWords(own, table));
  }
  if (kind === "text") return firstMissing(codeLines(solution), codeLines(own));
  const lines = (/** @type {string} */ text) => text.split("\n").map((line) => line.trim()).filter((line) => line !== "");
  return firstMissing(lines(solution), lines(own));
}
