// How to begin a program: a skeleton with comments, an empty page, an example, or one of the last programs.

import { exampleList } from "../examples/index.js";
import { fileButton, h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { PROGRAM_FILES } from "./file_menu.js";
import { SKELETONS, skeletonText } from "./skeletons.js";

/** @type {Readonly<Record<string, import("../ui/icons.js").IconName>>} */
const SIGNS = { button: "pad", avoid: "beams", line: "track", empty: "file" };

/** @typedef {import("../editor/file_store.js").StoredFile} StoredFile */

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {import("../i18n/index.js").Translate} options.exampleText
 * @param {(kept: StoredFile) => string} options.draftLabel
 * @param {import("./commands.js").ProgramCommands} options.commands
 */
export function startPage({ t, exampleText, draftLabel, commands }) {
  /** @param {string} name @param {() => void} act */
  const card = (name, act) =>
    h(
      "li",
      {},
      h(
        "button",
        { type: "button", class: "program-card", "data-new": name, onclick: act },
        icon(SIGNS[name]),
        h("span", {}, h("b", {}, t(`new.${name}`)), " ", h("small", {}, t(`new.${name}.text`))),
      ),
    );
  const cards = [
    ...SKELETONS.map((name) => card(name, () => commands.openText(`${name}.aesl`, skeletonText(name, t)))),
    card("empty", () => commands.empty()),
  ];
  const examples = exampleList({ t: exampleText, choose: (name) => void commands.openExample(name) });
  const files = h("ul", { class: "program-files" });
  const recentPart = h(
    "section",
    { "aria-labelledby": "start-recent" },
    h("h3", { id: "start-recent" }, t("file.recent")),
    files,
  );
  const examplePart = h(
    "section",
    { "aria-labelledby": "start-examples" },
    h("h3", { id: "start-examples" }, t("file.examples")),
    examples.element,
  );
  const back = h(
    "button",
    { type: "button", class: "btn line", "data-new": "back", onclick: () => commands.back() },
    icon("text", { small: true }),
    t("new.back"),
  );
  const open = fileButton({
    id: "start-file",
    label: t("file.open"),
    help: t("file.open"),
    accept: PROGRAM_FILES,
    open: (file) => void commands.open(file),
  });
  const element = h(
    "div",
    { class: "program-start", hidden: true },
    h("div", { class: "program-start-head" }, h("h2", {}, t("new.title")), h("div", { class: "row" }, back, open)),
    h("ul", { class: "program-cards" }, ...cards),
    examplePart,
    recentPart,
  );
  element.addEventListener("keydown", ({ key }) => key === "Escape" && !back.hidden && commands.back());
  let listed = "";
  return {
    element,
    focus() {
      /** @type {HTMLElement | null} */ (element.querySelector(".program-card"))?.focus();
    },
    /**
     * @param {object} facts
     * @param {import("../state/index.js").State} facts.state
     * @param {string} facts.reason   why no example can be started; empty: it can
     * @param {readonly StoredFile[]} facts.recent
     * @param {boolean} facts.canGoBack   whether there is a program to return to
     */
    render({ state, reason, recent, canGoBack }) {
      back.hidden = !canGoBack;
      examples.render(state, reason);
      examplePart.hidden = state.behaviors.length === 0;
      recentPart.hidden = recent.length === 0;
      const now = JSON.stringify(recent.map(({ name, time, unsaved }) => [name, time, unsaved]));
      if (now === listed) return;
      listed = now;
      files.replaceChildren(
        ...recent.map((kept) =>
          h(
            "li",
            {},
            h(
              "button",
              { type: "button", class: "btn", "data-recent": kept.name, onclick: () => commands.openRecent(kept) },
              icon("file", { small: true }),
              h("span", {}, kept.unsaved ? draftLabel(kept) : kept.name),
            ),
          ),
        ),
      );
    },
  };
}
