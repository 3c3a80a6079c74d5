// The tool palette: select, or place an item.

import { h, icon, setAttribute } from "../panels/dom.js";
import { CREATOR_ICONS } from "./icons.js";
import { readPicture } from "./read_picture.js";

/** In display order. */
const TOOLS = [
  "select",
  "rectangle",
  "octagon",
  "picture",
  "track",
  "box",
  "cylinder",
  "wall",
  "u_figure",
  "door",
  "activation",
  "robot",
];

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {import("./creator_model.js").CreatorModel} options.model
 * @param {HTMLElement} options.canvas   gets the focus so that keys act on the view
 */
export function palette({ t, model, canvas }) {
  const file = h("input", {
    type: "file",
    accept: "image/png,image/jpeg,image/svg+xml",
    hidden: true,
    id: "creator-picture",
    "aria-label": t("field.image"),
  });
  file.addEventListener("change", async () => {
    const chosen = file.files?.[0];
    file.value = "";
    if (chosen === undefined) return;
    const image = await readPicture(chosen);
    if (image === null) return model.report({ word: "problem.picture", values: { name: chosen.name } });
    model.choose("picture", { image });
    canvas.focus();
  });
  const buttons = TOOLS.map((tool) => ({
    tool,
    button: h(
      "button",
      {
        type: "button",
        title: t(`tool.${tool}`),
        "aria-label": t(`tool.${tool}`),
        "data-tool": tool,
        onclick: () => choose(tool),
      },
      icon(CREATOR_ICONS[tool]),
    ),
  }));
  /** @param {string} tool */
  function choose(tool) {
    if (tool === "picture") return file.click();
    model.choose(tool === "select" ? null : tool);
    canvas.focus();
  }
  const element = h(
    "div",
    { class: "palette", role: "toolbar", "aria-label": t("palette"), "aria-orientation": "vertical" },
    ...buttons.map(({ button }) => button),
    file,
  );
  return {
    element,
    render() {
      const now = model.placing?.kind ?? "select";
      for (const { tool, button } of buttons) setAttribute(button, "aria-pressed", String(tool === now));
    },
  };
}
