// Time control: pause, step with its length, reset, speed, and how fast time really runs. While time is paused the
// stage has `data-paused`. A real robot has no time to control: the bar says so instead.

import { disabledReason, timeDisabledReason } from "../state/disabled_reason.js";
import { h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";
import { fitNames } from "../ui/names_fit.js";

export const FACTORS = [0.25, 0.5, 1, 2, 5, 10];
/** Step lengths in ticks of 10 ms. */
const STEPS = [1, 10, 100];
const TICKS_PER_S = 100;
/** What the bar says, from the most to the least. */
const WAYS = ["all", "less", "short", "icons"];
/** Less than this share of the speed is reported. */
const SLOW = 0.9;

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function timePanel({ text, actions, store, announce, frame, scene }) {
  const t = text("stage");
  const pageText = text("page");
  let ticks = 10;
  const pause = h("button", {
    type: "button",
    class: "btn line",
    id: "pause",
    "data-verb": "pause",
    onclick: () => actions.pause(!(store.state.simulator?.paused ?? false)),
  });
  const stepWord = h("span", { class: "word" });
  const step = h(
    "button",
    { type: "button", class: "btn slim", "data-verb": "step", onclick: () => actions.step(ticks) },
    icon("step", { small: true }),
    stepWord,
    h("span", { class: "amount" }),
  );
  const length = h(
    "button",
    {
      type: "button",
      class: "btn",
      id: "step-length",
      "aria-label": t("time.stepLength"),
      title: t("time.stepLength"),
    },
    icon("caretDown", { small: true }),
  );
  const showLength = () => {
    setText(stepWord, t("time.step", { seconds: ticks / TICKS_PER_S }));
    setText(/** @type {HTMLElement} */ (step.lastElementChild), t("time.seconds", { seconds: ticks / TICKS_PER_S }));
    setAttribute(step, "aria-label", stepWord.textContent ?? "");
  };
  const lengths = menu({
    id: "step-menu",
    button: length,
    label: t("time.stepLength"),
    isChoice: true,
    entries: () =>
      STEPS.map((choice) => ({
        label: t("time.seconds", { seconds: choice / TICKS_PER_S }),
        chosen: choice === ticks,
        attributes: { "data-ticks": String(choice) },
        act: () => {
          ticks = choice;
          showLength();
          scene.invalidate();
        },
      })),
  });
  const reset = h(
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
  const speed = h(
    "select",
    { class: "select quiet", id: "speed", "aria-label": t("time.speed") },
    ...FACTORS.map((factor) => h("option", { value: factor }, t("time.factor", { factor }))),
  );
  speed.addEventListener("change", () => actions.setFactor(Number(speed.value)));
  const achieved = h("span", { class: "real small muted" });
  const clock = h("output", { class: "clock", "aria-label": t("time.clock"), title: t("time.clock") });
  const controls = [
    pause,
    h("span", { class: "split" }, step, lengths.element),
    reset,
    h("span", { class: "grow" }),
    h("label", { class: "speed" }, h("span", { class: "word" }, t("time.speed")), speed),
    achieved,
    clock,
  ];
  const real = h("p", { class: "real-robot muted", role: "status", hidden: true });
  const element = h("div", { class: "time-parts" }, ...controls, real);
  showLength();
  const fit = fitNames(
    element,
    () => (frame.layout === "phone" ? ["icons"] : WAYS),
    () => element.scrollWidth <= element.clientWidth,
  );
  /** @type {boolean | null} */ let paused = null;
  let wanted = NaN;
  /** What the width of the bar depends on, when it was fitted last. */
  let fitted = "";

  /** @param {boolean} now */
  const showPaused = (now) => {
    if (now === paused) return;
    const word = t(now ? "time.resume" : "time.pause");
    pause.replaceChildren(icon(now ? "run" : "pause"), h("span", { class: "word" }, word));
    setAttribute(pause, "aria-label", word);
    setAttribute(pause, "class", now ? "btn run" : "btn line"); // the only filled one while time is paused
    element.closest("#stage")?.toggleAttribute("data-paused", now);
    if (paused !== null) announce(t(now ? "time.isPaused" : "time.runs"));
    paused = now;
  };
  /**
   * How fast time really runs, or that it does not.
   *
   * @param {import("../state/index.js").Simulator | null} simulator
   * @param {string} held   why it does not, if a teacher has paused it
   */
  const showAchieved = (simulator, held) => {
    const factor = simulator?.achieved.toFixed(2) ?? "";
    const isSlow = simulator !== null && !simulator.paused && simulator.achieved < SLOW * simulator.factor;
    const said = simulator?.paused ? held || t("time.isPaused") : t("time.real", { factor });
    setText(achieved, simulator === null ? "" : said);
    setAttribute(achieved, "data-slow", String(isSlow));
    setAttribute(achieved, "title", isSlow ? t("time.slow", { factor }) : "");
  };
  return {
    slot: "time",
    element,
    render({ connection, readOnly, simulator, timeNs, robots, programs, selected, services, parameters }) {
      const reason = disabledReason({ connection, readOnly }, pageText);
      const held = timeDisabledReason({ parameters }, pageText);
      const isReal = robots[selected]?.isReal ?? false;
      if (isReal === real.hidden) for (const part of [...controls, real]) part.hidden = !part.hidden;
      const program = programs[selected];
      const isLost = program?.state === "off"; // a real robot is off while there is no connection to it
      setText(real, t(isLost ? "time.realRobotLost" : "time.realRobot"));
      setAttribute(real, "title", isLost ? (program.values.fault ?? "") : "");
      const now = simulator?.paused ?? false;
      showPaused(now);
      showAchieved(simulator, held);
      /** @param {string} verb */
      const missing = (verb) => reason || held || (services.includes(`/simulator/${verb}`) ? "" : t("time.unavailable"));
      lock(step, missing("step") || (now ? "" : t("time.stepPaused")));
      lock(length, reason);
      lock(pause, missing("pause"));
      lock(reset, missing("reset"));
      lock(speed, reason);
      const factor = simulator?.factor ?? 1;
      if (factor !== wanted) showFactor(speed, factor, t("time.factor", { factor }));
      wanted = factor;
      setText(clock, formatTime(timeNs || (robots[selected]?.latest?.stampNs ?? 0)));
      const said = `${paused} ${achieved.dataset.slow} ${achieved.textContent?.length} ${clock.textContent?.length} ${ticks}`;
      if (said !== fitted) fit();
      fitted = said;
    },
  };
}

/**
 * Choose a factor; it is added if it is not in the list.
 *
 * @param {HTMLSelectElement} select
 * @param {number} factor
 * @param {string} label
 */
function showFactor(select, factor, label) {
  if (![...select.options].some((option) => Number(option.value) === factor)) {
    select.append(h("option", { value: factor }, label));
  }
  select.value = String(factor);
}

/** Format as minutes, seconds and hundredths: the shortest step is one hundredth. @param {number} ns */
export function formatTime(ns) {
  const hundredths = Math.floor(ns / 1e7);
  const minutes = Math.floor(hundredths / 6000);
  return `${minutes}:${((hundredths % 6000) / 100).toFixed(2).padStart(5, "0")}`;
}
