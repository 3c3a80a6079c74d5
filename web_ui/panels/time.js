// Time: pause, one step, back to the start, and how fast; the factor really reached stands beside.

import { h, icon, ICONS, setAttribute, setText } from "./dom.js";

export const FACTORS = [0.25, 0.5, 1, 2, 5, 10];

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function timePanel({ t, actions, store, announce }) {
  const pause = h("button", {
    type: "button",
    class: "primary",
    onclick: () => actions.pause(!(store.state.simulator?.paused ?? false)),
  });
  const step = h(
    "button",
    { type: "button", title: t("time.step"), onclick: () => actions.step() },
    icon(ICONS.step),
    h("span", {}, t("time.step")),
  );
  const reset = h(
    "button",
    { type: "button", title: t("time.reset"), onclick: () => actions.reset() },
    icon(ICONS.restart),
    h("span", {}, t("time.reset")),
  );
  const speed = h(
    "select",
    { "aria-label": t("time.speed") },
    ...FACTORS.map((factor) => h("option", { value: factor }, `×${factor}`)),
  );
  speed.addEventListener("change", () => actions.setFactor(Number(speed.value)));
  const achieved = h("span", { class: "achieved" });
  const clock = h("output", { class: "clock", "aria-label": t("time.simulated"), title: t("time.simulated") });
  const element = h(
    "div",
    { class: "time", role: "group", "aria-label": t("time"), "data-drives": "" },
    pause,
    step,
    reset,
    h("label", { class: "speed" }, h("span", {}, t("time.speed")), speed),
    achieved,
    clock,
  );
  /** @type {boolean | null} */ let paused = null;
  let wanted = NaN;
  return {
    slot: "footer",
    element,
    render({ simulator, timeNs, robots, selected, services }) {
      const now = simulator?.paused ?? false;
      if (now !== paused) {
        pause.replaceChildren(
          icon(now ? ICONS.play : ICONS.pause),
          h("span", {}, t(now ? "time.resume" : "time.pause")),
        );
        if (paused !== null) announce(t(now ? "time.paused" : "time.running"));
        paused = now;
      }
      step.disabled = !now || !services.includes("/simulator/step");
      pause.disabled = !services.includes("/simulator/pause");
      reset.disabled = !services.includes("/simulator/reset");
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

/** A factor that is not in the list joins it. @param {HTMLSelectElement} select @param {number} factor */
function showFactor(select, factor) {
  if (![...select.options].some((option) => Number(option.value) === factor)) {
    select.append(h("option", { value: factor }, `×${factor}`));
  }
  select.value = String(factor);
}

/** Minutes, seconds, tenths. @param {number} ns */
export function formatTime(ns) {
  const tenths = Math.floor(ns / 1e8);
  const minutes = Math.floor(tenths / 600);
  return `${minutes}:${((tenths % 600) / 10).toFixed(1).padStart(4, "0")}`;
}
