// How the view looks: resolution, sensor values at the beams, 2D view from above, less movement.

import { QUALITIES } from "../scene/quality.js";
import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";

/** @param {import("../shell/context.js").Context} context */
export function lookMenu({ text, scene, motion }) {
  const t = text("stage");
  const quality = h(
    "select",
    { id: "quality", class: "select" },
    ...Object.keys(QUALITIES).map((name) => h("option", { value: name }, t(`display.${name}`))),
  );
  quality.addEventListener("change", () => scene.setQuality(quality.value));
  /** @param {string} id @param {string} label @param {(on: boolean) => void} set */
  const box = (id, label, set) => {
    const input = h("input", { type: "checkbox", id });
    input.addEventListener("change", () => set(input.checked));
    return { input, label: h("label", { class: "check" }, input, h("span", {}, label)) };
  };
  const numbers = box("numbers", t("display.numbers"), (on) => scene.setNumbers(on));
  const flat = box("flatView", t("display.flatView"), (on) => scene.setFlat(on));
  const calm = box("calm", t("view.calm"), (on) => {
    motion.choose(on);
    scene.invalidate();
  });
  const now = h("small", { class: "muted small" });
  const sheet = h(
    "div",
    { id: "look-sheet", role: "group", "aria-label": t("view.look") },
    h("label", { class: "field" }, h("span", { class: "small" }, t("display.quality")), quality),
    now,
    numbers.label,
    flat.label,
    calm.label,
  );
  const button = h(
    "button",
    { type: "button", class: "btn", "data-view": "look", title: t("view.lookHelp") },
    icon("sliders", { small: true }),
    h("span", {}, t("view.look")),
  );
  makeSheet(button, sheet, { opened: () => scene.invalidate() });
  return {
    element: h("span", { class: "menu" }, button, sheet),
    render() {
      quality.value = scene.quality.choice;
      numbers.input.checked = scene.showNumbers;
      flat.input.checked = scene.isFlat;
      flat.input.disabled = !scene.has3d;
      calm.input.checked = motion.wanted;
      const { pixelRatio } = scene.quality.settings;
      setText(now, scene.isFlat ? "" : t("display.limited", { share: Math.round(pixelRatio * 100) }));
    },
  };
}
