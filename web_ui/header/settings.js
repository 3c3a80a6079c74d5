// Language, sound and theme: side by side in the header; on phones in a sheet that a button opens.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";
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
  makeSheet(button, list);
  let isPhone = true;
  return {
    slot: "header",
    element: h("div", { class: "settings" }, button, list),
    render() {
      sound.render();
      theme.render();
      const now = context.frame.layout === "phone";
      if (now === isPhone) return;
      isPhone = now;
      button.hidden = !now;
      list.popover = now ? "auto" : null;
      list.classList.toggle("sheet", now);
      list.classList.toggle("row", !now);
    },
  };
}
