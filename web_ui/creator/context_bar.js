// The bar over the selected item: turn, copy, remove.

import { valuesOf } from "../playground/parts.js";
import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { hasKnob, RING_BEYOND_M } from "./pick.js";
import { canTurn, middleOf, reachOf } from "./place.js";

/** @typedef {{ x: number, y: number }} Spot   CSS pixels of the scene */
/** @typedef {{ width: number, height: number }} Size */

/** Distance of the bar from the item, and from the edges of the scene. */
const GAP_PX = 12;
const ROBOT_HEIGHT_M = 0.055;
const AROUND = [0, 1, 2, 3, 4, 5, 6, 7].map((eighth) => (eighth * Math.PI) / 4);

/**
 * Where the bar is: above the spots of an item, else below them, always inside the scene. Pure.
 *
 * @param {Size} bar
 * @param {readonly Spot[]} spots   corners of the item
 * @param {Size} scene
 * @param {number} top   where the buttons over the view end
 * @returns {Spot}   its upper left corner
 */
export function placeOver(bar, spots, scene, top) {
  const [xs, ys] = [spots.map(({ x }) => x), spots.map(({ y }) => y)];
  const middle = (Math.min(...xs) + Math.max(...xs)) / 2;
  const above = Math.min(...ys) - GAP_PX - bar.height;
  const below = Math.max(...ys) + GAP_PX;
  const lowest = scene.height - bar.height - GAP_PX;
  const y = above >= top ? above : below <= lowest ? below : top;
  const x = Math.min(Math.max(middle - bar.width / 2, GAP_PX), Math.max(GAP_PX, scene.width - bar.width - GAP_PX));
  return { x: Math.round(x), y: Math.round(Math.max(top, Math.min(y, lowest))) };
}

/**
 * @param {object} options
 * @param {import("../playground/labels.js").Labels} options.labels
 * @param {import("./creator_model.js").CreatorModel} options.model
 * @param {import("../scene/index.js").SceneView} options.scene
 */
export function contextBar({ labels, model, scene }) {
  const { t } = labels;
  /** @param {string} name @param {string} label @param {string} help @param {import("../ui/icons.js").IconName} drawing @param {() => void} act */
  const button = (name, label, help, drawing, act) =>
    h(
      "button",
      {
        type: "button",
        class: "btn named",
        "data-verb": name,
        title: help,
        onclick: act,
      },
      icon(drawing, { small: true }),
      h("span", {}, label),
    );
  const turn = button("turnLeft", t("act.turn"), t("action.turnLeft"), "turn", () => model.turn(1));
  const copy = button("copy", t("act.copy"), t("action.copy"), "copy", () => model.selecting.duplicate());
  const remove = button("remove", t("act.remove"), t("action.remove"), "remove", () => {
    model.selecting.remove();
    scene.canvas.focus(); // the bar is gone
  });
  const name = h("span", { class: "vh" });
  const element = h("div", { class: "float context-bar", role: "group", hidden: true }, name, turn, copy, remove);
  let transform = "";

  /** The corners of an item on the screen; empty while it cannot be seen. @param {import("../playground/parts.js").Item} item */
  const spotsOf = (item) => {
    const [x, y] = middleOf(item);
    const height = item.kind === "robot" ? ROBOT_HEIGHT_M : (valuesOf(item).height_m ?? 0);
    const reach = hasKnob(item) ? 0 : reachOf(item) + RING_BEYOND_M;
    const { left, top } = scene.canvas.getBoundingClientRect();
    const base = AROUND.map((angle) => scene.projection.toWindow(x + reach * Math.cos(angle), y + reach * Math.sin(angle), 0));
    const spots = [...base, scene.projection.toWindow(x, y, height)];
    return spots.flatMap((spot) => (spot === null ? [] : [{ x: spot.x - left, y: spot.y - top }]));
  };

  return {
    element,
    render() {
      const { item, placing, selecting } = model;
      const { clientWidth: width, clientHeight: height } = scene.canvas;
      const spots = item === null || placing !== null || selecting.grabbed !== null ? [] : spotsOf(item);
      const isSeen = spots.some(({ x, y }) => x > 0 && y > 0 && x < width && y < height);
      element.hidden = !isSeen;
      if (item === null || !isSeen) return;
      setText(name, item.name);
      element.setAttribute("aria-label", `${labels.kind(item.kind)} ${item.name}`);
      turn.hidden = !canTurn(item);
      const bar = { width: element.offsetWidth, height: element.offsetHeight };
      const views = /** @type {HTMLElement} */ (document.querySelector(".views"));
      const top = views.offsetTop + views.offsetHeight + GAP_PX;
      const { x, y } = placeOver(bar, spots, { width, height }, top);
      const next = `translate(${x}px, ${y}px)`;
      if (next === transform) return;
      element.style.transform = transform = next;
      scene.invalidate(); // the camera may still move in this frame
    },
  };
}
