// The three ways to start, over the lower part of the scene, and the robot's greeting.

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
/** From the lower edge of the scene to the starts. */
const EDGE_PX = 12;
/** Height of the greeting's tip above the robot's origin, in meters. */
const OVER_ROBOT_M = 0.075;

export class Starts {
  #transform = "";
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
    const place = greetingPlace(this.context, state);
    this.hello.hidden = place === null;
    if (place !== null && place !== this.#transform) this.hello.style.transform = this.#transform = place;
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
