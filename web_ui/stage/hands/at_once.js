// The hands that act at once: tap, clap, and pick up, which stays until it is put down.

import { h, lock, setAttribute, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { HAND_KEYS } from "../../input/hand_keys.js";

/** @typedef {import("../../shell/context.js").Context} Context */

/** A robot that is held is 6 cm over the floor; its pose says so. */
const HELD_M = 0.03;

/** Whether a robot is held over the floor. @param {import("../../state/index.js").State["robots"][string] | undefined} robot */
export function isLifted(robot) {
  return (robot?.latest?.pose.z ?? 0) > HELD_M;
}

/**
 * @param {"tap" | "clap" | "lift"} name
 * @param {import("../../i18n/index.js").Translate} t
 * @param {() => void} act
 * @param {string} help
 */
function handButton(name, t, act, help) {
  const title = t("hand.withKey", { name: help, key: HAND_KEYS[name] });
  const word = h("span", {}, t(`hand.${name}`));
  const button = h(
    "button",
    { type: "button", class: "hand", "data-hand": name, "data-operate": name, title, onclick: act },
    icon(name),
    word,
  );
  return { button, word };
}

/** @param {Context} context @returns {import("./index.js").Hand} */
export function tapHand({ text, actions }) {
  const t = text("stage");
  const { button } = handButton("tap", t, () => actions.operate("_press/tap", "std_msgs/msg/Empty", {}), t("hand.tap"));
  return { element: button, render: (_state, reason) => lock(button, reason) };
}

/** @param {Context} context @returns {import("./index.js").Hand} */
export function clapHand({ text, actions }) {
  const t = text("stage");
  const clap = () => actions.operate("_press/clap", "std_msgs/msg/Float32", { data: 1 });
  const { button } = handButton("clap", t, clap, t("hand.clap"));
  return { element: button, render: (_state, reason) => lock(button, reason) };
}

/** @param {Context} context @returns {import("./index.js").Hand} */
export function liftHand({ text, actions, store, announce }) {
  const t = text("stage");
  const lift = () => {
    const { robots, selected } = store.state;
    actions.operate("_press/lift", "std_msgs/msg/Bool", { data: !isLifted(robots[selected]) });
  };
  const { button, word } = handButton("lift", t, lift, t("hand.lift.help"));
  /** @type {boolean | null} */ let held = null;
  let shown = "";
  return {
    element: button,
    render({ robots, selected }, reason) {
      lock(button, reason);
      const now = isLifted(robots[selected]);
      if (held !== null && selected === shown && now !== held) announce(t(now ? "hand.lift.isUp" : "hand.lift.isDown"));
      held = now;
      shown = selected;
      setAttribute(button, "aria-pressed", String(now));
      setText(word, t(now ? "hand.lift.on" : "hand.lift"));
    },
  };
}
