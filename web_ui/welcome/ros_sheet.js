// How to drive the robot from ROS 2: a command for a terminal, a button that sends the same, and the topics.

import { copyText } from "../browser/clipboard.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, lock, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";
import { listensTo, publishesOf, RATE_HZ, speedCommand, SPEED_M_S, TIMES } from "./ros_topics.js";

const MS_PER_S = 1000;
const DOCUMENTATION = "./docs/ros.html";

/**
 * @param {import("../shell/context.js").Context} context
 * @param {import("../i18n/index.js").Translate} t
 * @param {HTMLButtonElement} button  opens the sheet
 * @param {() => void} closed
 */
export function rosSheet({ actions, announce, store, text, scene }, t, button, closed) {
  const pageText = text("page");
  const command = h("code", {});
  const said = h("span", { class: "small muted" });
  /** @param {string} what */
  const say = (what) => {
    setText(said, what);
    announce(what);
  };
  const send = h("button", { type: "button", class: "btn you", "data-ros": "send" }, icon("run"), h("span", {}, t("ros.drive")));
  send.addEventListener("click", () => {
    if (store.state.simulator?.paused) void actions.pause(false);
    sendSpeed(actions);
    say(t("ros.sent"));
  });
  const copy = h("button", { type: "button", class: "btn line", "data-ros": "copy" }, icon("copy"), h("span", {}, t("ros.copy")));
  copy.addEventListener("click", async () => {
    say(t((await copyText(command.textContent ?? "")) ? "ros.copied" : "ros.notCopied"));
  });
  const publishes = h("ul", {});
  const does = h("ul", {});
  const element = h(
    "div",
    { id: "welcome-ros", class: "welcome-ros", role: "dialog", "aria-labelledby": "welcome-ros-title" },
    h(
      "div",
      { class: "welcome-head" },
      h("h2", { id: "welcome-ros-title" }, t("ros")),
      h(
        "button",
        { type: "button", class: "btn icon", title: t("close"), "aria-label": t("close"), onclick: () => element.hidePopover() },
        icon("close"),
      ),
    ),
    h("p", { class: "muted small" }, t("ros.speed")),
    h("pre", { class: "welcome-command", tabindex: "0" }, command),
    h("p", { class: "muted small" }, t("ros.where")),
    h("div", { class: "welcome-row" }, send, copy, said),
    h(
      "div",
      { class: "welcome-topics" },
      h("div", {}, h("h3", {}, t("ros.does")), does),
      h("div", {}, h("h3", {}, t("ros.notices")), publishes),
    ),
    h("p", { class: "small" }, h("a", { href: DOCUMENTATION, target: "_blank", rel: "noopener" }, t("ros.docs"))),
  );
  makeSheet(button, element, {
    opened: () => {
      scene.invalidate();
      send.focus();
    },
    closed: () => {
      if (element.isConnected) closed();
    },
  });
  let shown = "";
  return {
    element,
    /** Call once per frame; returns the topic of the speed. @param {import("../state/index.js").State} state */
    render(state) {
      const { selected, topics } = state;
      const [speed, ...others] = listensTo(selected);
      lock(send, disabledReason(state, pageText));
      if (!element.matches(":popover-open")) return speed.topic;
      const published = publishesOf(topics, selected);
      const key = [selected, ...published].join();
      if (key !== shown) {
        shown = key;
        setText(command, speedCommand(selected));
        does.replaceChildren(
          ...[speed, ...others].map(({ topic, type }) => h("li", {}, h("code", {}, topic), h("small", { class: "muted" }, type))),
        );
        publishes.replaceChildren(...published.map((topic) => h("li", {}, h("code", {}, topic))));
      }
      return speed.topic;
    },
  };
}

/**
 * Send the speed for two seconds, then stop.
 *
 * @param {Pick<import("../input/actions.js").Actions, "operate">} actions
 * @param {(act: () => void, ms: number) => void} [later]
 */
export function sendSpeed(actions, later = (act, ms) => void setTimeout(act, ms)) {
  const still = { x: 0, y: 0, z: 0 };
  /** @param {number} x */
  const publish = (x) => actions.operate("cmd_vel", "geometry_msgs/msg/Twist", { linear: { ...still, x }, angular: still });
  for (let at = 0; at <= TIMES; at++) later(() => publish(at < TIMES ? SPEED_M_S : 0), (at * MS_PER_S) / RATE_HZ);
}
