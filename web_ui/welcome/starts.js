// The four ways to start, over the lower part of the scene, and the robot's greeting.

import { titleOf } from "../examples/index.js";
import { unfoldTray } from "../stage/tray.js";
import { h, setText } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";
import { offeredExamples } from "./offered_examples.js";
import { rosSheet } from "./ros_sheet.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../state/index.js").State} State */

/** The class of the body while the starts are shown: the tray has no room then. */
const OPEN = "welcome-open";
const PULSE = "welcome-pulse";
/** The behavior that drives by the robot's own arrow buttons, and stops in front of things. */
const DRIVE = "thesis_basic";
const WATCH = "line_follower";
/** From the edges of the scene to the starts and to the greeting. */
const EDGE_PX = 12;
/** Height of the greeting's tip above the robot's origin, in meters. */
const OVER_ROBOT_M = 0.075;
/** From the tip to the greeting. */
const TIP_PX = 10;
/** From the tip to the left and right edge of the greeting, at least: its corners are round. */
const TIP_FROM_EDGE_PX = 24;

export class Starts {
  #place = "";
  #topic = "";

  /**
   * @param {Context} context
   * @param {Translate} t
   * @param {HTMLElement} slot
   * @param {() => void} close   hides the starts for good
   */
  constructor(context, t, slot, close) {
    this.context = context;
    this.t = t;
    this.slot = slot;
    this.close = close;
    const ros = h("button", { type: "button", class: "btn line", "data-start": "ros" }, t("ros.do"));
    this.sheet = rosSheet(context, t, ros, close);
    this.rosText = h("p", { class: "muted" });
    this.driveText = h("p", { class: "muted" });
    const driving = { type: "button", class: "btn you", "data-start": "drive", onclick: () => this.#drive() };
    const choosing = { type: "button", class: "btn line", "data-start": "missions", onclick: () => void context.mission.openList() };
    const missions = h("button", choosing, t("mission.do"));
    const programText = h("p", { class: "muted" }, t("program.text"));
    this.watch = h(
      "button",
      { type: "button", class: "btn welcome-watch", "data-start": "watch", onclick: () => void this.#load(WATCH) },
      icon("eye", { small: true }),
      h("span", {}, t("watch")),
    );
    this.element = h(
      "section",
      { class: "welcome-starts", "aria-label": t("start") },
      h(
        "ul",
        { class: "welcome-cards" },
        card("pad", "welcome-you", t("drive"), this.driveText, h("button", driving, t("drive.do"))),
        card("flag", "welcome-run", t("mission"), h("p", { class: "muted" }, t("mission.text")), missions),
        card("program", "welcome-act", t("program"), programText, this.#programMenu()),
        card("plug", "welcome-sense", t("ros"), this.rosText, ros),
      ),
      this.watch,
    );
    this.hello = h("p", { class: "welcome-hello" }, t("hello"));
    slot.append(this.hello, this.element, this.sheet.element);
    document.body.classList.add(OPEN);
    this.size = new ResizeObserver(() => this.#leaveFree(this.element.offsetHeight + EDGE_PX));
    this.size.observe(this.element);
  }

  /** @param {State} state */
  render(state) {
    const { t } = this;
    const isReal = state.robots[state.selected]?.isReal ?? false;
    this.watch.hidden = isReal; // a real robot has no line to follow here
    setText(this.driveText, t(isReal ? "drive.real" : "drive.text"));
    const topic = this.sheet.render(state);
    if (topic !== this.#topic) {
      this.#topic = topic;
      const [before, after] = t("ros.text", { topic: "\n" }).split("\n");
      this.rosText.replaceChildren(before, h("b", {}, topic), after);
    }
    this.#placeGreeting(state);
  }

  destroy() {
    this.size.disconnect();
    this.#leaveFree(0);
    document.body.classList.remove(OPEN);
    keepFocus(this.slot, () => {
      for (const each of [this.hello, this.element, this.sheet.element]) each.remove();
    });
    this.context.scene.invalidate();
  }

  /** Put the greeting over the robot, but inside the view; its tip stays at the robot. @param {State} state */
  #placeGreeting(state) {
    const { hello } = this;
    const at = greetingTip(this.context, state);
    hello.hidden = at === null;
    if (at === null) return;
    const { clientWidth, clientHeight } = this.context.scene.canvas;
    const { offsetWidth, offsetHeight } = hello;
    const left = clamp(at.x - Math.round(offsetWidth / 2), EDGE_PX, clientWidth - offsetWidth - EDGE_PX);
    const top = clamp(at.y - TIP_PX - offsetHeight, EDGE_PX, clientHeight - offsetHeight - EDGE_PX);
    const tip = clamp(at.x - left, TIP_FROM_EDGE_PX, offsetWidth - TIP_FROM_EDGE_PX);
    const transform = `translate(${left}px, ${top}px)`;
    const place = `${transform} ${tip}`;
    if (place === this.#place) return;
    this.#place = place;
    hello.style.transform = transform;
    hello.style.setProperty("--tip", `${tip}px`);
  }

  /** Start a behavior on the chosen robot; time runs, so that something moves. @param {string} name */
  async #load(name) {
    const { actions, store } = this.context;
    this.close();
    if (store.state.simulator?.paused) await actions.pause(false);
    await actions.loadExample(name);
  }

  #drive() {
    void this.#load(DRIVE);
    unfoldTray(); // in a low window it is folded, and the arrows are in it
    this.context.scene.canvas.focus(); // the arrow keys work at once
    pulse();
  }

  /** A button with the examples, and the way to a program of one's own. */
  #programMenu() {
    const { t } = this;
    const { store, text, workspace, program } = this.context;
    return menu({
      id: "welcome-examples",
      button: h("button", { type: "button", class: "btn line", "data-start": "program" }, t("program.do")),
      label: t("program.do"),
      entries: () => [
        ...offeredExamples(store.state.behaviors).map((name) => ({
          label: titleOf(name, text("examples")),
          attributes: { "data-example": name },
          act: () => {
            void this.#load(name);
            workspace.select("program");
          },
        })),
        {
          label: t("program.own"),
          icon: /** @type {const} */ ("text"),
          attributes: { "data-example": "" },
          act: () => {
            this.close();
            void program.openStart(); // the ways to begin, also when the robot runs an example
          },
        },
      ],
    }).element;
  }

  /** Fit the playground into what the cards leave free. @param {number} bottom  CSS pixels */
  #leaveFree(bottom) {
    const { scene } = this.context;
    scene.setInsets({ ...scene.camera.insets, bottom });
  }
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
 * Where the greeting's tip is: over the chosen robot, in CSS pixels of the view; null while the robot is not in sight.
 *
 * @param {Context} context
 * @param {State} state
 */
function greetingTip({ scene }, { robots, selected }) {
  const pose = robots[selected]?.latest?.pose;
  if (pose === undefined) return null;
  const at = scene.projection.toWindow(pose.x, pose.y, pose.z + OVER_ROBOT_M);
  if (at === null) return null;
  const { left, top, width, height } = scene.canvas.getBoundingClientRect();
  const [x, y] = [Math.round(at.x - left), Math.round(at.y - top)];
  if (x < 0 || y < 0 || x > width || y > height) return null;
  return { x, y };
}

/** The nearest value of a range; its begin if the range is empty. @param {number} value @param {number} least @param {number} most */
function clamp(value, least, most) {
  return Math.max(least, Math.min(value, most));
}

/** Let the pad pulse once: that is where the arrows are. */
function pulse() {
  const pad = document.querySelector("#pad");
  pad?.classList.add(PULSE);
  pad?.addEventListener("animationend", () => pad.classList.remove(PULSE), { once: true });
}
