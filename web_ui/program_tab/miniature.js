// A program as a small picture: the first lines of its text, too small to be read but different for each program.

import { isPython } from "../browser/python_name.js";
import { AeslError, readAesl } from "../editor/aesl.js";
import { h } from "../ui/dom.js";
import { pieces } from "./marked_text.js";

const LINES = 12;
const COLUMNS = 40;

/** @param {{ name: string, text: string }} file */
export function miniature({ name, text }) {
  return h(
    "span",
    { class: "program-miniature", "aria-hidden": "true" },
    ...firstLines(text, name).map((line) =>
      h("span", {}, ...pieces(line).map(({ look, text: part }) => (look === "" ? part : h("span", { class: `program-code-${look}` }, part)))),
    ),
  );
}

/**
 * The first lines of the code that say something.
 *
 * @param {string} text
 * @param {string} [name]   of the file
 * @returns {string[]}
 */
export function firstLines(text, name = "") {
  let code = isPython(name) ? text : "";
  try {
    if (code === "") code = readAesl(text).nodes.map((node) => node.code).join("\n");
  } catch (error) {
    if (!(error instanceof AeslError)) throw error;
  }
  const lines = code.split(/\r\n|\r|\n/).filter((line) => line.trim() !== "");
  return lines.slice(0, LINES).map((line) => line.replaceAll("\t", "  ").slice(0, COLUMNS));
}
