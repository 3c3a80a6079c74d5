// Language, sound and theme: side by side in the header; on phones in a sheet that a button opens.

import { h } from "../ui/dom.js";
import { foldedList } from "../ui/folded_list.js";
import { icon } from "../ui/icons.js";
import { languageChoice } from "./language.js";
import { soundButton } from "./sound.js";
import { themeSwitch } from "./theme_switch.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function settingsPanel(context) {
  const t = context.text("page");
  const sound = soundButton(context);
  const theme = themeSwitch(context);
  const list = h(
    "div",
    { id: "settings", role: "group", "aria-label": t("settings") },
    languageChoice(context),
    sound.element,
    theme.element,
  );
  const button = h(
    "button",
    { type: "button", class: "btn icon", id: "settings-open", title: t("settings"), "aria-label": t("settings") },
    icon("more"),
  );
  const setFolded = foldedList(button, list);
  return {
    slot: "header",
    element: h("div", { class: "settings" }, button, list),
    render() {
      sound.render();
      theme.render();
      setFolded(context.frame.layout === "phone");
      list.classList.toggle("row", context.frame.layout !== "phone");
    },
  };
}
