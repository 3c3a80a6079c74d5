// Display options: quality, sensor values at the beams, 2D view from above.

import { QUALITIES } from "../scene/quality.js";
import { card } from "./card.js";
import { h, setText } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function displayPanel({ t, scene }) {
  const quality = h(
    "select",
    { id: "quality" },
    ...Object.keys(QUALITIES).map((name) => h("option", { value: name }, t(`display.${name}`))),
  );
  quality.addEventListener("change", () => scene.setQuality(quality.value));
  /** @param {string} id @param {(on: boolean) => void} set */
  const box = (id, set) => {
    const input = h("input", { type: "checkbox", id });
    input.addEventListener("change", () => set(input.checked));
    return { input, label: h("label", { class: "check" }, input, h("span", {}, t(`display.${id}`))) };
  };
  const numbers = box("numbers", (on) => scene.setNumbers(on));
  const flat = box("flatView", (on) => scene.setFlat(on));
  const now = h("small", {});
  const element = card(
    "display",
    t("display"),
    h("label", { class: "row" }, h("span", {}, t("display.quality")), quality),
    now,
    numbers.label,
    flat.label,
  );
  return {
    slot: "side",
    element,
    render() {
      quality.value = scene.quality.choice;
      numbers.input.checked = scene.showNumbers;
      flat.input.checked = scene.isFlat;
      flat.input.disabled = !scene.has3d;
      const { pixelRatio } = scene.quality.settings;
      setText(now, scene.isFlat ? "" : t("display.limited", { share: Math.round(pixelRatio * 100) }));
    },
  };
}
