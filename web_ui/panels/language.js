// The choice of language.

import { LANGUAGES } from "../i18n/index.js";
import { h } from "./dom.js";

const NAMES = /** @type {Record<string, string>} */ ({ en: "English", de: "Deutsch", fr: "Français", it: "Italiano" });

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function languagePanel({ t, language, setLanguage }) {
  const select = h("select", { "aria-label": t("app.language"), class: "language" });
  for (const code of Object.keys(LANGUAGES)) select.append(h("option", { value: code, lang: code }, NAMES[code]));
  select.value = language;
  select.addEventListener("change", () => setLanguage(select.value));
  return { slot: "header", element: select };
}
