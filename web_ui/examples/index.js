// The built-in behaviors as examples: the menu, and each behavior with its color.

import { programOf } from "../state/index.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, lock, setAttribute } from "../ui/dom.js";

/** The colors that the robot shows in each behavior (docs/behaviors.md). */
export const COLORS = /** @type {Record<string, string>} */ ({
  friendly: "#12c22f",
  explorer: "#f2d600",
  fearful: "#e0201b",
  attentive: "#2346f0",
  investigator: "#12c8d8",
  obedient: "#a02be0",
  thesis_basic: "#ffffff",
  thesis_explorer: "#ff8a14",
  thesis_track_follower: "#ff6fb5",
});

/**
 * The choice of an example, embedded in another panel.
 *
 * @param {import("../shell/context.js").Context} context
 * @returns {{ element: HTMLElement, render: (state: import("../state/index.js").State) => void }}
 */
export function exampleChoice({ text, actions }) {
  const t = text("examples");
  const pageText = text("page");
  const select = h("select", { id: "behavior-choice", class: "select", "aria-label": t("behavior.choose") });
  const swatch = h("span", { class: "swatch", "aria-hidden": "true" });
  const description = h("small", { class: "description muted small" });
  const element = h(
    "div",
    { class: "behavior" },
    h("label", { class: "row" }, swatch, h("span", {}, t("behavior")), select),
    description,
  );
  select.addEventListener("change", () => {
    if (select.value !== "") void actions.loadExample(select.value);
  });
  /** @type {import("../state/index.js").Behavior[] | null} */ let listed = null;
  return {
    element,
    render(state) {
      const { behaviors } = state;
      lock(select, disabledReason(state, pageText));
      if (behaviors !== listed) {
        listed = behaviors;
        element.hidden = behaviors.length === 0;
        const menuFirst = [...behaviors].sort((a, b) => Number(b.name === "menu") - Number(a.name === "menu"));
        select.replaceChildren(
          h("option", { value: "" }, t("behavior.none")),
          ...menuFirst.map(({ name }) => h("option", { value: name }, titleOf(name, t))),
        );
      }
      const running = programOf(state)?.name ?? "";
      const known = behaviors.find(({ name }) => running === name || running === `${name}.aesl`);
      if (document.activeElement !== select || known !== undefined) select.value = known?.name ?? "";
      const color = COLORS[known?.name ?? ""];
      setAttribute(swatch, "data-known", String(color !== undefined));
      setAttribute(swatch, "style", `--color: ${color ?? "transparent"}`);
      const text = known === undefined ? "" : t(`behavior.${known.name}.about`);
      const about = text.startsWith("behavior.") ? (known?.description ?? "") : text;
      if (description.textContent !== about) description.textContent = about;
    },
  };
}

/**
 * The displayed name; behaviors added by a plug-in or a teacher keep their own.
 *
 * @param {string} name
 * @param {import("../i18n/index.js").Translate} t
 */
export function titleOf(name, t) {
  const key = `behavior.${name}`;
  const text = t(key);
  return text === key ? name.replaceAll("_", " ") : text;
}
