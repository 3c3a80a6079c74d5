// Steps of the paused simulation: a button, and a menu with the length of a step.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";

/** Step lengths in ticks of 10 ms. */
const STEPS = [1, 10, 100];
const TICKS_PER_S = 100;

/** @param {Pick<import("../shell/context.js").Context, "text" | "actions" | "scene">} context */
export function stepControl({ text, actions, scene }) {
  const t = text("stage");
  let ticks = 10;
  const word = h("span", { class: "word" });
  const amount = h("span", { class: "amount" });
  const step = h(
    "button",
    { type: "button", class: "btn slim", "data-verb": "step", onclick: () => actions.step(ticks) },
    icon("step", { small: true }),
    word,
    amount,
  );
  const label = t("time.stepLength");
  const length = h(
    "button",
    { type: "button", class: "btn", id: "step-length", "aria-label": label, title: label },
    icon("caretDown", { small: true }),
  );
  const show = () => {
    const seconds = ticks / TICKS_PER_S;
    setText(word, t("time.step", { seconds }));
    setText(amount, t("time.seconds", { seconds }));
    setAttribute(step, "aria-label", word.textContent ?? "");
  };
  const lengths = menu({
    id: "step-menu",
    button: length,
    label,
    isChoice: true,
    entries: () =>
      STEPS.map((choice) => ({
        label: t("time.seconds", { seconds: choice / TICKS_PER_S }),
        chosen: choice === ticks,
        attributes: { "data-ticks": String(choice) },
        act: () => {
          ticks = choice;
          show();
          scene.invalidate();
        },
      })),
  });
  show();
  return {
    element: h("span", { class: "split" }, step, lengths.element),
    step,
    length,
    /** The chosen length. */
    get ticks() {
      return ticks;
    },
  };
}
