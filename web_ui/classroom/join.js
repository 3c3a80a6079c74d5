// The first page of a class (docs/classroom.md): pupils enter the code of the room, or have it in the link of its QR code,
// and choose their names, which lead to their own pages. In a class with links only there is no code.

import { resolveToken } from "../browser/access_token.js";
import { localStore } from "../browser/local_storage.js";
import { PageLanguage } from "../browser/page_language.js";
import texts from "../i18n/classroom.texts.js";
import { translator } from "../i18n/index.js";
import { HANDOUT, PARAMETER, sharedPart } from "../sharing/link.js";
import { h, setText } from "../ui/dom.js";

/** @typedef {{ name: string, link: string }} Place   `link` is relative to this page */

/** Time until the next request while the class does not answer. */
const RETRY_MS = 2000;

/** What to say about an answer without names; others are no answer of a class. @type {Readonly<Record<number, string>>} */
const REFUSALS = { 401: "join.wrong", 429: "join.wait" };

/** A code as pupils type it: in upper or lower case, with spaces. @param {string} typed */
export function codeOf(typed) {
  return typed.replace(/\s/g, "").toLowerCase();
}

/**
 * Whether a class has a code with which pupils choose their names; null if it does not answer.
 *
 * @returns {Promise<boolean | null>}
 */
export async function hasCode() {
  try {
    const answer = await fetch("room");
    return answer.ok ? (await answer.json()).has_code : null;
  } catch {
    return null;
  }
}

/**
 * The places of a class; in their stead the key of a text that says why there are none.
 *
 * @param {string} code
 * @returns {Promise<Place[] | string>}
 */
export async function placesOf(code) {
  try {
    const answer = await fetch("room/names", { headers: { Authorization: `Bearer ${code}` } });
    return answer.ok ? await answer.json() : (REFUSALS[answer.status] ?? "connection.lost");
  } catch {
    return "connection.lost";
  }
}

class JoinPage {
  /** @param {HTMLElement} main @param {PageLanguage} language */
  constructor(main, language) {
    this.main = main;
    this.t = translator(language.language, texts);
    document.documentElement.lang = language.language;
    document.title = `${this.t("title")} – Thymio Sim`;
    setText(/** @type {HTMLElement} */ (document.getElementById("title")), this.t("title"));
  }

  /** Show the names, or ask for the code. @param {string} code  "": none is known */
  async open(code) {
    if ((await hasCode()) === false) return this.#showLinksOnly();
    const places = code === "" ? "" : await placesOf(code);
    if (typeof places !== "string") return this.#showNames(places);
    this.#askForCode(places);
    if (places === "connection.lost") setTimeout(() => void this.open(code), RETRY_MS);
  }

  #showLinksOnly() {
    this.main.replaceChildren(h("div", { class: "card join-code" }, h("p", {}, this.t("join.links"))));
  }

  /** @param {readonly Place[]} places */
  #showNames(places) {
    // Links of pupils and of the teacher lead here: the page of the chosen name opens what they share.
    const parts = [PARAMETER, HANDOUT].map((key) => [key, sharedPart(location.hash, key)]);
    const shared = parts.map(([key, part]) => (part === null ? "" : `&${key}=${part}`)).join("");
    const names = places.map(({ name, link }) => h("li", {}, h("a", { class: "btn line join-name", href: link + shared }, name)));
    this.main.replaceChildren(h("h2", {}, this.t("join.choose")), h("ul", { class: "join-names" }, ...names));
  }

  /** @param {string} trouble  key of a text, "" for none */
  #askForCode(trouble) {
    const { t } = this;
    const field = h("input", { class: "input", id: "code", autocomplete: "off", autocapitalize: "none", spellcheck: "false" });
    const submit = (/** @type {Event} */ event) => {
      event.preventDefault();
      const code = codeOf(field.value);
      void this.open(resolveToken(localStore, `${location.href.split("#")[0]}#token=${encodeURIComponent(code)}`, () => {}));
    };
    this.main.replaceChildren(
      h(
        "form",
        { class: "card join-code", onsubmit: submit },
        h("label", { for: "code" }, h("h2", {}, t("join.code"))),
        field,
        h("p", { class: "note-box stop", role: "alert", hidden: trouble === "" }, trouble === "" ? "" : t(trouble)),
        h("button", { type: "submit", class: "btn you", "data-verb": "enter" }, t("join.enter")),
      ),
    );
    field.focus();
  }
}

if (globalThis.document !== undefined) {
  const main = /** @type {HTMLElement} */ (document.getElementById("main"));
  const code = resolveToken(localStore, location.href, (shown) => history.replaceState(null, "", shown));
  void new JoinPage(main, new PageLanguage(navigator.languages)).open(code);
}
