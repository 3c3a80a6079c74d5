// Camera views: overview, from above, follow, robot's view; sensor beams on or off.

import { VIEWS } from "../scene/camera.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, icon, ICONS, lock, setAttribute } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function viewsPanel({ t, scene, store, dragController, announce }) {
  const buttons = VIEWS.map((view) => ({
    view,
    button: h(
      "button",
      { type: "button", title: t(`view.${view}`), "aria-label": t(`view.${view}`), onclick: () => scene.setView(view) },
      icon(ICONS[view]),
    ),
  }));
  const beams = h(
    "button",
    {
      type: "button",
      title: t("view.sensors"),
      "aria-label": t("view.sensors"),
      onclick: () => scene.setSensors(!scene.showSensors),
    },
    icon(ICONS.beams),
  );
  const move = h(
    "button",
    {
      type: "button",
      "data-view": "move",
      title: t("move"),
      "aria-label": t("move"),
      onclick: () => {
        dragController.setMode(!dragController.mode);
        if (!dragController.mode) return;
        scene.canvas.focus(); // so that its keys work
        announce(t("move.help"));
      },
    },
    icon(ICONS.move),
  );
  const picture = h(
    "button",
    { type: "button", class: "picture", title: t("view.picture"), "aria-label": t("view.picture"), onclick: save },
    icon(ICONS.camera),
  );
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
  const hint = h("p", { class: "hint", hidden: true }, t("move.help"));
  document.querySelector(".stage")?.append(hint);
  const element = h(
    "div",
    { class: "views", role: "toolbar", "aria-label": t("view") },
    ...buttons.map(({ button }) => button),
    beams,
    move,
    picture,
  );
  return {
    slot: "stage",
    element,
    render({ connection, readOnly }) {
      lock(move, disabledReason({ connection, readOnly }, t));
      for (const { view, button } of buttons) setAttribute(button, "aria-pressed", String(scene.camera.view === view));
      setAttribute(move, "aria-pressed", String(dragController.mode));
      hint.hidden = !dragController.mode;
      setAttribute(beams, "aria-pressed", String(scene.showSensors));
    },
  };
}
