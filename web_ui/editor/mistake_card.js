// The card of a mistake: a block below its line in the text. It moves with the text, and keeps its element as long as
// the mistake is the same.

import { StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, WidgetType } from "@codemirror/view";

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("./mistakes.js").Mistake} Mistake */
/** @typedef {{ from: number, mistake: Mistake }} Placed   from: a position in the line of the mistake */
/** @typedef {{ t: import("../i18n/index.js").Translate, correct: () => void }} CardOptions */

/** @type {import("@codemirror/state").StateEffectType<Placed | null>} */
const setCard = StateEffect.define();

class CardWidget extends WidgetType {
  /** @param {Mistake} mistake @param {CardOptions} options */
  constructor(mistake, options) {
    super();
    this.mistake = mistake;
    this.options = options;
    this.key = JSON.stringify(mistake);
  }

  /** @override @param {CardWidget} other */
  eq(other) {
    return other.key === this.key;
  }

  /** @override */
  toDOM() {
    return h("div", { class: "mistake-place" }, cardOf(this.mistake, this.options));
  }

  /** @override Keys and clicks are for the buttons, not for the text. */
  ignoreEvent() {
    return true;
  }

  /** @override */
  get estimatedHeight() {
    return 170;
  }
}

/** @param {Mistake} mistake @param {CardOptions} options */
function cardOf({ title, text, more, change, button }, { t, correct }) {
  const details = h("p", { class: "mistake-more small", hidden: true }, more);
  const show = h(
    "button",
    {
      type: "button",
      class: "btn",
      "aria-expanded": "false",
      onclick: () => {
        details.hidden = !details.hidden;
        show.ariaExpanded = String(!details.hidden);
        show.textContent = t(details.hidden ? "mistakes.more" : "mistakes.less");
      },
    },
    t("mistakes.more"),
  );
  const correction = h(
    "button",
    { type: "button", class: "btn you correct", title: t("hint.key"), onclick: correct },
    icon("check", { small: true }),
    h("span", {}, button),
  );
  const fix = (/** @type {NonNullable<Mistake["change"]>} */ { before, old, now, after }) => [
    h(
      "p",
      { class: "mistake-fix" },
      h(
        "code",
        {},
        before,
        ...(old === "" ? [] : [h("del", {}, old), now === "" ? "" : " "]),
        ...(now === "" ? [] : [h("ins", {}, now)]),
        after,
      ),
    ),
  ];
  const buttons = [...(button === "" ? [] : [correction]), ...(more === "" ? [] : [show])];
  return h(
    "div",
    { class: "mistake-card", role: "group", "aria-label": title, contenteditable: "false" },
    h(
      "div",
      { class: "mistake-words" },
      icon("idea"),
      h("div", {}, h("h3", {}, title), ...(text === "" ? [] : [h("p", { class: "small muted" }, text)])),
    ),
    ...(change === null ? [] : fix(change)),
    ...(buttons.length === 0 ? [] : [h("div", { class: "mistake-buttons" }, ...buttons)]),
    details,
  );
}

/** The extension for the card. @param {CardOptions} options */
export function mistakeCard(options) {
  return StateField.define({
    /** @returns {import("@codemirror/view").DecorationSet} */
    create: () => Decoration.none,
    update(cards, transaction) {
      let now = cards.map(transaction.changes);
      for (const effect of transaction.effects) {
        if (!effect.is(setCard)) continue;
        const card = effect.value;
        if (card === null) now = Decoration.none;
        else {
          const { doc } = transaction.state;
          const { to } = doc.lineAt(Math.min(card.from, doc.length));
          const widget = new CardWidget(card.mistake, options);
          now = Decoration.set([Decoration.widget({ widget, block: true, side: 1 }).range(to)]);
        }
      }
      return now;
    },
    provide: (field) => EditorView.decorations.from(field),
  });
}

/** @param {EditorView} view @param {Placed | null} card  null: none */
export function showCard(view, card) {
  view.dispatch({ effects: setCard.of(card) });
}
