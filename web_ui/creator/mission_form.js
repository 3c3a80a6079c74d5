// The form of the mission: story, goals, what must not happen, stars, hints and start programs.

import { h, renew } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { choicesOf, FACTS, HEAD, LANGUAGES, LIMITS, newGoal, problemsOf, robotsOf, STAR, withMission } from "../playground/mission.js";
import { choiceControl, control, numberControl } from "./fields.js";

/** @typedef {import("../playground/mission.js").Goal} Goal */
/** @typedef {import("../playground/mission.js").Mission} Mission */
/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {"goals" | "never"} List */

/** How long a goal lasts, 0 for a moment. */
const HOLD = /** @type {import("../playground/declarations.js").DeclaredField} */ ({ type: "number", unit: "s", low: 0, high: LIMITS.hold_s });
const ORDERS = ["any", "then", "same"];

/**
 * The usual text of a goal.
 *
 * @param {import("../i18n/index.js").Translate} t
 * @param {Goal} goal
 */
export function usualText(t, { kind, values }) {
  const all = Object.entries({ ...defaultsOf(kind), ...values });
  const filled = Object.fromEntries(all.map(([key, value]) => [key, wordFor(t, value)]));
  return t(`goal.${kind}.text`, filled);
}

/**
 * @param {object} options
 * @param {Omit<import("./fields.js").Setting, "commit">} options.setting
 * @param {import("./creator_model.js").CreatorModel} options.model
 * @param {() => Promise<{ text: string, language: string } | null>} options.openProgram   the program that is open on the page
 */
export function missionForm({ setting, model, openProgram }) {
  const { t } = setting.labels;
  const caret = h("span", { class: "turns" }, icon("caretDown", { small: true }));
  const body = h("div", { class: "mission-body" });
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

  /** @param {Mission} mission @param {List} list @param {number} index */
  const goalRow = (mission, list, index) => {
    const goals = mission[list];
    const goal = goals[index];
    /** @param {readonly Goal[]} next */
    const put = (next) => change({ [list]: next });
    /** @param {Partial<Goal>} values */
    const replace = (values) => put(goals.map((one, at) => (at === index ? { ...one, ...values } : one)));
    const inner = {
      ...setting,
      /** @param {Record<string, any>} values */
      commit: ({ ...values }) => replace({ values: { ...goal.values, ...values } }),
    };
    const outer = { ...setting, commit: replace };
    const fields = Object.entries(FACTS[goal.kind]).flatMap(([key, field]) => {
      const choices = choicesOf(goal.kind, key, model.playground);
      const one = choices === null ? control(inner, key, field) : choiceControl(inner, key, () => choices, (value) => wordFor(t, value));
      one?.update({ ...defaultsOf(goal.kind), ...goal.values });
      return one ?? [];
    });
    const robots = robotsOf(model.playground);
    const robot = choiceControl(outer, "robot", () => ["", ...robots], (name) => name || t("mission.firstRobot"));
    robot.update(goal);
    const hold = numberControl(outer, "hold_s", HOLD);
    hold.update(goal);
    const words = control(outer, "text", { type: "text" });
    words?.update(goal);
    words?.element.querySelector("input")?.setAttribute("placeholder", usualText(t, goal));
    const kind = h("select", { class: "input grow", "aria-label": t("mission.what"), "data-field": "kind" });
    kind.append(...Object.keys(FACTS).map((name) => h("option", { value: name, selected: name === goal.kind }, t(`goal.${name}`))));
    kind.addEventListener("change", () => put(goals.map((one, at) => (at === index ? newGoal(kind.value, model.playground) : one))));
    const raise = verb("caretUp", t("mission.raise"), "raise", () => put([...goals.slice(0, index - 1), goal, goals[index - 1], ...goals.slice(index + 1)]));
    raise.hidden = index === 0;
    const remove = verb("close", t("mission.removeGoal"), "remove", () => put(goals.filter((_, at) => at !== index)));
    const shownFields = [...fields, ...(robots.length > 1 ? [robot] : []), hold, ...(words === null ? [] : [words])];
    return h(
      "li",
      { class: "goal", "data-goal": `${list}[${index}]` },
      h("div", { class: "row" }, kind, raise, remove),
      h("div", { class: "fields" }, ...shownFields.map((one) => one.element)),
    );
  };

  /** @param {Mission} mission @param {List} list @param {string} title @param {string} add */
  const goalList = (mission, list, title, add) => {
    const more = h("button", { type: "button", class: "btn line", "data-verb": `add-${list}` }, icon("add", { small: true }), add);
    more.disabled = mission.goals.length + mission.never.length >= LIMITS.facts;
    const first = list === "goals" ? "inside" : "touches";
    const kind = first === "inside" && choicesOf("inside", "zone", model.playground)?.length === 0 ? "driven" : first;
    more.addEventListener("click", () => change({ [list]: [...mission[list], newGoal(kind, model.playground)] }));
    const rows = mission[list].map((_, index) => goalRow(mission, list, index));
    return h("section", {}, h("h3", {}, title), h("ol", { class: "goals" }, ...rows), more);
  };

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

  /** @param {Mission} mission */
  const programs = (mission) => {
    const status = h("p", { class: "small", role: "status" });
    const take = h("button", { type: "button", class: "btn line", "data-verb": "take" }, icon("add", { small: true }), t("mission.take"));
    take.addEventListener("click", async () => {
      const program = await openProgram();
      const taken = program === null ? [] : mission.languages.filter((language) => language === program.language || (language === "scratch" && program.language === "blocks"));
      if (program === null || taken.length === 0) return void (status.textContent = t("mission.noProgram"));
      change({ programs: { ...mission.programs, ...Object.fromEntries(taken.map((language) => [language, program.text])) } });
    });
    const rows = Object.entries(mission.programs).map(([language, text]) => {
      const name = t(`mission.language.${language}`);
      const { [language]: _gone, ...rest } = mission.programs;
      const remove = verb("close", t("mission.removeProgram", { language: name }), "remove", () => change({ programs: rest }));
      return h("li", { class: "row" }, h("span", { class: "grow" }, t("mission.program", { language: name, length: text.length })), remove);
    });
    return h("section", {}, h("h3", {}, t("mission.programs")), h("ul", { class: "goals" }, ...rows), take, status);
  };

  /** @param {Mission} mission */
  const stars = (mission) => {
    const own = { ...setting, commit: change };
    const numbers = [
      numberControl(own, "time_s", HEAD.time_s),
      numberControl(own, "within_s", STAR.within_s),
      numberControl(own, "length", STAR.length),
    ];
    for (const one of numbers) one.update(mission);
    return h("div", { class: "fields" }, ...numbers.map((one) => one.element));
  };

  /** @param {Playground} playground */
  const problems = (playground) =>
    h(
      "ul",
      { class: "note-box wait problems", role: "status", hidden: problemsOf(playground).length === 0 },
      ...problemsOf(playground).map(({ key, phrase }) => h("li", {}, placeOf(t, key), setting.labels.text(phrase))),
    );

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
      goalList(mission, "goals", t("mission.goals"), t("mission.addGoal")),
      order(mission),
      goalList(mission, "never", t("mission.never"), t("mission.addNever")),
      stars(mission),
      area("hints", mission.hints.join("\n"), (text) => ({ hints: text.split("\n").map(oneLine).filter(Boolean).slice(0, LIMITS.hints) })),
      languages(mission),
      programs(mission),
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

/** @param {import("../ui/icons.js").IconName} drawing @param {string} label @param {string} name @param {() => void} act */
function verb(drawing, label, name, act) {
  return h("button", { type: "button", class: "btn line icon", title: label, "aria-label": label, "data-verb": name, onclick: act }, icon(drawing, { small: true }));
}

/** The place of a problem, such as "Goals 2: ". @param {import("../i18n/index.js").Translate} t @param {string} key */
function placeOf(t, key) {
  const [, list, index] = /^(goals|never)\[(\d+)\]/.exec(key) ?? [];
  return list === undefined ? "" : `${t(`mission.${list}`)} ${Number(index) + 1}: `;
}

/** Values of fields that are left out. @param {string} kind */
function defaultsOf(kind) {
  return Object.fromEntries(Object.entries(FACTS[kind]).map(([key, field]) => [key, field.default ?? ""]));
}

/** A value as a word of the page, such as a color or that none was chosen; a name stays. @param {import("../i18n/index.js").Translate} t @param {any} value */
function wordFor(t, value) {
  const key = value === "" || value === null ? "mission.anything" : `choice.${value}`;
  const word = t(key);
  return word === key ? String(value) : word;
}

/** @param {string} text */
function oneLine(text) {
  return text.replace(/[\u0000-\u001f\u007f]+/g, " ").trim();
}
