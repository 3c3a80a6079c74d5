// The choice of language.

import { LANGUAGES } from "../i18n/index.js";
import { h } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function languagePanel({ t, language, setLanguage }) {
  const select = h("select", { "aria-label": t("app.language"), class: "language" });
  for (const [code, name] of Object.entries(LANGUAGES)) select.append(h("option", { value: code, lang: code }, name));
  select.value = language;
  select.addEventListener("change", () => setLanguage(select.value));
  return { slot: "header", element: select };
}
