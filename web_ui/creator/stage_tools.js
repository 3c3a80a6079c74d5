// Over the view: what the pointer does. Select things, or place them; and whether dragging turns the camera.

import { h, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/**
 * @param {object} options
 * @param {import("../playground/labels.js").Labels} options.labels
 * @param {import("./creator_model.js").CreatorModel} options.model
 * @param {HTMLElement} options.canvas   gets the focus so that keys act on the view
 */
export function stageTools({ labels, model, canvas }) {
  const { t } = labels;
  /** @param {string} label @param {string} help @param {import("../ui/icons.js").IconName} drawing @param {Record<string, any>} more */
  const button = (label, help, drawing, more) =>
    h("button", { type: "button", class: "btn", title: help, ...more }, icon(drawing, { small: true }), h("span", {}, label));
  const select = button(t("tool.select"), t("help.select"), "select", {
    "data-tool": "select",
    onclick: () => {
      model.choose(null);
      canvas.focus();
    },
  });
  const camera = button(t("bar.cameraLabel"), t("bar.camera"), "camera", {
    "data-verb": "camera",
    onclick: () => model.toggleCamera(),
  });
  return {
    element: h("div", { class: "float creator-tools", role: "group", "aria-label": t("palette") }, select, camera),
    render() {
      setAttribute(select, "aria-pressed", String(model.placing === null));
      setAttribute(camera, "aria-pressed", String(model.cameraOn));
    },
  };
}
