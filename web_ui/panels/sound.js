// The sound button. Browsers block sound until the first click or key; until then the button says so.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { h, icon, ICONS, setAttribute, setText } from "./dom.js";

/** Storage key of the muted state. */
export const MUTED_KEY = "muted";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function soundPanel({ t, speaker, announce }) {
  const symbol = h("span", { class: "symbol" });
  const word = h("span", { class: "word" });
  const element = h("button", { type: "button", class: "sound" }, symbol, word);
  element.addEventListener("click", () => {
    // The first click anywhere enables sound; on this button it does the same and does not mute.
    const muted = shown === "on";
    trySetItem(localStore, MUTED_KEY, String(muted));
    speaker.setMuted(muted);
    announce(t(`sound.${speaker.phase}`));
  });
  /** @type {string} */ let shown = "";
  return {
    slot: "header",
    element,
    render() {
      const { phase } = speaker;
      if (phase === shown) return;
      shown = phase;
      symbol.replaceChildren(icon(phase === "on" ? ICONS.loud : ICONS.mute));
      setText(word, t(`sound.${phase}`));
      setAttribute(element, "aria-label", t(`sound.${phase}`));
      setAttribute(element, "title", t(`sound.${phase}Help`));
      setAttribute(element, "data-phase", phase);
      element.disabled = phase === "unavailable";
    },
  };
}
