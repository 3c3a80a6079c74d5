// The card of a pupil: the robot from above, what it does, and what the teacher can do about it.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { drawPlan } from "./plan.js";
import { pupilState, slowPercent } from "./pupil_state.js";

/** @typedef {import("./api.js").Pupil} Pupil */
/** @typedef {import("./pupil_state.js").PupilState} PupilState */
/** @typedef {import("../ui/icons.js").IconName} IconName */
/**
 * @typedef {object} CardActions   each gets the pupil as shown
 * @property {(pupil: Pupil) => void} pause
 * @property {(pupil: Pupil) => void} message
 * @property {(pupil: Pupil) => void} present
 * @property {(pupil: Pupil) => void} restart
 * @property {(pupil: Pupil) => void} lower
 */

/** @type {Readonly<Record<PupilState, [string, IconName | null]>>}  class of the chip, icon */
const LOOKS = {
  runs: ["run", "check"],
  stopped: ["", "stop"],
  halted: ["wait", "halt"],
  mistake: ["stop", "warning"],
  fell: ["stop", "warning"],
  idle: ["", null],
  paused: ["wait", "pause"],
  held: ["wait", "pause"],
  waiting: ["", null],
  starting: ["wait", "reset"],
  broken: ["stop", "warning"],
};

export class PupilCard {
  /** @param {Pupil} pupil @param {import("../i18n/index.js").Translate} t @param {CardActions} actions */
  constructor(pupil, t, actions) {
    this.t = t;
    this.pupil = pupil;
    this.canvas = h("canvas", { role: "img", "aria-label": t("plan", { name: pupil.name }) });
    this.chip = h("span", { class: "chip" });
    this.detail = h("p", { class: "small muted" });
    this.hand = h(
      "button",
      { type: "button", class: "btn soft pupil-hand", "data-verb": "lower", hidden: true, title: t("lower"), "aria-label": `${t("lower")}: ${pupil.name}`, onclick: () => actions.lower(this.pupil) },
      icon("hand"),
      h("span", {}, t("hand")),
    );
    this.notice = h("p", { class: "small pupil-notice", hidden: true });
    this.state = "";
    const button = (/** @type {keyof CardActions} */ verb, /** @type {IconName} */ symbol) =>
      h(
        "button",
        { type: "button", class: "btn icon", "data-verb": verb, title: t(verb), "aria-label": `${t(verb)}: ${pupil.name}`, onclick: () => actions[verb](this.pupil) },
        icon(symbol),
      );
    this.pauseButton = button("pause", "pause");
    this.open = h(
      "a",
      { class: "btn icon", "data-verb": "open", target: "_blank", rel: "noreferrer", title: t("open"), "aria-label": `${t("open")}: ${pupil.name}` },
      icon("eye"),
    );
    this.element = h(
      "li",
      { class: "card pupil", "data-pupil": pupil.id },
      this.canvas,
      h("div", { class: "row" }, h("h2", { class: "grow pupil-name", title: pupil.name }, pupil.name), this.chip),
      this.hand,
      this.detail,
      this.notice,
      h("div", { class: "row pupil-actions" }, this.pauseButton, button("message", "message"), button("present", "screen"), this.open, button("restart", "reset")),
    );
  }

  /** @param {Pupil} pupil @param {import("./plan.js").Plan | undefined} plan */
  show(pupil, plan) {
    this.pupil = pupil;
    const { t } = this;
    const state = pupilState(pupil);
    if (state !== this.state) {
      this.state = state;
      const [look, symbol] = LOOKS[state];
      this.chip.className = `chip ${look}`;
      this.chip.replaceChildren(...(symbol === null ? [] : [icon(symbol, { small: true })]), t(`state.${state}`));
      setAttribute(this.element, "data-state", state);
    }
    const details = detailsOf(pupil, t);
    setText(this.detail, details);
    setAttribute(this.detail, "title", details);
    this.hand.hidden = pupil.hand === "";
    this.notice.hidden = pupil.notice === "";
    setText(this.notice, pupil.notice);
    const verb = pupil.paused ? "run" : "pause";
    if (this.pauseButton.dataset.verb !== verb || this.pauseButton.childElementCount === 0) {
      this.pauseButton.dataset.verb = verb;
      this.pauseButton.replaceChildren(icon(verb));
      setAttribute(this.pauseButton, "title", t(verb));
      setAttribute(this.pauseButton, "aria-label", `${t(verb)}: ${pupil.name}`);
    }
    setAttribute(this.open, "href", pupil.link);
    if (plan !== undefined) drawPlan(this.canvas, plan, pupil.overview);
  }
}

/** Program with line, or why the simulator does not run. @param {Pupil} pupil @param {import("../i18n/index.js").Translate} t */
function detailsOf(pupil, t) {
  const { phase, reason, restarts, programs } = pupil;
  if (phase === "broken") return t("restarts", { count: restarts, reason });
  const slow = slowPercent(pupil);
  const parts = programs.map(({ program, line, fault }) =>
    [program, line === "" ? "" : t("line", { line }), fault].filter((part) => part !== "").join(", "),
  );
  if (["stuck", "idle", "tries"].includes(pupil.trouble)) parts.unshift(t(`trouble.${pupil.trouble}`));
  if (slow !== null) parts.push(t("slow", { percent: slow }));
  if (reason !== "") parts.push(t("restarts", { count: restarts, reason }));
  return parts.join(" · ");
}
