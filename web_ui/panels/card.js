// The frame of a side panel: its heading folds it, and the browser remembers that.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { uploadCause } from "../state/index.js";
import { h } from "./dom.js";

/**
 * @param {string} name      name of the panel, also its CSS class
 * @param {string} title
 * @param {...(Node | string)} content
 */
export function card(name, title, ...content) {
  const key = `card.${name}`;
  const details = h(
    "details",
    { class: `card ${name}`, open: localStore.getItem(key) !== "closed" },
    h("summary", {}, h("h2", {}, title)),
    h("div", { class: "content" }, ...content),
  );
  details.addEventListener("toggle", () => trySetItem(localStore, key, details.open ? "open" : "closed"));
  return details;
}

/**
 * Make an error visible: open its card, or show a notice if editor or creator covers the card.
 *
 * @param {HTMLDetailsElement} element  the card
 * @param {import("../state/store.js").Store} store
 * @param {string} text
 * @param {import("../state/index.js").UploadKind} what
 */
export function showRefusal(element, store, text, what) {
  element.open = true;
  const cause = uploadCause(what);
  if (element.offsetParent === null) store.dispatch({ type: "notice", level: "error", text, cause });
}
