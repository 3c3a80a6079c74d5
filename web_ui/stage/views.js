// Over the view: cameras at the left, tools at the right.

import { VIEWS } from "../scene/camera.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, lock, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { lookMenu } from "./look_menu.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function viewsPanel(context) {
  const { text, scene, store, dragController, announce } = context;
  const t = text("stage");
  const pageText = text("page");
  /** @param {string} name @param {import("../ui/icons.js").IconName} drawing @param {() => void} act */
  const button = (name, drawing, act) =>
    h(
      "button",
      { type: "button", class: "btn", "data-view": name, title: t(`view.${name}Help`), onclick: act },
      icon(drawing, { small: true }),
      h("span", {}, t(`view.${name}`)),
    );
  const cameras = VIEWS.map((view) => ({ view, element: button(view, view, () => scene.setView(view)) }));
  const beams = button("beams", "beams", () => scene.setSensors(!scene.showSensors));
  const move = button("move", "move", () => {
    dragController.setMode(!dragController.mode);
    if (!dragController.mode) return;
    scene.canvas.focus(); // so that its keys work
    announce(t("move.help"));
  });
  const picture = button("picture", "picture", () => void save());
  const look = lookMenu(context);
  async function save() {
    const png = await scene.picture();
    if (png === null) return store.dispatch({ type: "notice", level: "error", text: t("view.noPicture") });
    const address = URL.createObjectURL(png);
    const { simulator, timeNs } = store.state;
    const name = `${simulator?.playground || "thymio"}-${(timeNs / 1e9).toFixed(1)}s.png`.replace(/[^\w.-]+/g, "_");
    h("a", { href: address, download: name }).click();
    URL.revokeObjectURL(address);
    store.dispatch({ type: "notice", level: "info", text: t("view.pictureSaved", { name }) });
  }
  const element = h(
    "div",
    { class: "view-row" },
    h(
      "div",
      { class: "float", id: "cameras", role: "group", "aria-label": t("view.camera") },
      ...cameras.map((camera) => camera.element),
    ),
    h("div", { class: "float", id: "tools", role: "group", "aria-label": t("view.tools") }, beams, move, picture, look.element),
  );
  return {
    slot: "views",
    element,
    render({ connection, readOnly }) {
      lock(/** @type {HTMLButtonElement} */ (move), disabledReason({ connection, readOnly }, pageText));
      for (const { view, element } of cameras) setAttribute(element, "aria-pressed", String(scene.camera.view === view));
      setAttribute(move, "aria-pressed", String(dragController.mode));
      setAttribute(beams, "aria-pressed", String(scene.showSensors));
      look.render();
    },
  };
}
