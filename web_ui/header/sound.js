// The sound button. Browsers block sound until the first click or key; until then the button says so.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** Storage key of the muted state. */
export const MUTED_KEY = "muted";

/** @param {import("../shell/context.js").Context} context */
export function soundButton({ text, speaker, announce }) {
  const t = text("page");
  const symbol = h("span", { class: "symbol" });
  const word = h("span", { class: "word" });
  const element = h("button", { type: "button", class: "btn slim sound", id: "sound" }, symbol, word);
  element.addEventListener("click", () => {
    // The first click anywhere enables sound; on this button it does the same and does not mute.
    const muted = shown === "on";
    trySetItem(localStore, MUTED_KEY, String(muted));
    speaker.setMuted(muted);
    announce(t(`sound.${speaker.phase}`));
  });
  /** @type {string} */ let shown = "";
  return {
    element,
    render() {
      const { phase } = speaker;
      if (phase === shown) return;
      shown = phase;
      symbol.replaceChildren(icon(phase === "on" ? "sound" : "muted"));
      setText(word, t(`sound.${phase}`));
      setAttribute(element, "aria-label", t(`sound.${phase}`));
      setAttribute(element, "title", t(`sound.${phase}Help`));
      setAttribute(element, "data-phase", phase);
      element.disabled = phase === "unavailable";
    },
  };
}
