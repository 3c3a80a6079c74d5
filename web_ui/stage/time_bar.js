// Time control: pause, step, reset, speed, and the real-time factor that is reached.

import { disabledReason } from "../state/disabled_reason.js";
import { h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

export const FACTORS = [0.25, 0.5, 1, 2, 5, 10];
/** Step lengths in ticks of 10 ms. */
const STEPS = [1, 10, 100];
const TICKS_PER_S = 100;

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function timePanel({ text, actions, store, announce }) {
  const t = text("stage");
  const pageText = text("page");
  const pause = h("button", {
    type: "button",
    class: "btn line",
    id: "pause",
    "data-verb": "pause",
    onclick: () => actions.pause(!(store.state.simulator?.paused ?? false)),
  });
  const step = h(
    "button",
    {
      type: "button",
      class: "btn",
      "data-verb": "step",
      title: t("time.stepHelp"),
      "aria-label": t("time.step"),
      onclick: () => actions.step(Number(length.value)),
    },
    icon("step"),
    h("span", { class: "word" }, t("time.step")),
  );
  const length = h(
    "select",
    { class: "select quiet", id: "step-length", "aria-label": t("time.stepLength"), title: t("time.stepLength") },
    ...STEPS.map((ticks) => h("option", { value: ticks, selected: ticks === 10 }, `${ticks / TICKS_PER_S} s`)),
  );
  const reset = h(
    "button",
    {
      type: "button",
      class: "btn slim",
      "data-verb": "reset",
      title: t("time.reset"),
      "aria-label": t("time.reset"),
      onclick: () => actions.reset(),
    },
    icon("reset"),
    h("span", { class: "word" }, t("time.reset")),
  );
  const speed = h(
    "select",
    { class: "select quiet", id: "speed", "aria-label": t("time.speed"), title: t("time.speed") },
    ...FACTORS.map((factor) => h("option", { value: factor }, `×${factor}`)),
  );
  speed.addEventListener("change", () => actions.setFactor(Number(speed.value)));
  const achieved = h("span", { class: "real small muted" });
  const clock = h("output", { class: "clock", "aria-label": t("time.simulated"), title: t("time.simulated") });
  const element = h(
    "div",
    { class: "time-parts" },
    pause,
    h("span", { class: "split" }, step, length),
    reset,
    h("span", { class: "grow" }),
    speed,
    achieved,
    clock,
  );
  /** @type {boolean | null} */ let paused = null;
  let wanted = NaN;
  return {
    slot: "time",
    element,
    render({ connection, readOnly, simulator, timeNs, robots, selected, services }) {
      const reason = disabledReason({ connection, readOnly }, pageText);
      const now = simulator?.paused ?? false;
      if (now !== paused) {
        pause.replaceChildren(
          icon(now ? "run" : "pause"),
          h("span", { class: "word" }, t(now ? "time.resume" : "time.pause")),
        );
        setAttribute(pause, "aria-label", t(now ? "time.resume" : "time.pause"));
        setAttribute(pause, "class", now ? "btn run" : "btn line"); // the only filled one while time is paused
        if (paused !== null) announce(t(now ? "time.paused" : "time.running"));
        paused = now;
      }
      /** @param {string} verb */
      const missing = (verb) => reason || (services.includes(`/simulator/${verb}`) ? "" : t("time.unavailable"));
      lock(step, missing("step") || (now ? "" : t("time.pauseFirst")));
      lock(length, reason);
      lock(pause, missing("pause"));
      lock(reset, missing("reset"));
      lock(speed, reason);
      const factor = simulator?.factor ?? 1;
      if (factor !== wanted) showFactor(speed, factor);
      wanted = factor;
      setText(
        achieved,
        simulator === null
          ? ""
          : now
            ? t("time.paused")
            : t("time.achieved", { factor: simulator.achieved.toFixed(2) }),
      );
      setAttribute(achieved, "data-slow", String(!now && simulator !== null && simulator.achieved < 0.9 * factor));
      setText(clock, formatTime(timeNs || (robots[selected]?.latest?.stampNs ?? 0)));
    },
  };
}

/** Add a factor that is not in the list. @param {HTMLSelectElement} select @param {number} factor */
function showFactor(select, factor) {
  if (![...select.options].some((option) => Number(option.value) === factor)) {
    select.append(h("option", { value: factor }, `×${factor}`));
  }
  select.value = String(factor);
}

/** Format as minutes, seconds and hundredths: the shortest step is one hundredth. @param {number} ns */
export function formatTime(ns) {
  const hundredths = Math.floor(ns / 1e7);
  const minutes = Math.floor(hundredths / 6000);
  return `${minutes}:${((hundredths % 6000) / 100).toFixed(2).padStart(5, "0")}`;
}
