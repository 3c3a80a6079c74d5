// Sharing a program, a playground or a mission by a link that holds it, and opening such links: beside what the user has.
// The dialogs are loaded on demand.

import { textOf } from "../browser/text_file.js";
import { translator } from "../i18n/index.js";
import { languageOf } from "../program_tab/language_choice.js";
import { HANDOUT, isShipped, LinkError, packed, PARAMETER, sharedPart, unpacked } from "../sharing/link.js";
import { CONNECTION } from "../state/index.js";
import { PARAMETERS } from "../state/names.js";
import { LANGUAGES } from "./program_host.js";

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../sharing/link.js").Item} Item */
/** @typedef {import("../sharing/index.js").Description} Description */
/** @typedef {{ dialogs: typeof import("../sharing/index.js"), t: import("../i18n/index.js").Translate, languageName: (id: string) => string }} Loaded */

const LOCAL = /^(?:localhost|127\.\d+\.\d+\.\d+|\[::1\])$/;

/**
 * The address that others open with a link: that of this page, for pupils of a class that of the class, where each of them
 * chooses a name. Without token, query and fragment.
 *
 * @param {string} address  of this page
 * @param {boolean} isOfPupil
 */
export function sharedAddress(address, isOfPupil) {
  const { href } = new URL(isOfPupil ? "../../" : ".", address.split(/[?#]/)[0]);
  return href;
}

/** The address without what it shares. @param {string} address */
export function withoutShared(address) {
  const [place, fragment = ""] = address.split("#");
  const rest = fragment.split("&").filter((part) => part !== "" && ![PARAMETER, HANDOUT].includes(part.split("=")[0]));
  return rest.length === 0 ? place : `${place}#${rest.join("&")}`;
}

export class ShareHost {
  /** @type {Context | null} */ #context = null;
  #token = "";

  /** @param {{ token: string }} options  of the pupil in a class: it opens what the teacher has handed out */
  constructor({ token }) {
    this.#token = token;
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.#context = context;
  }

  /** Call once, when the page is ready: opens what the address has, now or later. */
  start() {
    const look = () => {
      const part = sharedPart(location.hash);
      const handout = sharedPart(location.hash, HANDOUT);
      if (part !== null) void this.#openPart(part);
      else if (handout !== null) void this.openHandout(handout);
    };
    window.addEventListener("hashchange", look);
    look();
  }

  /** Share a program. @param {string} name @param {string} text */
  shareProgram(name, text) {
    return this.#share({ kind: "program", name, content: new TextEncoder().encode(text) });
  }

  /** Share a playground. @param {string} name  of its file @param {string} text */
  sharePlayground(name, text) {
    return this.#share({ kind: "playground", name, content: new TextEncoder().encode(text) });
  }

  /** Share a mission. @param {string} name  of its file @param {Uint8Array<ArrayBuffer>} content */
  shareMission(name, content) {
    return this.#share({ kind: "mission", name, content });
  }

  /** Ask for a link. @param {string} [trouble]  why the last one was refused */
  async openField(trouble = "") {
    const loaded = await this.#load();
    loaded?.dialogs.openField({ t: loaded.t, trouble, open: (text) => void this.#openText(text) });
  }

  /** Open what the teacher of the class has handed out. @param {string} id */
  async openHandout(id) {
    const { store, text } = /** @type {Context} */ (this.#context);
    const pageText = text("page");
    /** @param {string} reason */
    const report = (reason) => {
      store.dispatch({ type: "notice", level: "error", text: pageText("handout.gone", { reason }), cause: HANDOUT });
      forgetShared();
    };
    try {
      const headers = { Authorization: `Bearer ${this.#token}` };
      const answer = await fetch(`class/handouts/${encodeURIComponent(id)}`, { headers });
      if (!answer.ok) return report(await answer.text());
      store.dispatch({ type: "solved", cause: HANDOUT });
      const { kind, name, content } = await answer.json();
      const bytes = Uint8Array.from(atob(content), (letter) => letter.charCodeAt(0));
      await this.offer({ kind, name, content: bytes }, pageText("handouts"));
    } catch {
      report(pageText("app.notLoaded"));
    }
  }

  /** Let the user decide about an item; own work stays. @param {Item} item @param {string} [heading] */
  async offer(item, heading) {
    const loaded = await this.#load();
    if (loaded === null) return;
    const { dialogs, t } = loaded;
    const text = await textOf(new File([item.content], item.name));
    if (text === null && item.kind === "program") return this.openField(t("bad.damaged"));
    dialogs.openReceived({
      t,
      item,
      heading: heading ?? t(`received.${item.kind}`),
      about: describe(item, text, loaded),
      open: () => this.#open(item, text),
      decided: forgetShared,
    });
  }

  /** @param {Item} item */
  async #share(item) {
    const loaded = await this.#load();
    if (loaded === null || this.#context === null) return;
    const { parameters } = this.#context.store.state;
    const place = sharedAddress(location.href, Boolean(parameters[PARAMETERS.pupil]));
    const address = `${place}#${PARAMETER}=${await packed(item)}`;
    const about = describe(item, await textOf(new File([item.content], item.name)), loaded);
    loaded.dialogs.openShare({ t: loaded.t, item, about, address, isLocal: LOCAL.test(location.hostname) });
  }

  /** @param {string} text  with a link */
  async #openText(text) {
    const part = sharedPart(text);
    if (part !== null) return this.#openPart(part);
    const loaded = await this.#load();
    if (loaded !== null) await this.openField(loaded.t("bad.link"));
  }

  /** @param {string} part */
  async #openPart(part) {
    try {
      await this.offer(await unpacked(part));
    } catch (error) {
      if (!(error instanceof LinkError)) throw error;
      forgetShared();
      const loaded = await this.#load();
      if (loaded !== null) await this.openField(loaded.t(error.key, error.values));
    }
  }

  /** @param {Item} item @param {string | null} text  null: an archive */
  async #open({ kind, name, content }, text) {
    const { program, creator, mission, actions, workspace } = /** @type {Context} */ (this.#context);
    if (kind === "program") return program.openBeside(name, text ?? "");
    if (kind === "mission") return isShipped({ content }) ? mission.start(name) : mission.openFile(new File([content], name));
    workspace.select("playground");
    creator.keepCopy(text ?? "");
    return actions.loadPlayground(name, content);
  }

  /** @returns {Promise<Loaded | null>} */
  async #load() {
    const { language, store, text } = /** @type {Context} */ (this.#context);
    try {
      const [dialogs, { default: texts }, { default: editorTexts }] = await Promise.all([
        import("../sharing/index.js"),
        import("../i18n/sharing.texts.js"),
        import("../i18n/editor.texts.js"),
      ]);
      const editorText = translator(language, editorTexts);
      return { dialogs, t: translator(language, texts), languageName: (id) => editorText(`language.${id}`) };
    } catch {
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
      return null;
    }
  }
}

/** Remove what the address shares, so that a reload does not open it again. */
function forgetShared() {
  history.replaceState(history.state, "", withoutShared(location.href));
}

/** @param {Item} item @param {string | null} text @param {Loaded} loaded @returns {Description} */
function describe({ kind, name }, text, { t, languageName }) {
  if (kind === "program") {
    const lines = (text ?? "").trim().split("\n").length;
    return { title: name, meta: t("meta.program", { language: languageName(languageOf({ name, text: text ?? "" }, LANGUAGES)), lines }) };
  }
  return { title: titleIn(text ?? "") || name, meta: t(`meta.${kind}`) };
}

/** The title in a JSON file; "" for none. @param {string} text */
function titleIn(text) {
  try {
    const { title } = JSON.parse(text);
    return typeof title === "string" ? title.slice(0, 200) : "";
  } catch {
    return "";
  }
}
