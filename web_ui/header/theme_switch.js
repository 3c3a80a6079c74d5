// The choice of the theme: light, dark, or as the system.

import { THEMES } from "../browser/theme.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";

/** @param {import("../shell/context.js").Context} context */
export function themeSwitch({ text, theme, scene }) {
  const t = text("page");
  const button = h("button", { type: "button", class: "btn icon", id: "theme", title: t("theme"), "aria-label": t("theme") });
  const { element } = menu({
    id: "theme-menu",
    button,
    label: t("theme"),
    isChoice: true,
    entries: () =>
      THEMES.map((choice) => ({
        label: t(`theme.${choice}`),
        chosen: theme.choice === choice,
        attributes: { "data-theme-choice": choice },
        act: () => {
          theme.choose(choice);
          scene.invalidate();
        },
      })),
  });
  /** @type {boolean | null} */ let shown = null;
  return {
    element,
    render() {
      if (theme.isDark === shown) return;
      shown = theme.isDark;
      button.replaceChildren(icon(shown ? "moon" : "sun"), h("span", { class: "word" }, t("theme")));
    },
  };
}
