// The page of the teacher of a class (docs/classroom.md): polls the server of the class and draws a card for each pupil.

import { resolveToken } from "../browser/access_token.js";
import { localStore, tabStore } from "../browser/local_storage.js";
import { PageLanguage } from "../browser/page_language.js";
import { Theme } from "../browser/theme.js";
import { languageChoice } from "../header/language.js";
import { themeSwitch } from "../header/theme_switch.js";
import texts from "../i18n/classroom.texts.js";
import { translator } from "../i18n/index.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { ClassApi, TokenError } from "./api.js";
import { ask, askMessage, present, showContent, showRoom } from "./dialogs.js";
import { askHandOut } from "./hand_out.js";
import { HandoutTable, linkContent } from "./handout_table.js";
import { PupilCard } from "./pupil_card.js";
import { needsHelp } from "./pupil_state.js";
import { sheetOf } from "./sheet.js";

/** @typedef {import("./api.js").Pupil} Pupil */
/** @typedef {import("./plan.js").Plan} Plan */
/** @typedef {import("../ui/icons.js").IconName} IconName */

/** Time between two requests for the state. */
const POLL_MS = 500;
/** The table of hand-outs is larger and changes rarely: it is asked for with every so many requests. */
const TABLE_POLLS = 4;

/** Save a file on the teacher's computer. @param {Blob} content @param {string} name */
function save(content, name) {
  const url = URL.createObjectURL(content);
  h("a", { href: url, download: name }).click();
  URL.revokeObjectURL(url);
}

/** @param {string} id */
function byId(id) {
  return /** @type {HTMLElement} */ (document.getElementById(id));
}

class TeacherPage {
  /** @param {ClassApi} api @param {PageLanguage} language @param {Theme} theme */
  constructor(api, language, theme) {
    this.api = api;
    this.language = language;
    this.theme = theme;
    /** @type {Pupil[]} */ this.pupils = [];
    /** @type {Map<string, Plan>} */ this.plans = new Map();
    /** @type {Set<string>} */ this.asked = new Set();
    /** @type {Map<string, PupilCard>} */ this.cards = new Map();
    /** @type {HandoutTable | null} while it is shown */ this.table = null;
    /** @type {{ id: string, draw: ReturnType<typeof present> } | null} */ this.presented = null;
    this.onlyHelp = false;
    this.hasRoom = false;
    this.t = translator(language.language, texts);
    this.parts = this.#build();
  }

  /** Show the page in another language. @param {string} code */
  setLanguage(code) {
    this.language.choose(code);
    this.t = translator(code, texts);
    this.cards.clear();
    this.table = null;
    this.parts = this.#build();
    this.render();
  }

  /** Create everything in the current language. */
  #build() {
    const { language, t } = this;
    document.documentElement.lang = language.language;
    document.title = `${t("title")} – Thymio Sim`;
    setText(byId("title"), t("title"));
    const scene = { invalidate: () => theming.render() };
    const theming = themeSwitch(/** @type {any} */ ({ text: language.text, theme: this.theme, scene }));
    const setLanguage = (/** @type {string} */ code) => this.setLanguage(code);
    const languages = languageChoice(/** @type {any} */ ({ text: language.text, language: language.language, setLanguage }));
    const count = h("span", { class: "chip run", id: "count" });
    byId("header").replaceChildren(count, h("span", { class: "grow" }), languages, theming.element);
    theming.render();
    const trouble = h("p", { class: "note-box stop", role: "alert", hidden: true });
    const filters = [this.#filter("all", false), this.#filter("help", true)];
    const empty = h("p", { class: "muted", hidden: true }, t("empty"));
    const list = h("ul", { class: "pupils", "aria-label": t("title") });
    const room = this.#button("room", "class", async () => showRoom(await this.api.room(), t));
    const bar = h(
      "div",
      { class: "row class-bar" },
      h("div", { class: "seg", role: "group", "aria-label": t("show") }, ...filters.map(({ button }) => button)),
      h("span", { class: "grow" }),
      this.#button("pauseAll", "pause", () => this.api.pause(null, true)),
      this.#button("runAll", "run", () => this.api.pause(null, false)),
      this.#button("messageAll", "message", () => this.#message(null)),
      this.#button("handouts", "give", () => this.#handouts()),
      this.#button("collect", "save", () => this.#collect()),
      room,
      this.#button("sheet", "list", () => this.#sheet()),
    );
    const missing = h("p", { class: "note-box wait class-missing", role: "status", hidden: true });
    byId("main").replaceChildren(trouble, bar, missing, empty, list);
    return { count, trouble, filters, room, missing, empty, list };
  }

  /** @param {string} name @param {boolean} onlyHelp */
  #filter(name, onlyHelp) {
    const count = h("span", { class: "num muted" });
    const press = () => {
      this.onlyHelp = onlyHelp;
      this.render();
    };
    const button = h("button", { type: "button", class: "btn", "data-filter": name, onclick: press }, this.t(`show.${name}`), count);
    return { onlyHelp, count, button };
  }

  /** Ask for the state for ever. A page in the background does not ask: its browser draws nothing. */
  async poll() {
    for (let count = 0; ; count++) {
      if (!document.hidden) await this.#act(() => this.#refresh());
      if (!document.hidden && this.table !== null && count % TABLE_POLLS === 0) await this.#act(() => this.#fillTable());
      await new Promise((resolve) => setTimeout(resolve, POLL_MS));
    }
  }

  /** Draw what is known. */
  render() {
    const { t, pupils, parts } = this;
    const running = pupils.filter(({ phase }) => phase === "running").length;
    setText(parts.count, `${running} / ${pupils.length}`);
    setAttribute(parts.count, "class", running === pupils.length ? "chip run" : "chip wait");
    for (const { onlyHelp, button, count } of parts.filters) {
      setAttribute(button, "aria-pressed", String(onlyHelp === this.onlyHelp));
      setText(count, String(onlyHelp ? pupils.filter(needsHelp).length : pupils.length));
    }
    const shown = this.onlyHelp ? pupils.filter(needsHelp) : pupils;
    parts.room.hidden = !this.hasRoom;
    parts.empty.hidden = shown.length > 0 || pupils.length === 0;
    const elements = shown.map((pupil) => this.#card(pupil, t).element);
    const { children } = parts.list;
    if (elements.length !== children.length || elements.some((element, at) => element !== children[at])) {
      parts.list.replaceChildren(...elements);
    }
    for (const pupil of shown) this.cards.get(pupil.id)?.show(pupil, this.plans.get(pupil.plan));
    const presented = pupils.find(({ id }) => id === this.presented?.id);
    if (presented !== undefined && !this.presented?.draw(presented, this.plans.get(presented.plan))) this.presented = null;
  }

  /** @param {Pupil} pupil @param {import("../i18n/index.js").Translate} t */
  #card(pupil, t) {
    const known = this.cards.get(pupil.id);
    if (known !== undefined) return known;
    const card = new PupilCard(pupil, t, {
      pause: ({ id, paused }) => void this.#act(() => this.api.pause([id], !paused)),
      message: (one) => this.#message(one),
      present: (one) => {
        const offer = (/** @type {boolean} */ isOffered) => void this.#act(() => this.api.show(isOffered ? one.id : null));
        this.presented = { id: one.id, draw: present({ pupil: one, t, offer }) };
        this.render();
      },
      lower: ({ id }) => void this.#act(() => this.api.lowerHands([id])),
      restart: ({ id, name }) =>
        ask({ question: t("restart.ask", { name }), verb: t("restart"), t, act: () => void this.#act(() => this.api.restart([id])) }),
    });
    this.cards.set(pupil.id, card);
    return card;
  }

  /** @param {Pupil | null} pupil  null: all */
  #message(pupil) {
    const { t } = this;
    const title = pupil === null ? t("message.toAll") : t("message.to", { name: pupil.name });
    const send = (/** @type {string} */ text) =>
      void this.#act(async () => {
        await this.api.message(pupil === null ? null : [pupil.id], text);
        setText(byId("live"), t("sent"));
      });
    askMessage({ title, text: pupil?.notice ?? "", t, send });
  }

  async #collect() {
    const { t } = this;
    const [programs, names] = await Promise.all([this.api.programs(), this.api.missing()]);
    const text = names.length === 0 ? t("collected") : t("collected.missing", { names: names.join(", ") });
    this.parts.missing.hidden = false;
    setText(this.parts.missing, text);
    save(programs, "programs.zip");
  }

  async #sheet() {
    const links = await this.api.sheet();
    this.#replaceMain((back) => sheetOf(links, this.t, back));
  }

  /** Show something in place of the class until it calls `back`. @param {(back: () => void) => HTMLElement} create */
  #replaceMain(create) {
    const main = byId("main");
    const before = [...main.children];
    main.replaceChildren(create(() => main.replaceChildren(...before)));
  }

  /** Show what was handed out. */
  async #handouts() {
    const { t, api } = this;
    /** @param {import("./handout_table.js").Handout | null} task */
    const give = async (task) => {
      const missions = await api.missions(this.pupils[0]?.id ?? "");
      const send = async (/** @type {import("./hand_out.js").Given} */ given) => {
        await api.handOut(given);
        await this.#fillTable();
        setText(byId("live"), t("handout.given"));
      };
      askHandOut({ t, language: this.language.language, pupils: this.pupils, missions, task, send });
    };
    this.#replaceMain((back) => {
      const leave = () => {
        this.table = null;
        back();
      };
      /** @param {import("./handout_table.js").Handout} handout */
      const takeBack = ({ id, name, title }) =>
        ask({ question: t("takeBack.ask", { name: title || name }), verb: t("takeBack"), t, act: () => void this.#act(() => api.takeBack(id)) });
      this.table = new HandoutTable({
        t,
        language: this.language.language,
        hasLinks: this.hasRoom,
        actions: {
          back: leave,
          give: () => void this.#act(() => give(null)),
          results: () => void this.#act(async () => save(await api.results(), "results.csv")),
          link: ({ id }) => void this.#act(async () => showContent(linkContent(await api.handoutLink(id), t), "link-title", t)),
          solution: (task) => void this.#act(() => give(task)),
          takeBack,
        },
      });
      return this.table.element;
    });
    await this.#fillTable();
  }

  async #fillTable() {
    const handouts = await this.api.handouts();
    this.table?.show(handouts, this.pupils);
  }

  async #refresh() {
    const { pupils, has_room } = await this.api.state();
    const raised = pupils.filter(({ id, hand }) => hand !== "" && !this.pupils.some((known) => known.id === id && known.hand === hand));
    if (raised.length > 0) setText(byId("live"), raised.map(({ name }) => this.t("hand.of", { name })).join(" "));
    this.pupils = pupils;
    this.hasRoom = has_room;
    for (const { plan } of pupils) if (!this.asked.has(plan)) void this.#loadPlan(plan);
    this.render();
  }

  /** @param {string} plan */
  async #loadPlan(plan) {
    this.asked.add(plan);
    const found = await this.api.plan(plan).catch(() => null);
    if (found !== null) this.plans.set(plan, found);
  }

  /** Do something that needs the server; say what is wrong if it does not answer. @param {() => Promise<unknown>} action */
  async #act(action) {
    try {
      await action();
      this.parts.trouble.hidden = true;
    } catch (error) {
      this.parts.trouble.hidden = false;
      setText(this.parts.trouble, this.t(error instanceof TokenError ? "connection.token" : "connection.lost"));
    }
  }

  /** @param {string} name @param {IconName} symbol @param {() => unknown} act */
  #button(name, symbol, act) {
    const press = () => void this.#act(async () => act());
    return h("button", { type: "button", class: "btn line", "data-verb": name, onclick: press }, icon(symbol), h("span", {}, this.t(name)));
  }
}

const token = resolveToken(tabStore, location.href, (shown) => history.replaceState(null, "", shown));
const root = document.documentElement;
const theme = new Theme({ storage: localStore, systemIsDark: matchMedia("(prefers-color-scheme: dark)"), root });
void new TeacherPage(new ClassApi(token), new PageLanguage(navigator.languages), theme).poll();
