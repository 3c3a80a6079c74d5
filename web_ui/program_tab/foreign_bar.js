// A program that another program has loaded into the robot as bytecode: where it came from, and its instructions.

import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("../editor/state.js").ProgramInfo} ProgramInfo */

/**
 * The instructions of a program without a text of its own; null for other programs. Pure.
 *
 * @param {ProgramInfo | null | undefined} program
 * @returns {string | null}
 */
export function instructionsOf(program) {
  return program?.foreign === true ? program.source : null;
}

/** @param {import("../i18n/index.js").Translate} t  texts of the editor */
export function foreignBar(t) {
  const code = h("pre", { class: "program-listing", tabindex: "0" });
  const element = h(
    "div",
    { class: "program-draft", id: "program-foreign", hidden: true },
    icon("file", { small: true }),
    h("span", { class: "grow" }, t("foreign")),
    h("details", {}, h("summary", {}, t("foreign.show")), code),
  );
  return {
    element,
    /** @param {ProgramInfo | null | undefined} program  that the robot has */
    render(program) {
      const instructions = instructionsOf(program);
      element.hidden = instructions === null;
      setText(code, instructions ?? "");
    },
  };
}
