// The choice of language.

import { LANGUAGES } from "../i18n/index.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @param {import("../shell/context.js").Context} context */
export function languageChoice({ text, language, setLanguage }) {
  const select = h("select", { "aria-label": text("page")("app.language"), class: "language select quiet", id: "language" });
  for (const [code, name] of Object.entries(LANGUAGES)) select.append(h("option", { value: code, lang: code }, name));
  select.value = language;
  select.addEventListener("change", () => setLanguage(select.value));
  return h("span", { class: "with-icon" }, icon("globe"), select);
}
