// The three ways to start, over the lower part of the scene, and the robot's greeting.

import { titleOf } from "../examples/index.js";
import { unfoldTray } from "../stage/tray.js";
import { h, setText } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";
import { offeredExamples } from "./offered_examples.js";
import { rosSheet } from "./ros_sheet.js";

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../state/index.js").State} State */

/** The class of the body while the starts are shown: the tray has no room then. */
const OPEN = "welcome-open";
const PULSE = "welcome-pulse";
/** The behavior that drives by the robot's own arrow buttons, and stops in front of things. */
const DRIVE = "thesis_basic";
const WATCH = "line_follower";
/** From the lower edge of the scene to the starts. */
const EDGE_PX = 12;
/** Height of the greeting's tip above the robot's origin, in meters. */
const OVER_ROBOT_M = 0.075;

/**
 * @param {Context} context
 * @param {import("../i18n/index.js").Translate} t
 * @param {HTMLElement} slot
 * @param {() => void} close   hides the starts for good
 */
export function startsOver(context, t, slot, close) {
  const { actions, scene, store, text, workspace } = context;

  /** Start a behavior on the chosen robot; time runs, so that something moves. @param {string} name */
  const load = async (name) => {
    close();
    if (store.state.simulator?.paused) await actions.pause(false);
    await actions.loadExample(name);
  };
  const drive = () => {
    void load(DRIVE);
    unfoldTray(); // in a low window it is folded, and the arrows are in it
    scene.canvas.focus(); // the arrow keys work at once
    pulse();
  };
  const example = h("button", { type: "button", class: "btn line", "data-start": "program" }, t("program.do"));
  const { element: examples } = menu({
    id: "welcome-examples",
    button: example,
    label: t("program.do"),
    entries: () => [
      ...offeredExamples(store.state.behaviors).map((name) => ({
        label: titleOf(name, text("examples")),
        attributes: { "data-example": name },
        act: () => {
          void load(name);
          workspace.select("program");
        },
      })),
      {
        label: t("program.own"),
        icon: /** @type {const} */ ("text"),
        attributes: { "data-example": "" },
        act: () => {
          close();
          void context.program.openStart(); // the ways to begin, also when the robot runs an example
        },
      },
    ],
  });
  const ros = h("button", { type: "button", class: "btn line", "data-start": "ros" }, t("ros.do"));
  const sheet = rosSheet(context, t, ros, close);
  const rosText = h("p", { class: "muted" });
  const driveText = h("p", { class: "muted" });
  const driveButton = h("button", { type: "button", class: "btn you", "data-start": "drive", onclick: drive }, t("drive.do"));
  const watch = h(
    "button",
    { type: "button", class: "btn welcome-watch", "data-start": "watch", onclick: () => void load(WATCH) },
    icon("eye", { small: true }),
    h("span", {}, t("watch")),
  );
  const element = h(
    "section",
    { class: "welcome-starts", "aria-label": t("start") },
    h(
      "ul",
      { class: "welcome-cards" },
      card("pad", "welcome-you", t("drive"), driveText, driveButton),
      card("program", "welcome-act", t("program"), h("p", { class: "muted" }, t("program.text")), examples),
      card("plug", "welcome-sense", t("ros"), rosText, ros),
    ),
    watch,
  );
  const hello = h("p", { class: "welcome-hello" }, t("hello"));
  slot.append(hello, element, sheet.element);
  document.body.classList.add(OPEN);
  /** Fit the playground into what the cards leave free. @param {number} bottom  CSS pixels */
  const leaveFree = (bottom) => scene.setInsets({ ...scene.camera.insets, bottom });
  const size = new ResizeObserver(() => leaveFree(element.offsetHeight + EDGE_PX));
  size.observe(element);
  let transform = "";
  let topic = "";
  return {
    /** @param {State} state */
    render(state) {
      const isReal = state.robots[state.selected]?.isReal ?? false;
      watch.hidden = isReal; // a real robot has no line to follow here
      setText(driveText, t(isReal ? "drive.real" : "drive.text"));
      const now = sheet.render(state);
      if (now !== topic) {
        topic = now;
        const [before, after] = t("ros.text", { topic: "\n" }).split("\n");
        rosText.replaceChildren(before, h("b", {}, topic), after);
      }
      const place = greetingPlace(context, state);
      hello.hidden = place === null;
      if (place !== null && place !== transform) hello.style.transform = transform = place;
    },
    destroy() {
      size.disconnect();
      leaveFree(0);
      document.body.classList.remove(OPEN);
      keepFocus(slot, () => {
        for (const each of [hello, element, sheet.element]) each.remove();
      });
      scene.invalidate();
    },
  };
}

/**
 * @param {import("../ui/icons.js").IconName} symbol
 * @param {string} meaning  class of the color
 * @param {string} title
 * @param {HTMLElement} about
 * @param {HTMLElement} action
 */
function card(symbol, meaning, title, about, action) {
  return h(
    "li",
    { class: "welcome-start" },
    h("span", { class: `welcome-badge ${meaning}` }, icon(symbol)),
    h("h2", {}, title),
    about,
    h("div", { class: "welcome-action" }, action),
  );
}

/**
 * Where the greeting is: over the chosen robot; null while the robot is not in sight.
 *
 * @param {Context} context
 * @param {State} state
 */
function greetingPlace({ scene }, { robots, selected }) {
  const pose = robots[selected]?.latest?.pose;
  if (pose === undefined) return null;
  const at = scene.projection.toWindow(pose.x, pose.y, pose.z + OVER_ROBOT_M);
  if (at === null) return null;
  const { left, top, width, height } = scene.canvas.getBoundingClientRect();
  const [x, y] = [Math.round(at.x - left), Math.round(at.y - top)];
  if (x < 0 || y < 0 || x > width || y > height) return null;
  return `translate(${x}px, ${y - 10}px) translate(-50%, -100%)`;
}

/** Let the pad pulse once: that is where the arrows are. */
function pulse() {
  const pad = document.querySelector("#pad");
  pad?.classList.add(PULSE);
  pad?.addEventListener("animationend", () => pad.classList.remove(PULSE), { once: true });
}
