// The ready-made playgrounds: a click puts one on the desk, the pen opens a copy in the creator.

import { disabledReason } from "../state/disabled_reason.js";
import { h, lock, setAttribute } from "../ui/dom.js";
import { card } from "./card.js";

/** @typedef {import("../state/index.js").PlaygroundInfo} PlaygroundInfo */

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function galleryPanel({ text, language, actions, thumbnails, creator }) {
  const t = text("playground");
  const pageText = text("page");
  const list = h("ul", { class: "samples" });
  const element = h("section", { class: "gallery browse", id: "gallery" }, h("h2", {}, t("gallery")), list);
  /** @type {{ name: string, button: HTMLButtonElement }[]} */ let cards = [];
  let listed = "";

  /** @param {PlaygroundInfo} info */
  const sampleCard = (info) => {
    const { title, description } = translated(info, language);
    const edit = async () => {
      const sample = await thumbnails.sample(info.name);
      if (sample !== null) void creator.open({ ...sample.playground, title, description, translations: {} });
    };
    const label = t("edit.of", { title });
    const { element: item, button } = card({
      t,
      title,
      description,
      attributes: { "data-playground": info.name },
      sample: () => thumbnails.sample(info.name),
      choose: () => void actions.loadPlayground(info.name),
      buttons: [{ name: "change", label, help: t("edit"), drawing: "pen", act: () => void edit() }],
    });
    cards.push({ name: info.name, button });
    return item;
  };

  return {
    slot: "playground",
    element,
    render(state) {
      if (creator.isOpen) return;
      const { playgrounds, simulator } = state;
      const now = JSON.stringify(playgrounds);
      if (now !== listed) {
        listed = now;
        cards = [];
        list.replaceChildren(...playgrounds.map(sampleCard));
        element.hidden = playgrounds.length === 0;
      }
      const reason = disabledReason(state, pageText);
      for (const { name, button } of cards) {
        setAttribute(button, "aria-current", String(name === simulator?.playground));
        lock(button, reason);
      }
    },
  };
}

/** Title and description in a language, else in English. @param {PlaygroundInfo} info @param {string} language */
export function translated(info, language) {
  return info.translations[language] ?? info;
}
