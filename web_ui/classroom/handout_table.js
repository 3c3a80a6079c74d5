// What was handed out, and how far each pupil is: a table with a column for each hand-out.

import { h, renew } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { qrImages } from "./sheet.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {{ opened: string, changed: string, tries: number, stars: number, passed: string, best_s: number, late: boolean }} Progress */
/**
 * @typedef {object} Handout
 * @property {string} id
 * @property {"program" | "playground" | "mission"} kind
 * @property {string} name
 * @property {string} title   of a shipped mission, else ""
 * @property {string[]} pupils
 * @property {string} due
 * @property {string} solution_of
 * @property {Record<string, Progress>} progress   by pupil
 */
/**
 * @typedef {object} TableActions
 * @property {() => void} back
 * @property {() => void} give
 * @property {() => void} results
 * @property {(handout: Handout) => void} link
 * @property {(handout: Handout) => void} solution
 * @property {(handout: Handout) => void} takeBack
 */

/**
 * How far a pupil is, in a few words. Pure.
 *
 * @param {Handout} handout
 * @param {Progress | undefined} progress   undefined: the pupil does not have it
 * @param {Translate} t
 * @param {(time: string) => string} clock
 */
export function progressText({ kind }, progress, t, clock) {
  if (progress === undefined) return "–";
  const { opened, changed, tries, stars, best_s: best, late } = progress;
  if (opened === "") return t("progress.unopened");
  const parts = [];
  if (stars > 0) parts.push("★".repeat(stars), t("progress.time", { seconds: best.toFixed(1) }));
  if (tries > 0) parts.push(t(kind === "mission" ? "progress.tries" : "progress.runs", { count: tries }));
  parts.push(changed === "" ? t("progress.opened", { time: clock(opened) }) : clock(changed));
  if (late) parts.push(t("progress.late"));
  return parts.join(" · ");
}

export class HandoutTable {
  /** @param {{ t: Translate, language: string, hasLinks: boolean, actions: TableActions }} options   hasLinks: whether pupils can choose their names */
  constructor({ t, language, hasLinks, actions }) {
    this.t = t;
    this.hasLinks = hasLinks;
    this.actions = actions;
    this.shown = "";
    const format = new Intl.DateTimeFormat(language, { dateStyle: "short", timeStyle: "short" });
    this.clock = (/** @type {string} */ time) => format.format(new Date(time));
    this.place = h("div", { class: "handout-table", tabindex: "0", role: "region", "aria-label": t("handouts") });
    const button = (/** @type {string} */ verb, /** @type {import("../ui/icons.js").IconName} */ sign, /** @type {string} */ look, /** @type {() => void} */ act) =>
      h("button", { type: "button", class: `btn ${look}`, "data-verb": verb, onclick: act }, icon(sign), h("span", {}, t(verb)));
    this.element = h(
      "section",
      { "aria-label": t("handouts") },
      h(
        "div",
        { class: "row class-bar" },
        button("back", "undo", "line", actions.back),
        h("span", { class: "grow" }),
        button("results", "save", "line", actions.results),
        button("handout", "give", "you", actions.give),
      ),
      this.place,
    );
  }

  /** @param {readonly Handout[]} handouts @param {readonly { id: string, name: string }[]} pupils */
  show(handouts, pupils) {
    const text = JSON.stringify([handouts, pupils.map(({ id, name }) => [id, name])]);
    if (text === this.shown) return;
    this.shown = text;
    const { t } = this;
    if (handouts.length === 0) return renew(this.place, [h("p", { class: "muted" }, t("handouts.none"))]);
    const newest = [...handouts].reverse();
    const rows = pupils.map(({ id, name }) =>
      h("tr", {}, h("th", { scope: "row" }, name), ...newest.map((handout) => this.#cell(handout, id))),
    );
    const head = h("tr", {}, h("th", { scope: "col" }, t("handouts.pupil")), ...newest.map((handout) => this.#head(handout, handouts)));
    renew(this.place, [h("table", {}, h("thead", {}, head), h("tbody", {}, ...rows))]);
  }

  /** @param {Handout} handout @param {string} pupil */
  #cell(handout, pupil) {
    const progress = handout.progress[pupil];
    const state = progress === undefined ? "none" : progress.late ? "late" : progress.stars > 0 ? "passed" : progress.opened ? "opened" : "new";
    return h("td", { "data-state": state }, progressText(handout, progress, this.t, this.clock));
  }

  /** @param {Handout} handout @param {readonly Handout[]} all */
  #head(handout, all) {
    const { t, actions } = this;
    const { id, kind, name, title, due, solution_of: solutionOf } = handout;
    const task = all.find((each) => each.id === solutionOf);
    const about = [task === undefined ? t(`kind.${kind}`) : t("handout.solution", { name: task.title || task.name }), due === "" ? "" : t("handouts.due", { time: this.clock(due) })];
    const button = (/** @type {string} */ verb, /** @type {import("../ui/icons.js").IconName} */ sign, /** @type {() => void} */ act) =>
      h("button", { type: "button", class: "btn icon", "data-verb": verb, title: t(verb), "aria-label": `${t(verb)}: ${name}`, onclick: act }, icon(sign));
    return h(
      "th",
      { scope: "col", "data-handout": id },
      h("span", { class: "handout-name" }, title || name),
      h("span", { class: "small muted" }, about.filter((part) => part !== "").join(" · ")),
      h(
        "span",
        { class: "row" },
        ...(this.hasLinks ? [button("handoutLink", "link", () => actions.link(handout))] : []),
        ...(solutionOf === "" ? [button("sendSolution", "idea", () => actions.solution(handout))] : []),
        button("takeBack", "remove", () => actions.takeBack(handout)),
      ),
    );
  }
}

/**
 * The content of a dialog with a link to a hand-out.
 *
 * @param {{ name: string, url: string, qr: string }} link
 * @param {Translate} t
 */
export function linkContent({ name, url, qr }, t) {
  return [h("h2", { id: "link-title" }, name), ...qrImages(qr), h("a", { href: url, target: "_blank", rel: "noreferrer" }, url), h("p", { class: "small muted" }, t("handoutLink.help"))];
}
