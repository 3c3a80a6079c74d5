// Time control: pause, step with its length, reset, speed, and how fast time really runs. While time is paused the
// stage has `data-paused`. A real robot has no time to control: the bar says so instead.

import { disabledReason, timeDisabledReason } from "../state/disabled_reason.js";
import { h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { fitNames } from "../ui/names_fit.js";
import { stepControl } from "./step_control.js";

const FACTORS = [0.25, 0.5, 1, 2, 5, 10];
/** What the bar says, from the most to the least. */
const WAYS = ["all", "less", "short", "icons"];
/** Less than this share of the speed is reported. */
const SLOW = 0.9;

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../shell/context.js").Panel} Panel */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../state/index.js").State} State */

/** @implements {Panel} */
class TimeBar {
  slot = /** @type {const} */ ("time");
  /** What the width of the bar depends on, when it was fitted last. */
  #fitted = "";

  /** @param {Context} context */
  constructor(context) {
    const { text, actions, frame } = context;
    const t = text("stage");
    this.t = t;
    this.pageText = text("page");
    this.pause = pauseButton(context);
    this.step = stepControl(context);
    this.reset = h(
      "button",
      {
        type: "button",
        class: "btn slim",
        "data-verb": "reset",
        title: t("time.resetHelp"),
        "aria-label": t("time.reset"),
        onclick: () => actions.reset(),
      },
      icon("reset"),
      h("span", { class: "word" }, t("time.reset")),
    );
    this.speed = speedChoice(context);
    this.achieved = achievedSpeed(t);
    this.clock = h("output", { class: "clock", "aria-label": t("time.clock"), title: t("time.clock") });
    this.controls = [
      this.pause.element,
      this.step.element,
      this.reset,
      h("span", { class: "grow" }),
      h("label", { class: "speed" }, h("span", { class: "word" }, t("time.speed")), this.speed.element),
      this.achieved.element,
      this.clock,
    ];
    this.real = realRobotNote(t);
    this.element = h("div", { class: "time-parts" }, ...this.controls, this.real.element);
    this.fit = fitNames(
      this.element,
      () => (frame.layout === "phone" ? ["icons"] : WAYS),
      () => this.element.scrollWidth <= this.element.clientWidth,
    );
  }

  /** @param {State} state */
  render(state) {
    const { simulator, timeNs, robots, programs, selected } = state;
    const robot = robots[selected];
    this.#showControls(!(robot?.isReal ?? false));
    this.real.show(programs[selected]);
    this.pause.show(simulator?.paused ?? false);
    this.achieved.show(simulator, timeDisabledReason(state, this.pageText));
    this.#lock(state);
    this.speed.show(simulator?.factor ?? 1);
    setText(this.clock, formatTime(timeNs || (robot?.latest?.stampNs ?? 0)));
    this.#fitNames();
  }

  /** Show the controls, or the note about a real robot. @param {boolean} shown */
  #showControls(shown) {
    if (shown !== this.real.element.hidden) {
      for (const part of [...this.controls, this.real.element]) part.hidden = !part.hidden;
    }
  }

  /** @param {State} state */
  #lock(state) {
    const { t, pageText } = this;
    const reason = disabledReason(state, pageText);
    const held = timeDisabledReason(state, pageText);
    /** @param {string} verb */
    const missing = (verb) =>
      reason || held || (state.services.includes(`/simulator/${verb}`) ? "" : t("time.unavailable"));
    const isPaused = state.simulator?.paused ?? false;
    lock(this.step.step, missing("step") || (isPaused ? "" : t("time.stepPaused")));
    lock(this.step.length, reason);
    lock(this.pause.element, missing("pause"));
    lock(this.reset, missing("reset"));
    lock(this.speed.element, reason);
  }

  #fitNames() {
    const { achieved, clock, pause, step } = this;
    const { dataset, textContent } = achieved.element;
    const now = `${pause.isPaused} ${dataset.slow} ${textContent?.length} ${clock.textContent?.length} ${step.ticks}`;
    if (now !== this.#fitted) this.fit();
    this.#fitted = now;
  }
}

/** @param {Context} context @returns {Panel} */
export function timePanel(context) {
  return new TimeBar(context);
}

/** @param {Context} context */
function pauseButton({ text, actions, store, announce }) {
  const t = text("stage");
  const element = h("button", {
    type: "button",
    class: "btn line",
    id: "pause",
    "data-verb": "pause",
    onclick: () => actions.pause(!(store.state.simulator?.paused ?? false)),
  });
  /** @type {boolean | null} */ let isPaused = null;
  return {
    element,
    /** Whether time was paused when the button was drawn last; null if it never was. */
    get isPaused() {
      return isPaused;
    },
    /** @param {boolean} now */
    show(now) {
      if (now === isPaused) return;
      const word = t(now ? "time.resume" : "time.pause");
      element.replaceChildren(icon(now ? "run" : "pause"), h("span", { class: "word" }, word));
      setAttribute(element, "aria-label", word);
      setAttribute(element, "class", now ? "btn run" : "btn line"); // the only filled one while time is paused
      element.closest("#stage")?.toggleAttribute("data-paused", now);
      if (isPaused !== null) announce(t(now ? "time.isPaused" : "time.runs"));
      isPaused = now;
    },
  };
}

/** The speed of time; one that is not in the list is added. @param {Context} context */
function speedChoice({ text, actions }) {
  const t = text("stage");
  /** @param {number} factor */
  const option = (factor) => h("option", { value: factor }, t("time.factor", { factor }));
  const attributes = { class: "select quiet", id: "speed", "aria-label": t("time.speed") };
  const element = h("select", attributes, ...FACTORS.map(option));
  element.addEventListener("change", () => actions.setFactor(Number(element.value)));
  let shown = NaN;
  return {
    element,
    /** @param {number} factor */
    show(factor) {
      if (factor === shown) return;
      shown = factor;
      if (![...element.options].some(({ value }) => Number(value) === factor)) element.append(option(factor));
      element.value = String(factor);
    },
  };
}

/** How fast time really runs, or that it does not. @param {Translate} t */
function achievedSpeed(t) {
  const element = h("span", { class: "real small muted" });
  return {
    element,
    /**
     * @param {import("../state/index.js").Simulator | null} simulator
     * @param {string} held   why time does not run, if a teacher has paused it
     */
    show(simulator, held) {
      const factor = simulator?.achieved.toFixed(2) ?? "";
      const isSlow = simulator !== null && !simulator.paused && simulator.achieved < SLOW * simulator.factor;
      const words = simulator?.paused ? held || t("time.isPaused") : t("time.real", { factor });
      setText(element, simulator === null ? "" : words);
      setAttribute(element, "data-slow", String(isSlow));
      setAttribute(element, "title", isSlow ? t("time.slow", { factor }) : "");
    },
  };
}

/** Takes the place of the controls while a real robot is chosen. @param {Translate} t */
function realRobotNote(t) {
  const element = h("p", { class: "real-robot muted", role: "status", hidden: true });
  return {
    element,
    /** @param {State["programs"][string] | undefined} program */
    show(program) {
      const isLost = program?.state === "off"; // a real robot is off while there is no connection to it
      setText(element, t(isLost ? "time.realRobotLost" : "time.realRobot"));
      setAttribute(element, "title", isLost ? (program.values.fault ?? "") : "");
    },
  };
}

/** Format as minutes, seconds and hundredths: the shortest step is one hundredth. @param {number} ns */
function formatTime(ns) {
  const hundredths = Math.floor(ns / 1e7);
  const minutes = Math.floor(hundredths / 6000);
  return `${minutes}:${((hundredths % 6000) / 100).toFixed(2).padStart(5, "0")}`;
}
