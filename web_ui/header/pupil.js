// Whose page this is in a class (docs/classroom.md): in the header, and in the title, which names the tab of the browser.
// The name opens a sheet with what the teacher has handed out, and a button that raises a hand.

import { disabledReason } from "../state/disabled_reason.js";
import { readHandouts } from "../state/handouts.js";
import { PARAMETERS } from "../state/names.js";
import { h, lock, renew, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";

/** @typedef {import("../state/handouts.js").Handout} Handout */

const ICONS = /** @type {const} */ ({ program: "program", playground: "playground", mission: "check" });

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function pupilPanel({ text, language, actions, share, announce }) {
  const t = text("page");
  const name = h("span", { class: "name" });
  const fresh = h("span", { class: "pupil-new num", hidden: true });
  const button = h("button", { type: "button", id: "pupil", class: "chip" }, icon("class", { small: true }), name, fresh);
  const hand = h(
    "button",
    { type: "button", class: "btn line", id: "raise-hand", "aria-pressed": "false", onclick: () => void actions.raiseHand(!isRaised) },
    icon("hand"),
    h("span", {}, t("hand.raise")),
  );
  const list = h("ul", { class: "pupil-handouts" });
  const sheet = h(
    "div",
    { id: "pupil-sheet", class: "pupil-sheet", role: "group", "aria-label": t("handouts") },
    hand,
    h("p", { class: "cap" }, t("handouts")),
    list,
  );
  const element = h("div", { class: "pupil-menu", hidden: true }, button, sheet);
  makeSheet(button, sheet);
  let isRaised = false;
  /** @type {readonly Handout[] | null} */ let shown = null;

  /** @param {Handout} handout */
  const row = (handout) => {
    const { id, kind, stars } = handout;
    const open = () => {
      sheet.hidePopover();
      void share.openHandout(id);
    };
    return h(
      "li",
      {},
      h(
        "button",
        { type: "button", class: "btn", "data-handout": id, onclick: open },
        icon(ICONS[/** @type {keyof typeof ICONS} */ (kind)], { small: true }),
        h("span", { class: "grow" }, h("span", { class: "handout-name" }, handout.name), h("span", { class: "small muted" }, aboutOf(handout))),
        ...(stars > 0 ? [h("span", { class: "num", role: "img", "aria-label": t("handout.stars", { count: stars }) }, "★".repeat(stars))] : []),
      ),
    );
  };
  /** @param {Handout} handout */
  const aboutOf = ({ kind, due, solution_of: solutionOf, opened }) =>
    [
      solutionOf === "" ? t(`handout.${kind}`) : t("handout.solution", { name: solutionOf }),
      due === "" ? "" : t("handout.due", { date: new Date(due).toLocaleString(language, { dateStyle: "medium", timeStyle: "short" }) }),
      opened ? "" : t("handout.new"),
    ]
      .filter((part) => part !== "")
      .join(" · ");

  return {
    slot: "header",
    element,
    render(state) {
      const { parameters } = state;
      const pupil = String(parameters[PARAMETERS.pupil] ?? "");
      const title = pupil === "" ? t("app.title") : t("app.titleOf", { name: pupil });
      if (document.title !== title) document.title = title;
      element.hidden = pupil === "";
      if (pupil === "") return;
      setText(name, pupil);
      const handouts = readHandouts(parameters[PARAMETERS.handouts]);
      const count = handouts.filter(({ opened }) => !opened).length;
      const reason = disabledReason(state, t);
      lock(hand, reason);
      if (parameters[PARAMETERS.raisedHand] === true !== isRaised) {
        isRaised = !isRaised;
        setAttribute(hand, "aria-pressed", String(isRaised));
        setText(/** @type {Element} */ (hand.lastElementChild), t(isRaised ? "hand.lower" : "hand.raise"));
        setAttribute(button, "data-hand", String(isRaised));
        announce(t(isRaised ? "hand.raised" : "hand.lowered"));
      }
      fresh.hidden = count === 0;
      setText(fresh, String(count));
      const about = [t("app.pupil", { name: pupil }), isRaised ? t("hand.raised") : "", count === 0 ? "" : t("handouts.new", { count })];
      setAttribute(button, "title", about.filter((part) => part !== "").join(" "));
      if (handouts === shown) return;
      shown = handouts;
      renew(list, handouts.length === 0 ? [h("li", { class: "small muted" }, t("handouts.none"))] : handouts.map(row));
    },
  };
}
