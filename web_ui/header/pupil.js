// Whose page this is in a class (docs/classroom.md): in the header, and in the title, which names the tab of the browser.

import { PARAMETERS } from "../state/names.js";
import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function pupilPanel({ text }) {
  const t = text("page");
  const name = h("span", { class: "name" });
  const element = h("p", { id: "pupil", class: "chip", hidden: true }, icon("class", { small: true }), name);
  return {
    slot: "header",
    element,
    render({ parameters }) {
      const pupil = String(parameters[PARAMETERS.pupil] ?? "");
      const title = pupil === "" ? t("app.title") : t("app.titleOf", { name: pupil });
      if (document.title !== title) document.title = title;
      element.hidden = pupil === "";
      setText(name, pupil);
      element.title = pupil === "" ? "" : t("app.pupil", { name: pupil });
    },
  };
}
