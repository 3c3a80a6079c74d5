// The form of the mission: story, goals, what happens, what must not happen, stars, hints and programs.

import { h, renew } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { HEAD, LANGUAGES, LIMITS, problemsOf, robotsOf, STAR, withMission } from "../playground/mission.js";
import { choiceControl, control, numberControl } from "./fields.js";
import { byHand } from "./mission_by_hand.js";
import { goalList } from "./mission_goals.js";
import { happeningList } from "./mission_happens.js";
import { oneLine, present, verb, wordedVerb } from "./mission_parts.js";

/** @typedef {import("../playground/mission.js").Mission} Mission */
/** @typedef {import("../playground/document.js").Playground} Playground */

const ORDERS = ["any", "then", "same"];

/**
 * @param {object} options
 * @param {Omit<import("./fields.js").Setting, "commit">} options.setting
 * @param {import("./creator_model.js").CreatorModel} options.model
 * @param {() => Promise<{ text: string, language: string } | null>} options.openProgram   the program that is open on the page
 */
export function missionForm({ setting, model, openProgram }) {
  const { t } = setting.labels;
  const caret = h("span", { class: "turns" }, icon("caretDown", { small: true }));
  const body = h("div", { class: "mission-inputs" });
  const summary = h("summary", {}, icon("flag", { small: true }), h("span", { class: "grow" }, t("mission")), caret);
  const element = h("details", { class: "mission-form disc" }, summary, body);
  body.addEventListener("pointerup", () => model.changed());
  let isTyping = false;
  body.addEventListener("input", () => (isTyping = true));
  for (const end of ["change", "focusout"]) {
    body.addEventListener(end, () => {
      isTyping = false;
      model.changed();
    });
  }
  /** @type {Playground | null} */ let shown = null;

  /** @param {Partial<Mission> | null} values */
  const change = (values) => model.replacePlayground(withMission(model.playground, values), { word: "change.mission" });

  const part = { setting, change, playground: () => model.playground };

  /** @param {Mission} mission */
  const order = (mission) => {
    const one = choiceControl({ ...setting, commit: change }, "order", () => ORDERS, (name) => t(`mission.order.${name}`));
    one.update(mission);
    one.element.hidden = mission.goals.length < 2;
    return one.element;
  };

  /** @param {Mission} mission */
  const languages = (mission) =>
    h(
      "fieldset",
      { class: "languages" },
      h("legend", { class: "cap" }, t("mission.languages")),
      ...LANGUAGES.map((language) => {
        const input = h("input", { type: "checkbox", "data-language": language, checked: mission.languages.includes(language) });
        input.addEventListener("change", () =>
          change({ languages: LANGUAGES.filter((one) => (one === language ? input.checked : mission.languages.includes(one))) }),
        );
        return h("label", { class: "check" }, input, t(`mission.language.${language}`));
      }),
    );

  /** @param {"story" | "hints"} key @param {string} value @param {(text: string) => Partial<Mission>} read */
  const area = (key, value, read) => {
    const id = `mission-${key}`;
    const input = h("textarea", { id, class: "input", rows: key === "story" ? 4 : 3, maxlength: HEAD.story.longest ?? null, "data-field": key });
    input.value = value;
    input.addEventListener("change", () => change(read(input.value)));
    return h("div", { class: "field" }, h("label", { class: "cap", for: id }, t(`mission.${key}`)), input);
  };

  /** @param {Mission} mission @param {"programs" | "solutions"} group */
  const programs = (mission, group) => {
    const status = h("p", { class: "small", role: "status" });
    const take = wordedVerb("add", t("mission.take"), "take", async () => {
      const program = await openProgram();
      const taken = program === null ? [] : mission.languages.filter((language) => language === program.language || (language === "scratch" && program.language === "blocks"));
      if (program === null || taken.length === 0) return void (status.textContent = t("mission.noProgram"));
      change({ [group]: { ...mission[group], ...Object.fromEntries(taken.map((language) => [language, program.text])) } });
    });
    const rows = Object.entries(mission[group]).map(([language, text]) => {
      const name = t(`mission.language.${language}`);
      const { [language]: _gone, ...rest } = mission[group];
      const remove = verb("close", t("mission.removeProgram", { language: name }), "remove", () => change({ [group]: rest }));
      return h("li", { class: "row" }, h("span", { class: "grow" }, t("mission.program", { language: name, length: text.length })), remove);
    });
    return h("section", { "data-programs": group }, h("h3", {}, t(`mission.${group}`)), h("ul", { class: "goals" }, ...rows), take, status);
  };

  /** @param {readonly import("./fields.js").Control[]} controls @param {Mission} mission */
  const fields = (controls, mission) => {
    for (const one of controls) one.update(mission);
    return h("div", { class: "fields" }, ...controls.map((one) => one.element));
  };
  const own = { ...setting, commit: change };

  /** The robot that is programmed, and the time. @param {Mission} mission */
  const frame = (mission) => {
    const robots = robotsOf(model.playground);
    const robot = choiceControl(own, "robot", () => ["", ...robots], (name) => name || t("mission.firstRobot"));
    return fields([...(robots.length > 1 ? [robot] : []), numberControl(own, "time_s", HEAD.time_s)], mission);
  };

  /** @param {Mission} mission */
  const stars = (mission) => {
    const text = (/** @type {string} */ key) => present(control(own, key, STAR.text));
    /** @param {"within" | "length"} word @param {"within_s" | "length"} key */
    const star = (word, key) => [numberControl(own, key, STAR[key]), ...(mission[key] === null ? [] : text(`${word}_text`))];
    return [h("h3", {}, t("mission.stars")), fields([...star("within", "within_s"), ...star("length", "length")], mission), goalList(part, mission, "extra")];
  };

  /** @param {Playground} playground */
  const problems = (playground) =>
    h(
      "ul",
      { class: "note-box wait problems", role: "status", hidden: problemsOf(playground).length === 0 },
      ...problemsOf(playground).map(({ key, phrase }) => h("li", {}, placeOf(t, key), setting.labels.text(phrase))),
    );

  /** A part of the form, or that it is written by hand. @param {Mission} mission @param {string} word @param {() => HTMLElement[]} make */
  const unlessByHand = (mission, word, make) => (word in mission.kept ? [h("p", { class: "small muted" }, t("mission.keptWord", { word }))] : make());

  /** @param {Playground} playground */
  const build = (playground) => {
    const { mission } = playground;
    if (mission === undefined) {
      const make = h("button", { type: "button", class: "btn line", "data-verb": "make-mission", onclick: () => change({}) }, icon("add", { small: true }), t("mission.make"));
      return [h("p", { class: "small muted" }, t("mission.makeHelp")), make];
    }
    const remove = h("button", { type: "button", class: "btn line", "data-verb": "no-mission", onclick: () => change(null) }, icon("close", { small: true }), t("mission.remove"));
    return [
      problems(playground),
      area("story", mission.story, (story) => ({ story: oneLine(story) })),
      frame(mission),
      ...unlessByHand(mission, "success", () => [goalList(part, mission, "goals"), order(mission)]),
      ...unlessByHand(mission, "failure", () => [goalList(part, mission, "never")]),
      ...unlessByHand(mission, "happens", () => [happeningList(part, mission)]),
      ...unlessByHand(mission, "stars", () => stars(mission)),
      area("hints", mission.hints.join("\n"), (text) => ({ hints: text.split("\n").map(oneLine).filter(Boolean).slice(0, LIMITS.hints) })),
      languages(mission),
      programs(mission, "programs"),
      programs(mission, "solutions"),
      byHand(part, mission),
      remove,
    ];
  };

  return {
    element,
    render() {
      const { playground, placing, item } = model;
      element.hidden = placing !== null || item !== null;
      // What is being pressed must still be there when it is released, and a text until it is finished.
      if (element.hidden || playground === shown || isTyping || body.matches(":active")) return;
      shown = playground;
      renew(body, build(playground));
    },
    /** Open the form, as when a mission was opened. */
    open() {
      element.open = true;
    },
  };
}

/** The place of a problem, such as "Goals 2: ". @param {import("../i18n/index.js").Translate} t @param {string} key */
function placeOf(t, key) {
  const [, list, index] = /^(goals|never|extra|happens)\[(\d+)\]/.exec(key) ?? [];
  return list === undefined ? "" : `${t(`mission.${list}`)} ${Number(index) + 1}: `;
}
