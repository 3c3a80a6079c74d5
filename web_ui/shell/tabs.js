// The tabs of the workspace. While it is closed they are a rail: icon above name.

import { h, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { firstThatFits } from "../ui/names_fit.js";
import { TABS } from "./workspace.js";

/** @typedef {import("./workspace.js").Tab} Tab */

/** @type {Readonly<Record<Tab, import("../ui/icons.js").IconName>>} */
export const TAB_ICONS = { robot: "robot", program: "program", playground: "playground", class: "class" };

/** @type {ResizeObserver | null} watches the room that the tabs have */
let room = null;

/**
 * Fill the list of tabs; call again for another language.
 *
 * @param {HTMLElement} list
 * @param {Pick<import("./context.js").Context, "text" | "workspace">} context
 * @returns {() => void}  shows the current tab; call when the workspace has changed
 */
export function fillTabs(list, { text, workspace }) {
  const t = text("stage");
  const tabs = TABS.map((tab) => ({
    tab,
    button: h(
      "button",
      {
        type: "button",
        class: "tab",
        role: "tab",
        id: `tab-${tab}`,
        "aria-controls": `panel-${tab}`,
        onclick: () => workspace.select(tab),
      },
      icon(TAB_ICONS[tab]),
      h("span", {}, t(`work.${tab}`)),
    ),
  }));
  const fold = h(
    "button",
    {
      type: "button",
      class: "btn icon",
      id: "work-fold",
      title: t("work.fold"),
      "aria-label": t("work.fold"),
      onclick: () => {
        const last = workspace.tab;
        workspace.select(null);
        tabs.find(({ tab }) => tab === last)?.button.focus(); // in the rail
      },
    },
    icon("close"),
  );
  const end = h("div", { class: "tab-end", "data-slot": "tab-end" });
  const owned = h("div", { class: "tab-list", role: "tablist", "aria-label": t("work") }, ...tabs.map(({ button }) => button));
  list.replaceChildren(owned, h("span", { class: "grow" }), end, fold);
  owned.addEventListener("keydown", (event) => {
    const shown = tabs.filter(({ button }) => !button.hidden);
    const at = shown.findIndex(({ button }) => button === document.activeElement);
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (step === undefined || at < 0) return;
    event.preventDefault();
    shown[(at + step + shown.length) % shown.length].button.focus(); // Enter opens it
  });

  const fit = () =>
    firstThatFits(["icons", "words", "tight"], (names) => {
      list.dataset.names = names;
      return list.scrollWidth <= list.clientWidth;
    });
  const show = () => {
    for (const { tab, button } of tabs) {
      button.hidden = !workspace.offered.includes(tab);
      setAttribute(button, "aria-selected", String(tab === workspace.tab));
      setAttribute(button, "tabindex", tab === (workspace.tab ?? "robot") ? "0" : "-1");
    }
    fit();
  };
  show();
  room?.disconnect();
  room = new ResizeObserver(fit);
  room.observe(list);
  room.observe(end); // the name of the program's file
  return show;
}
