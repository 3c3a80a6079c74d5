// The playgrounds that were built on this device: a click puts one on the desk, the pen goes on building, the bin removes
// it; until the list changes again it can be brought back.

import { fileNameOf } from "../playground/document.js";
import { playgroundOfDraft } from "../playground/draft_text.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, lock } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";
import { icon } from "../ui/icons.js";
import { card } from "./card.js";

/** @typedef {import("./drafts.js").Draft} Draft */

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function ownPanel({ text, actions, thumbnails, creator, announce }) {
  const t = text("playground");
  const pageText = text("page");
  const { drafts } = creator;
  const list = h("ul", { class: "samples" });
  const element = h("section", { class: "own browse" }, h("h2", {}, t("own")), list);
  /** @type {HTMLButtonElement[]} */ let buttons = [];
  let shown = -1;

  /** @param {string} id */
  const read = (id) => playgroundOfDraft(drafts.read(id) ?? "");
  /** @param {Draft} draft */
  const draftCard = (draft) => {
    const { id, title } = draft;
    const { element: item, button } = card({
      t,
      title,
      description: "",
      attributes: { "data-own": id },
      sample: () => thumbnails.draw(read(id)),
      choose: () => void actions.loadPlayground(fileNameOf(title), new TextEncoder().encode(read(id))),
      buttons: [
        {
          name: "go-on",
          label: t("own.editOf", { title }),
          help: t("own.edit"),
          drawing: "pen",
          act: () => void creator.openDraft(draft),
        },
        {
          name: "remove",
          label: t("own.remove", { title }),
          help: t("own.remove", { title }),
          drawing: "remove",
          act: () => remove(item, draft),
        },
      ],
    });
    buttons.push(button);
    return item;
  };
  /** @param {HTMLElement} item @param {Draft} draft */
  const remove = (item, draft) => {
    const content = drafts.read(draft.id);
    drafts.remove(draft.id);
    shown = drafts.version; // the list stays, with a way back
    const words = t("own.removed", { title: draft.title });
    const back = h("button", { type: "button", class: "btn line" }, icon("undo", { small: true }), t("own.restore"));
    back.addEventListener("click", () => drafts.keep({ ...draft, text: content ?? "" }));
    item.replaceChildren(h("div", { class: "removed" }, h("p", { class: "small" }, words), back));
    announce(words);
    back.focus();
  };

  return {
    slot: "playground",
    element,
    render(state) {
      if (creator.isOpen) return;
      if (shown !== drafts.version) {
        shown = drafts.version;
        buttons = [];
        const all = drafts.list();
        keepFocus(
          list,
          () => list.replaceChildren(...all.map(draftCard)),
          () => list.querySelector("button"),
        );
        element.hidden = all.length === 0;
      }
      const reason = disabledReason(state, pageText);
      for (const button of buttons) lock(button, reason);
    },
  };
}
