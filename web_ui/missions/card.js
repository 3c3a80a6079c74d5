// The open mission, over the scene: its task, the checklist that fills while the robot drives, stars, hints, and what
// comes next.

import { attemptOf } from "../state/index.js";
import { factText, hintsOf, measuredText, missingText, missionText } from "../state/mission.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";
import { icon } from "../ui/icons.js";
import { starRow } from "./stars.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("../state/mission.js").Mission} Mission */
/** @typedef {import("../state/mission.js").Try} Try */
/**
 * @typedef {object} Commands   what the user does with the mission
 * @property {(language: string) => void} program   opens the pupil's program in a language
 * @property {() => Promise<string | null>} step   the next step of the solution in words
 * @property {() => void} again
 * @property {(name: string) => void} next
 * @property {() => void} list
 * @property {() => void} leave
 */

/** Narrower scenes have no room beside the card. */
const WIDE_PX = 700;
/** In these, at least the rest of the height stays for the playground. */
const COVERED = 0.8;
const NS_PER_S = 1e9;
const NODE = "thymio-sim node my_node.py";

/** The stars as a list of texts: that of the goal first. @param {Mission} mission @param {string} language @param {Translate} t */
export function starTexts(mission, language, t) {
  return [
    t("star.goal"),
    ...mission.stars.map(
      ({ text, within_s: seconds, length }, at) =>
        mission.translations[language]?.stars?.[at] ||
        text ||
        (seconds !== null ? t("star.within", { seconds }) : length !== null ? t("star.length", { length }) : t("star.extra")),
    ),
  ];
}

/** What a try says when it is over; "": it goes on. @param {Mission} mission @param {Try | null} attempt @param {string} language @param {Translate} t */
export function outcome(mission, attempt, language, t) {
  if (attempt === null) return "";
  if (attempt.state === "passed") return t("passed");
  if (attempt.state !== "failed") return "";
  if (attempt.reason === "hand") return t("failed.hand");
  /** @param {readonly string[]} facts */
  const texts = (facts) => facts.map((fact) => factText(mission, language, fact)).join(", ");
  if (attempt.reason === "facts") return t("failed.facts", { what: texts(attempt.broken) });
  const missing = attempt.missing.map((fact) => missingText(mission, language, fact)).join(", ");
  return t("failed.time", { what: missing });
}

export class MissionCard {
  #key = "";
  #said = "";
  /** @type {boolean | null} null: by the room that there is */ #folded = null;
  /** Whether the pupil has gone on from the task to a program. */ #isRead = false;
  /** @type {boolean | null} null: open until a try runs */ #isTaskOpen = null;
  #hints = 0;
  /** The next step, in words. */ #step = "";
  #name = "";
  #state = "";

  /**
   * @param {object} options
   * @param {import("../shell/context.js").Context} options.context
   * @param {Translate} options.t
   * @param {HTMLElement} options.slot
   * @param {Commands} options.commands
   * @param {() => string | null} options.language   of the pupil's program
   * @param {() => boolean} options.runsNodes   whether ROS nodes are written and run on the page
   */
  constructor({ context, t, slot, commands, language, runsNodes }) {
    this.context = context;
    this.t = t;
    this.slot = slot;
    this.commands = commands;
    this.language = language;
    this.runsNodes = runsNodes;
    this.title = h("h2", { class: "mission-title", id: "mission-title" });
    this.count = h("span", { class: "mission-count" });
    this.time = h("span", { class: "mission-time" });
    this.fold = h(
      "button",
      { type: "button", class: "btn icon", id: "mission-fold", "aria-controls": "mission-body", onclick: () => this.#toggle() },
      icon("caretDown"),
    );
    this.body = h("div", { class: "mission-body", id: "mission-body" });
    this.element = h(
      "section",
      { class: "mission-card", "aria-labelledby": "mission-title" },
      h("div", { class: "mission-head" }, icon("flag"), this.title, this.count, this.time, this.fold),
      this.body,
    );
    slot.append(this.element);
    this.size = new ResizeObserver(() => this.#leaveFree());
    this.size.observe(this.element);
    this.size.observe(context.scene.canvas);
  }

  destroy() {
    this.size.disconnect();
    const { scene } = this.context;
    scene.setInsets({ ...scene.camera.insets, left: 0, top: 0 });
    keepFocus(this.element, () => this.element.remove());
  }

  /** @param {State} state */
  render(state) {
    const { mission } = state;
    if (mission === null) return;
    const attempt = attemptOf(state);
    this.#place();
    if (mission.name !== this.#name) {
      this.#name = mission.name;
      this.#hints = 0;
      this.#step = "";
      this.#folded = null;
      this.#isRead = false;
    }
    if (attempt !== null && attempt.state !== this.#state) {
      if (attempt.state === "running") this.#isRead = true;
      if (attempt.state === "passed" || attempt.state === "failed") this.#folded = null; // what became of it is shown
      else this.#isTaskOpen = null;
      this.#state = attempt.state;
    }
    const seconds = attempt?.state === "running" ? state.timeNs / NS_PER_S : (attempt?.at_s ?? 0);
    setText(this.time, attempt === null || attempt.state === "waiting" ? "" : this.t("time", { now: Math.floor(seconds), all: mission.time_s }));
    this.#fold(attempt);
    this.#showValues(attempt);
    const { measured, at_s: _at, ...reached } = attempt ?? { measured: {}, at_s: 0 };
    const key = JSON.stringify([mission.name, reached, Object.keys(measured), this.language(), this.runsNodes(), this.#step, this.#hints, state.connection, this.context.language]);
    if (key === this.#key) return;
    this.#key = key;
    this.#show(mission, attempt);
    this.#say(mission, attempt);
  }

  /** Update the quantities only. @param {Try | null} attempt */
  #showValues(attempt) {
    for (const element of this.body.querySelectorAll("[data-fact]")) {
      const { fact } = /** @type {HTMLElement} */ (element).dataset;
      setText(element, measuredText(attempt, fact ?? "", this.context.language));
    }
  }

  /** @param {Try | null} attempt */
  #fold(attempt) {
    const { frame } = this.context;
    const isTight = frame.layout === "phone" || (frame.layout === "single" && document.body.dataset.work === "open");
    const isNews = attempt?.state === "passed" || attempt?.state === "failed" || !this.#isRead;
    const isFolded = this.#folded ?? (isTight && !isNews);
    this.element.toggleAttribute("data-folded", isFolded);
    setAttribute(this.fold, "aria-expanded", String(!isFolded));
    setAttribute(this.fold, "aria-label", this.t(isFolded ? "unfold" : "fold"));
    setAttribute(this.fold, "title", this.t(isFolded ? "unfold" : "fold"));
    this.body.hidden = isFolded;
  }

  #toggle() {
    this.#folded = !this.element.hasAttribute("data-folded");
    this.context.scene.invalidate();
  }

  /** @param {Mission} mission @param {Try | null} attempt */
  #show(mission, attempt) {
    const { t } = this;
    const { language } = this.context;
    setText(this.title, missionText(mission, language, "title"));
    const done = attempt?.done.filter((is) => is).length ?? 0;
    setText(this.count, attempt === null ? "" : t("count", { done, all: attempt.done.length }));
    setAttribute(this.element, "data-state", attempt?.state ?? "waiting");
    keepFocus(
      this.body,
      () =>
        this.body.replaceChildren(
          ...this.#result(mission, attempt),
          this.#task(mission, attempt),
          this.#checklist(mission, attempt),
          ...(attempt?.state === "passed" ? [] : this.#hintList(mission)),
        ),
      () => this.body.querySelector("[data-mission-do='next'], [data-mission-do='again'], button"),
    );
  }

  /** What became of the try, or what hinders the robot. @param {Mission} mission @param {Try | null} attempt */
  #result(mission, attempt) {
    const { t } = this;
    const words = outcome(mission, attempt, this.context.language, t);
    if (attempt === null || words === "") {
      if (!attempt?.trouble) return [];
      return [h("p", { class: "note-box wait mission-trouble" }, icon("warning", { small: true }), h("span", {}, t(`trouble.${attempt.trouble}`)))];
    }
    const isPassed = attempt.state === "passed";
    const next = isPassed && mission.next !== "";
    return [
      h(
        "div",
        { class: `mission-result ${isPassed ? "mission-passed" : "mission-failed"}` },
        h("div", { class: "mission-verdict" }, ...(isPassed ? [starRow(attempt.stars, t)] : []), h("p", {}, words)),
        h(
          "div",
          { class: "mission-row" },
          ...(next
            ? [h("button", { type: "button", class: "btn you", "data-mission-do": "next", onclick: () => this.commands.next(mission.next) }, t("next"))]
            : []),
          h("button", { type: "button", class: `btn ${next ? "line" : "you"}`, "data-mission-do": "again", onclick: this.commands.again }, icon("reset", { small: true }), t("again")),
        ),
      ),
    ];
  }

  /** The task, which folds while a try runs. @param {Mission} mission @param {Try | null} attempt */
  #task(mission, attempt) {
    const { t } = this;
    const isWaiting = attempt === null || attempt.state === "waiting";
    const summary = h("summary", {}, t("task"), h("span", { class: "turns" }, icon("caretDown", { small: true })));
    const element = h(
      "details",
      { class: "disc mission-task" },
      summary,
      h("p", { class: "mission-story" }, missionText(mission, this.context.language, "story")),
      this.#languages(mission),
      this.#stars(mission, attempt),
      h(
        "div",
        { class: "mission-foot" },
        h("button", { type: "button", class: "btn", "data-mission-do": "list", onclick: this.commands.list }, t("all")),
        h("button", { type: "button", class: "btn", "data-mission-do": "leave", onclick: this.commands.leave }, t("leave")),
      ),
    );
    element.open = this.#isTaskOpen ?? isWaiting;
    summary.addEventListener("click", () => (this.#isTaskOpen = !element.open));
    return element;
  }

  /** @param {Mission} mission */
  #languages(mission) {
    const { t } = this;
    const chosen = this.language();
    const buttons = mission.languages.map((id) =>
      h(
        "button",
        {
          type: "button",
          class: "btn line",
          "data-mission-language": id,
          "aria-pressed": String(id === chosen),
          onclick: () => {
            this.#folded = null;
            this.#isRead = true;
            this.commands.program(id);
          },
        },
        t(`with.${id}`),
      ),
    );
    const node = chosen === "ros" && !this.runsNodes() ? [h("p", { class: "small" }, t("ros.text")), h("pre", { class: "mission-command", tabindex: "0" }, NODE), this.#startButton()] : [];
    return h(
      "div",
      { class: "mission-languages" },
      h("p", { class: "cap" }, t(chosen === null ? "languages" : "languages.other")),
      h("div", { class: "mission-row", role: "group", "aria-label": t("languages") }, ...buttons),
      ...node,
    );
  }

  #startButton() {
    return h("button", { type: "button", class: "btn line", "data-mission-do": "begin", onclick: this.commands.again }, icon("run", { small: true }), this.t("ros.begin"));
  }

  /** @param {Mission} mission @param {Try | null} attempt */
  #checklist(mission, attempt) {
    const { t } = this;
    const lines = (attempt?.checklist ?? []).map((facts, at) => {
      const isDone = attempt?.done[at] ?? false;
      return h(
        "li",
        { class: isDone ? "mission-done" : "" },
        h("span", { class: "mission-box" }, ...(isDone ? [icon("check", { small: true })] : [])),
        h("span", {}, ...facts.map((fact) => h("span", { class: "mission-fact" }, factText(mission, this.context.language, fact), ...(isDone ? [] : this.#value(attempt, fact))))),
        h("span", { class: "vh" }, t(isDone ? "line.done" : "line.open")),
      );
    });
    return h("div", {}, h("h3", { class: "cap" }, t("checklist")), h("ul", { class: "mission-checklist" }, ...lines));
  }

  /** What the robot has reached of a quantity, beside its goal. @param {Try | null} attempt @param {string} fact */
  #value(attempt, fact) {
    const text = measuredText(attempt, fact, this.context.language);
    return text === "" ? [] : [h("b", { class: "mission-value", "data-fact": fact }, text)];
  }

  /** @param {Mission} mission @param {Try | null} attempt */
  #stars(mission, attempt) {
    const texts = starTexts(mission, this.context.language, this.t);
    return h(
      "ul",
      { class: "mission-star-list", "aria-label": this.t("stars.title") },
      ...texts.map((text, at) => h("li", {}, starRow([attempt?.state === "passed" && (attempt.stars[at] ?? false)], this.t), h("span", {}, text))),
    );
  }

  /** @param {Mission} mission */
  #hintList(mission) {
    const { t } = this;
    const hints = hintsOf(mission, this.context.language);
    const solution = mission.solutions[this.language() ?? ""];
    if (hints.length === 0 && solution === undefined) return [];
    const shown = hints.slice(0, this.#hints);
    const button = h(
      "button",
      {
        type: "button",
        class: "btn soft slim",
        "data-mission-do": "hint",
        onclick: () => {
          this.#hints += 1;
          this.context.announce(hints[this.#hints - 1]);
          this.context.scene.invalidate();
        },
      },
      icon("idea", { small: true }),
      t("hint", { number: this.#hints + 1, all: hints.length }),
    );
    return [
      h(
        "div",
        { class: "mission-hints" },
        h("ol", {}, ...shown.map((hint) => h("li", {}, hint))),
        ...(this.#step === "" ? [] : [h("p", { class: "mission-step note-box" }, this.#step)]),
        h("div", { class: "mission-row" }, ...(this.#hints < hints.length ? [button] : []), ...(solution === undefined ? [] : [this.#stepButton()])),
      ),
    ];
  }

  #stepButton() {
    const { t } = this;
    const show = async () => {
      const next = await this.commands.step();
      this.#step = next === null ? t("showStep.none") : t("showStep.next", { what: next });
      this.context.announce(this.#step);
      this.context.scene.invalidate();
    };
    return h("button", { type: "button", class: "btn line slim", "data-mission-do": "step", onclick: () => void show() }, icon("eye", { small: true }), t("showStep"));
  }

  /** Announce what has changed to screen readers. @param {Mission} mission @param {Try | null} attempt */
  #say(mission, attempt) {
    if (attempt === null) return;
    const { t } = this;
    const done = attempt.done.map((is, at) => (is ? attempt.checklist[at].map((fact) => factText(mission, this.context.language, fact)).join(", ") : ""));
    const words = outcome(mission, attempt, this.context.language, t) || (attempt.trouble ? t(`trouble.${attempt.trouble}`) : "");
    const said = words || done.filter((line) => line !== "").at(-1) || "";
    if (said === this.#said) return;
    this.#said = said;
    if (said !== "") this.context.announce(words || `${t("line.done")}: ${said}`);
  }

  /** Over the view; where the open tab has its place, above the tab. */
  #place() {
    const isInView = this.slot.checkVisibility() || this.context.workspace.tab === null;
    const isThere = this.element.parentElement === this.slot;
    if (isInView === isThere) return;
    if (isInView) this.slot.append(this.element);
    else document.querySelector("#tabs")?.after(this.element);
  }

  /** Fit the playground into what the card leaves free. */
  #leaveFree() {
    const { scene } = this.context;
    const card = this.element.getBoundingClientRect();
    const canvas = scene.canvas.getBoundingClientRect();
    const isOver = this.element.parentElement === this.slot && canvas.height > 0;
    const isBeside = isOver && canvas.width >= WIDE_PX && card.height > canvas.height / 4;
    const left = isBeside ? card.right - canvas.left : 0;
    const top = isOver && !isBeside ? Math.min(card.bottom - canvas.top, COVERED * canvas.height) : 0;
    const { insets } = scene.camera;
    if ((insets.left ?? 0) !== left || (insets.top ?? 0) !== top) scene.setInsets({ ...insets, left, top });
  }
}
