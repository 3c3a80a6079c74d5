// What a robot does without a program of one's own: the menu, and every built-in behaviour with its colour.

import { programOf } from "../state/index.js";
import { h, lock, setAttribute } from "./dom.js";

/** The colours the robot itself shows in each of them (docs/behaviors.md). */
export const COLOURS = /** @type {Record<string, string>} */ ({
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
 * A choice of the robot's own behaviours, to stand in another panel.
 *
 * @param {import("./index.js").Context} context
 * @returns {{ element: HTMLElement, render: (state: import("../state/index.js").State) => void }}
 */
export function behaviourChoice({ t, actions }) {
  const select = h("select", { id: "behaviour-choice", "aria-label": t("behaviour.choose") });
  const swatch = h("span", { class: "swatch", "aria-hidden": "true" });
  const description = h("small", { class: "description" });
  const element = h(
    "div",
    { class: "behaviour" },
    h("label", { class: "row" }, swatch, h("span", {}, t("behaviour")), select),
    description,
  );
  select.addEventListener("change", () => {
    if (select.value !== "") void actions.setBehaviour(select.value);
  });
  /** @type {import("../state/index.js").Behaviour[] | null} */ let listed = null;
  return {
    element,
    render(state) {
      const { behaviours } = state;
      lock(select, state.connection === "connected" ? "" : t("connection.needed"));
      if (behaviours !== listed) {
        listed = behaviours;
        element.hidden = behaviours.length === 0;
        const menuFirst = [...behaviours].sort((a, b) => Number(b.name === "menu") - Number(a.name === "menu"));
        select.replaceChildren(
          h("option", { value: "" }, t("behaviour.none")),
          ...menuFirst.map(({ name }) => h("option", { value: name }, titleOf(name, t))),
        );
      }
      const running = programOf(state)?.name ?? "";
      const known = behaviours.find(({ name }) => running === name || running === `${name}.aesl`);
      if (document.activeElement !== select || known !== undefined) select.value = known?.name ?? "";
      const colour = COLOURS[known?.name ?? ""];
      setAttribute(swatch, "data-known", String(colour !== undefined));
      setAttribute(swatch, "style", `--colour: ${colour ?? "transparent"}`);
      const text = known === undefined ? "" : t(`behaviour.${known.name}.about`);
      const told = text.startsWith("behaviour.") ? (known?.description ?? "") : text;
      if (description.textContent !== told) description.textContent = told;
    },
  };
}

/** A name for people; one that a plug-in or a teacher added is shown as it is. @param {string} name @param {import("../i18n/index.js").Translate} t */
function titleOf(name, t) {
  const key = `behaviour.${name}`;
  const text = t(key);
  return text === key ? name.replaceAll("_", " ") : text;
}
