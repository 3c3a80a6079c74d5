// The built-in behaviors as examples: their names, their colors, and a list to choose from. The first visit and the
// class use them too.

import { programOf } from "../state/index.js";
import { h, lock, setAttribute } from "../ui/dom.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../state/index.js").Behavior} Behavior */

/** The colors that the robot shows in each behavior (docs/behaviors.md). */
export const COLORS = /** @type {Record<string, string>} */ ({
  friendly: "#12c22f",
  explorer: "#f2d600",
  fearful: "#e0201b",
  attentive: "#2346f0",
  investigator: "#12c8d8",
  obedient: "#a02be0",
  thesis_basic: "#ffffff",
  thesis_explorer: "#ff8a14",
  thesis_track_follower: "#ff6fb5",
});

/** The behavior that only waits for a choice (docs/behaviors.md). */
export const WELCOME = "welcome";
/** What a robot without a program reports as its name. */
export const NO_PROGRAM = "none";
/** What pupils use first. */
const FIRST = ["thesis_basic", "line_follower", "thesis_explorer"];
/** What is no program to look at. */
const LAST = [WELCOME, "menu"];

/** The language of programs in which a behavior is written. @param {string} _name */
export function languageOf(_name) {
  return "text"; // all of them: the runtime reads text
}

/**
 * The displayed name; behaviors added by a plug-in or a teacher keep their own.
 *
 * @param {string} name
 * @param {Translate} t  texts of the examples
 */
export function titleOf(name, t) {
  const key = `behavior.${name}`;
  const text = t(key);
  return text === key ? name.replaceAll("_", " ") : text;
}

/** What a behavior does, in a sentence. @param {Behavior} behavior @param {Translate} t  texts of the examples */
export function aboutOf({ name, description }, t) {
  const key = `behavior.${name}.about`;
  const text = t(key);
  return text === key ? description : text;
}

/**
 * The displayed name of a program that may be an example; other programs keep theirs.
 *
 * @param {string} program  name of the program in a robot
 * @param {Translate} t     texts of the examples
 */
export function exampleTitle(program, t) {
  const key = `behavior.${program.replace(/\.aesl$/, "")}`;
  const text = t(key);
  return text === key ? program : text;
}

/** In the order in which they are offered. @param {readonly Behavior[]} behaviors */
export function inOrder(behaviors) {
  /** @param {Behavior} behavior */
  const rank = ({ name }) => {
    const first = FIRST.indexOf(name);
    const last = LAST.indexOf(name);
    return first >= 0 ? first : FIRST.length + 1 + last;
  };
  return [...behaviors].sort((one, other) => rank(one) - rank(other));
}

/** Whether a robot's program is this example. @param {string} program @param {string} example */
export function isExample(program, example) {
  return program === example || program === `${example}.aesl`;
}

/**
 * A list of all examples; the one that the robot runs is marked.
 *
 * @param {object} options
 * @param {Translate} options.t  texts of the examples
 * @param {(name: string) => void} options.choose
 * @param {(name: string) => HTMLElement | null} [options.signOf]   shows the language of an example
 */
export function exampleList({ t, choose, signOf = () => null }) {
  const element = h("ul", { class: "examples", "aria-label": t("behavior.choose") });
  /** @type {readonly Behavior[] | null} */ let listed = null;

  /** @param {Behavior} behavior */
  const rowOf = (behavior) => {
    const color = COLORS[behavior.name];
    const swatch = h("span", { class: "swatch", "aria-hidden": "true", style: `--color: ${color ?? "transparent"}` });
    setAttribute(swatch, "data-known", String(color !== undefined));
    const { name } = behavior;
    const title = h("b", {}, titleOf(name, t));
    const words = h("span", { class: "example-words" }, title, " ", h("small", {}, aboutOf(behavior, t)));
    const attributes = { type: "button", class: "example", "data-example": name, onclick: () => choose(name) };
    const sign = signOf(name);
    return h("li", {}, h("button", attributes, swatch, words, ...(sign === null ? [] : [sign])));
  };

  return {
    element,
    /**
     * @param {import("../state/index.js").State} state
     * @param {string} reason  why none can be chosen; empty: all can
     */
    render(state, reason) {
      if (state.behaviors !== listed) {
        listed = state.behaviors;
        element.replaceChildren(...inOrder(listed).map(rowOf));
      }
      const running = programOf(state)?.name ?? "";
      for (const button of /** @type {NodeListOf<HTMLButtonElement>} */ (element.querySelectorAll(".example"))) {
        lock(button, reason);
        setAttribute(button, "aria-pressed", String(isExample(running, button.dataset.example ?? "")));
      }
    },
  };
}
