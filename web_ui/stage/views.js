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

/** @typedef {import("../shell/context.js").Context} Context */

/** @param {Context} context @returns {import("../shell/context.js").Panel} */
export function viewsPanel(context) {
  const { scene, frame } = context;
  const cameras = cameraGroup(context);
  const tools = toolGroup(context);
  const element = h("div", { class: "view-row" }, cameras.element, tools.element);
  const fit = fitNames(
    element,
    () => (isTiny(window.innerHeight) ? ["few"] : NAMES),
    () => element.scrollWidth <= element.clientWidth,
  );
  scene.setInsets({ top: ROW_PX });
  /** @type {boolean | null} */ let isPhone = null;
  /** @type {boolean | null} */ let hasIcons = null;
  return {
    slot: "views",
    element,
    render(state) {
      if (isPhone !== (frame.layout === "phone")) {
        isPhone = frame.layout === "phone";
        cameras.fold(isPhone);
        tools.fold(isPhone);
        fit();
      }
      if (hasIcons !== isTiny(window.innerHeight)) {
        hasIcons = isTiny(window.innerHeight);
        fit(); // the width may be the same
      }
      if (cameras.render() && element.dataset.names === "few") fit(); // the chosen one has its name
      tools.render(state);
    },
  };
}

/** The cameras, one of which is chosen. @param {Context} context */
function cameraGroup({ text, scene }) {
  const t = text("stage");
  const cameras = VIEWS.map((view) => {
    const choose = () => {
      scene.setView(view);
      closeSheet(list);
    };
    return { view, element: viewButton(t, view, view, choose) };
  });
  const chosen = h("span", {});
  const open = h(
    "button",
    { type: "button", class: "btn named", id: "cameras-open" },
    icon("camera", { small: true }),
    chosen,
    icon("caretDown", { small: true }),
  );
  const list = h("div", { class: "float-list", id: "camera-list" }, ...cameras.map(({ element }) => element));
  let shown = "";
  return {
    element: h("div", { class: "float", id: "cameras", role: "group", "aria-label": t("view.camera") }, open, list),
    fold: foldedList(open, list),
    /** Show the chosen camera; returns whether it is another one. */
    render() {
      const { view } = scene.camera;
      if (view === shown) return false;
      shown = view;
      for (const camera of cameras) setAttribute(camera.element, "aria-pressed", String(camera.view === view));
      open.firstElementChild?.replaceWith(icon(view, { small: true }));
      setText(chosen, t(`view.${view}`));
      setAttribute(open, "aria-label", `${t("view.camera")}: ${t(`view.${view}`)}`);
      return true;
    },
  };
}

/** Beams, move, picture, look. @param {Context} context */
function toolGroup(context) {
  const { text, scene, dragController, announce } = context;
  const t = text("stage");
  const pageText = text("page");
  const beams = viewButton(t, "beams", "beams", () => scene.setSensors(!scene.showSensors));
  const move = viewButton(t, "move", "move", () => {
    dragController.setMode(!dragController.mode);
    closeSheet(list);
    if (!dragController.mode) return;
    scene.canvas.focus(); // so that its keys work
    announce(t("move.help"));
  });
  const picture = viewButton(t, "picture", "picture", () => {
    closeSheet(list);
    void savePicture(context);
  });
  const look = lookMenu(context);
  const open = h(
    "button",
    { type: "button", class: "btn icon", id: "tools-open", "aria-label": pageText("more"), title: pageText("more") },
    icon("more", { small: true }),
  );
  const list = h("div", { class: "float-list", id: "tool-list" }, move, picture, look.element);
  return {
    element: h("div", { class: "float", id: "tools", role: "group", "aria-label": t("view.tools") }, beams, open, list),
    fold: foldedList(open, list),
    /** @param {import("../state/index.js").State} state */
    render({ connection, readOnly, robots, selected }) {
      move.hidden = robots[selected]?.isReal ?? false; // a real robot is moved by hand
      lock(move, disabledReason({ connection, readOnly }, pageText));
      setAttribute(move, "aria-pressed", String(dragController.mode));
      setAttribute(beams, "aria-pressed", String(scene.showSensors));
      look.render();
    },
  };
}

/**
 * @param {import("../i18n/index.js").Translate} t
 * @param {string} name
 * @param {import("../ui/icons.js").IconName} drawing
 * @param {() => void} act
 */
function viewButton(t, name, drawing, act) {
  return h(
    "button",
    { type: "button", class: "btn", "data-view": name, title: t(`view.${name}Help`), onclick: act },
    icon(drawing, { small: true }),
    h("span", {}, t(`view.${name}`)),
  );
}

/** @param {HTMLElement} list */
function closeSheet(list) {
  if (list.matches(":popover-open")) list.hidePopover();
}
