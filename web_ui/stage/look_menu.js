// How the view looks: resolution, sensor values at the beams, 2D view from above, less movement; and a large picture.

import { QUALITIES } from "../scene/quality.js";
import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";
import { savePicture } from "./picture.js";

/** @param {import("../shell/context.js").Context} context */
export function lookMenu(context) {
  const { text, scene, motion } = context;
  const t = text("stage");
  const quality = h(
    "select",
    { id: "quality", class: "select" },
    ...Object.keys(QUALITIES).map((name) => h("option", { value: name }, t(`view.resolution.${name}`))),
  );
  quality.addEventListener("change", () => scene.setQuality(quality.value));
  /** @param {string} id @param {string} label @param {(on: boolean) => void} set */
  const box = (id, label, set) => {
    const input = h("input", { type: "checkbox", id });
    input.addEventListener("change", () => set(input.checked));
    return { input, label: h("label", { class: "check" }, input, h("span", {}, label)) };
  };
  const numbers = box("numbers", t("view.numbers"), (on) => scene.setNumbers(on));
  const flat = box("flatView", t("view.flat"), (on) => scene.setFlat(on));
  const calm = box("calm", t("view.calm"), (on) => {
    motion.choose(on);
    scene.invalidate();
  });
  const now = h("small", { class: "muted small" });
  const large = h(
    "button",
    {
      type: "button",
      class: "btn line",
      "data-view": "pictureDouble",
      onclick: () => {
        sheet.hidePopover();
        void savePicture(context, 2);
      },
    },
    icon("picture", { small: true }),
    h("span", {}, t("view.pictureDouble")),
  );
  const sheet = h(
    "div",
    { id: "look-sheet", role: "group", "aria-label": t("view.options") },
    h("label", { class: "value" }, h("span", {}, t("view.resolution")), quality),
    now,
    numbers.label,
    flat.label,
    calm.label,
    large,
  );
  const button = h(
    "button",
    {
      type: "button",
      class: "btn",
      "data-view": "look",
      "data-extra": "",
      title: t("view.optionsHelp"),
      "aria-label": t("view.options"),
    },
    icon("sliders", { small: true }),
    h("span", {}, t("view.options")),
  );
  makeSheet(button, sheet, { opened: () => scene.invalidate() });
  return {
    element: h("span", { class: "menu" }, button, sheet),
    render() {
      if (!sheet.matches(":popover-open")) return;
      quality.value = scene.quality.choice;
      numbers.input.checked = scene.showNumbers;
      flat.input.checked = scene.painter.isFlat;
      flat.input.disabled = !scene.painter.has3d;
      calm.input.checked = motion.wanted;
      const { pixelRatio } = scene.quality.settings;
      setText(now, scene.painter.isFlat || pixelRatio >= 1 ? "" : t("view.limited", { share: Math.round(pixelRatio * 100) }));
    },
  };
}
