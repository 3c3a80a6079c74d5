// What to do while objects can be moved.

import { h } from "../ui/dom.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function moveHintPanel({ text, dragController }) {
  const element = h("p", { class: "hint note-box", hidden: true }, text("stage")("move.help"));
  return {
    slot: "messages",
    element,
    render() {
      element.hidden = !dragController.mode;
    },
  };
}
