// Over the view: cameras at the left, tools at the right; on phones each group has one button that opens the others.

import { VIEWS } from "../scene/camera.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, lock, setAttribute, setText } from "../ui/dom.js";
import { foldedList } from "../ui/folded_list.js";
import { icon } from "../ui/icons.js";
import { isTiny } from "../ui/layout.js";
import { fitNames, NAMES } from "../ui/names_fit.js";
import { lookMenu } from "./look_menu.js";
import { savePicture } from "./picture.js";

/** The row of buttons at the upper edge: worlds are fitted into the space below it. */
const ROW_PX = 74;

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function viewsPanel(context) {
  const { text, scene, dragController, announce, frame } = context;
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
  const cameras = VIEWS.map((view) => ({
    view,
    element: button(view, view, () => {
      scene.setView(view);
      closeSheet(cameraList);
    }),
  }));
  const chosen = h("span", {});
  const cameraOpen = h(
    "button",
    { type: "button", class: "btn named", id: "cameras-open" },
    icon("camera", { small: true }),
    chosen,
    icon("caretDown", { small: true }),
  );
  const cameraList = h("div", { class: "float-list", id: "camera-list" }, ...cameras.map(({ element }) => element));
  const beams = button("beams", "beams", () => scene.setSensors(!scene.showSensors));
  const move = button("move", "move", () => {
    dragController.setMode(!dragController.mode);
    closeSheet(toolList);
    if (!dragController.mode) return;
    scene.canvas.focus(); // so that its keys work
    announce(t("move.help"));
  });
  const picture = button("picture", "picture", () => {
    closeSheet(toolList);
    void savePicture(context);
  });
  const look = lookMenu(context);
  const toolOpen = h(
    "button",
    { type: "button", class: "btn icon", id: "tools-open", "aria-label": pageText("more"), title: pageText("more") },
    icon("more", { small: true }),
  );
  const toolList = h("div", { class: "float-list", id: "tool-list" }, move, picture, look.element);
  const foldCameras = foldedList(cameraOpen, cameraList);
  const foldTools = foldedList(toolOpen, toolList);
  const element = h(
    "div",
    { class: "view-row" },
    h("div", { class: "float", id: "cameras", role: "group", "aria-label": t("view.camera") }, cameraOpen, cameraList),
    h("div", { class: "float", id: "tools", role: "group", "aria-label": t("view.tools") }, beams, toolOpen, toolList),
  );
  const fit = fitNames(
    element,
    () => (isTiny(window.innerHeight) ? ["few"] : NAMES),
    () => element.scrollWidth <= element.clientWidth,
  );
  scene.setInsets({ top: ROW_PX });
  /** @type {boolean | null} */ let isPhone = null;
  /** @type {boolean | null} */ let hasIcons = null;
  let shownView = "";
  return {
    slot: "views",
    element,
    render({ connection, readOnly, robots, selected }) {
      move.hidden = robots[selected]?.isReal ?? false; // a real robot is moved by hand
      if (isPhone !== (frame.layout === "phone")) {
        isPhone = frame.layout === "phone";
        foldCameras(isPhone);
        foldTools(isPhone);
        fit();
      }
      if (hasIcons !== isTiny(window.innerHeight)) {
        hasIcons = isTiny(window.innerHeight);
        fit(); // the width may be the same
      }
      lock(/** @type {HTMLButtonElement} */ (move), disabledReason({ connection, readOnly }, pageText));
      const { view } = scene.camera;
      if (view !== shownView) {
        shownView = view;
        for (const camera of cameras) setAttribute(camera.element, "aria-pressed", String(camera.view === view));
        cameraOpen.firstElementChild?.replaceWith(icon(view, { small: true }));
        setText(chosen, t(`view.${view}`));
        setAttribute(cameraOpen, "aria-label", `${t("view.camera")}: ${t(`view.${view}`)}`);
        if (element.dataset.names === "few") fit(); // the chosen one has its name
      }
      setAttribute(move, "aria-pressed", String(dragController.mode));
      setAttribute(beams, "aria-pressed", String(scene.showSensors));
      look.render();
    },
  };
}

/** @param {HTMLElement} list */
function closeSheet(list) {
  if (list.matches(":popover-open")) list.hidePopover();
}
