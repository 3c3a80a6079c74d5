// The frame of a side panel: a heading that folds it, remembered by the browser.

import { memory, note } from "../memory.js";
import { h } from "./dom.js";

/**
 * @param {string} name      of the panel, also its class
 * @param {string} title
 * @param {...(Node | string)} content
 */
export function card(name, title, ...content) {
  const key = `card.${name}`;
  const details = h(
    "details",
    { class: `card ${name}`, open: memory.getItem(key) !== "closed" },
    h("summary", {}, h("h2", {}, title)),
    h("div", { class: "content" }, ...content),
  );
  details.addEventListener("toggle", () => note(memory, key, details.open ? "open" : "closed"));
  return details;
}
