// The list of missions, in steps: picture, title, stars.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { firstOf, starRow } from "./stars.js";

/** @typedef {import("./steps.js").ByLanguage} ByLanguage */
/** @typedef {import("./steps.js").Listed} Listed */
/** @typedef {import("./steps.js").Step} Step */

/** @param {ByLanguage} titles @param {string} language */
export function titleIn(titles, language) {
  return titles[language] ?? titles.en ?? "";
}

/** The mission to go on with: the first one that is not passed. @param {readonly Step[]} steps @param {import("./progress.js").Progress} progress */
export function firstOpen(steps, progress) {
  const names = steps.flatMap(({ missions }) => missions.map((each) => each.name));
  return names.find((name) => progress.starsOf(name) === null) ?? "";
}

/**
 * Show the list in a dialog.
 *
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {string} options.language
 * @param {import("./progress.js").Progress} options.progress
 * @param {() => Promise<readonly Step[] | null>} options.steps
 * @param {(name: string) => void} options.choose
 * @param {(file: File) => void} options.open     a mission of one's own
 * @param {() => string} options.reason   why no mission can be started; empty: it can
 */
export function openList({ t, language, progress, steps, choose, open, reason }) {
  const body = h("div", { class: "mission-steps", "aria-busy": "true" }, h("p", { class: "muted" }, t("list.loading")));
  const close = h(
    "button",
    { type: "button", class: "btn icon", title: t("close"), "aria-label": t("close"), onclick: () => dialog.close() },
    icon("close"),
  );
  const input = h("input", { id: "mission-file", type: "file", accept: ".json,.zip", hidden: true, "aria-label": t("list.file") });
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    if (file === undefined) return;
    dialog.close();
    open(file);
  });
  const file = h("button", { type: "button", class: "btn line mission-open", title: t("list.file"), onclick: () => input.click() }, icon("open"), h("span", {}, t("list.file")));
  const dialog = h(
    "dialog",
    { class: "dialog mission-list", "aria-labelledby": "mission-list-title" },
    h("div", { class: "mission-list-head" }, h("h2", { id: "mission-list-title" }, t("title")), h("span", { class: "grow" }), file, input, close),
    body,
  );
  const closed = reason();
  /** @param {Listed} mission @param {boolean} isNext */
  const cardOf = (mission, isNext) => {
    const stars = progress.starsOf(mission.name);
    const title = titleIn(mission.titles, language);
    const picture =
      mission.picture === ""
        ? h("span", { class: "mission-picture" }, icon("flag"))
        : h("img", { class: "mission-picture", src: mission.picture, alt: "", width: 240, height: 160, loading: "lazy" });
    return h(
      "li",
      {},
      h(
        "button",
        {
          type: "button",
          class: "mission-choice",
          "data-mission": mission.name,
          "data-next": isNext ? "" : null,
          disabled: closed !== "",
          title: closed || title,
          onclick: () => {
            dialog.close();
            choose(mission.name);
          },
        },
        picture,
        h("strong", {}, title),
        starRow(firstOf(stars ?? 0, mission.stars), t),
      ),
    );
  };
  const load = async () => {
    const found = await steps();
    body.removeAttribute("aria-busy");
    if (found === null || found.length === 0) {
      const again = h("button", { type: "button", class: "btn line", onclick: () => void load() }, t("list.again"));
      body.replaceChildren(h("p", {}, t(found === null ? "list.failed" : "list.none")), ...(found === null ? [again] : []));
      return;
    }
    const next = firstOpen(found, progress);
    body.replaceChildren(
      ...(closed === "" ? [] : [h("p", { class: "note-box" }, closed)]),
      ...found.map((step, at) =>
        h(
          "section",
          { "aria-labelledby": `mission-step-${at}` },
          h("h3", { id: `mission-step-${at}` }, t("step", { number: at + 1, title: titleIn(step.titles, language) })),
          h("ul", { class: "mission-choices" }, ...step.missions.map((mission) => cardOf(mission, mission.name === next))),
        ),
      ),
    );
    /** @type {HTMLElement | null} */ const first = body.querySelector("[data-next], .mission-choice");
    first?.focus();
  };
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close(); // beside it
  });
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  void load();
  return dialog;
}
