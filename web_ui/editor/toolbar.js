// The toolbar: file buttons on the left, robot buttons on the right, and their keyboard shortcuts.

import { plainKey } from "../input/keyboard.js";
import { fileButton, h, lock } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("../input/runtime_client.js").Verb} Verb */
/** @typedef {import("./file_store.js").StoredFile} StoredFile */
/** @typedef {{ recent: StoredFile } | { sample: string }} Choice   an entry of the list of recent files and examples */
/** @typedef {import("./commands.js").EditorCommands} EditorCommands */

const VERBS = /** @type {const} */ ([
  ["pause", "halt", "F10"],
  ["stop", "stop", ""],
  ["step_line", "nextLine", "F7"],
  ["step", "step", "Shift+F7"],
  ["reset", "reset", "F8"],
]);

/**
 * @param {import("../i18n/index.js").Translate} t
 * @param {EditorCommands} commands
 * @param {(kept: StoredFile) => string} draftLabel   text about an unsaved draft
 */
export function toolbar(t, commands, draftLabel) {
  /** @param {string} name @param {import("../ui/icons.js").IconName} drawing @param {string} key @param {() => void} act @param {boolean} [worded] */
  const button = (name, drawing, key, act, worded = false) => {
    const title = key === "" ? t(`editor.${name}`) : `${t(`editor.${name}`)} (${key})`;
    const words = worded ? [h("span", {}, t(`editor.${name}`))] : [];
    return h(
      "button",
      {
        type: "button",
        class: worded ? "btn line slim" : "btn icon",
        title,
        "aria-label": t(`editor.${name}`),
        "data-verb": name,
        onclick: act,
      },
      icon(drawing, { small: true }),
      ...words,
    );
  };
  const choice = h("select", { class: "recent select", "aria-label": t("editor.choose") });
  /** @type {Choice[]} entries after the heading */ let choices = [];
  choice.addEventListener("change", () => {
    const chosen = choices[choice.selectedIndex - 1];
    choice.value = "";
    if (chosen !== undefined) void commands.choose(chosen);
  });
  const load = button("load", "give", "Ctrl+Enter", () => void commands.load(), true);
  const run = button("run", "run", "F9", () => void commands.run(), true);
  const verbs = VERBS.map(([verb, drawing, key]) => ({
    verb: /** @type {Verb} */ (verb),
    element: button(verb, drawing, key, () => void commands.control(verb)),
  }));
  /** @param {string} name @param {string} sign @param {number} step */
  const sizer = (name, sign, step) => {
    const title = t(`editor.${name}`);
    return h(
      "button",
      { type: "button", class: "btn icon", title, "aria-label": `${sign} ${title}`, onclick: () => commands.resize(step) },
      sign,
    );
  };
  const element = h(
    "div",
    { class: "editor-bar", role: "toolbar", "aria-label": t("editor.toolbar") },
    h(
      "div",
      { class: "group" },
      button("new", "file", "", () => commands.newFile()),
      fileButton({
        id: "editor-file",
        label: "",
        help: t("editor.open"),
        accept: ".aesl,.aseba,.txt",
        open: (file) => void commands.open(file),
        look: "btn icon",
      }),
      button("save", "save", "Ctrl+S", () => commands.save()),
      choice,
      button("find", "search", "Ctrl+F", () => commands.find()),
      sizer("smaller", "A−", -1),
      sizer("larger", "A+", 1),
    ),
    h(
      "div",
      { class: "group" },
      load,
      run,
      ...verbs.map(({ element }) => element),
    ),
  );
  element.querySelector(".file button")?.setAttribute("aria-label", t("editor.open"));
  let listed = "";

  return {
    element,
    /**
     * @param {readonly StoredFile[]} recent
     * @param {readonly { name: string, description: string }[]} samples
     * @param {string} reason  why robots cannot be controlled; empty if they can
     */
    render(recent, samples, reason) {
      for (const button of [load, run]) lock(button, reason);
      for (const { verb, element } of verbs) lock(element, reason || (commands.can(verb) ? "" : t("editor.unavailable")));
      const names = JSON.stringify([recent.map(({ name, time, unsaved }) => [name, time, unsaved]), samples]);
      if (names === listed) return;
      listed = names;
      choices = [...recent.map((kept) => ({ recent: kept })), ...samples.map(({ name }) => ({ sample: name }))];
      choice.replaceChildren(
        h("option", { value: "" }, t("editor.choose")),
        h(
          "optgroup",
          { label: t("editor.recent") },
          ...recent.map((kept) => h("option", {}, kept.unsaved ? draftLabel(kept) : kept.name)),
        ),
        h(
          "optgroup",
          { label: t("editor.samples") },
          ...samples.map(({ name, description }) => h("option", { title: description }, name)),
        ),
      );
    },
  };
}

/**
 * Keyboard shortcuts: function keys work everywhere, the others inside the editor. Returns a function that removes
 * them.
 *
 * @param {HTMLElement} element
 * @param {EditorCommands} commands
 * @returns {() => void}
 */
export function watchKeys(element, commands) {
  const keys = /** @type {Record<string, () => void>} */ ({
    F7: () => void commands.control("step_line"),
    "Shift+F7": () => void commands.control("step"),
    F8: () => void commands.control("reset"),
    F9: () => void commands.run(),
    F10: () => void commands.control("pause"),
    "Ctrl+Enter": () => void commands.load(),
    "Ctrl+s": () => commands.save(),
  });
  /** @param {KeyboardEvent} event */
  const press = (event) => {
    if (!element.checkVisibility()) return; // another tab is shown
    const ctrl = event.ctrlKey || event.metaKey ? "Ctrl+" : "";
    const act = keys[`${ctrl}${event.shiftKey ? "Shift+" : ""}${plainKey(event)}`];
    const inside = event.target instanceof Node && element.contains(event.target);
    if (act === undefined || event.altKey || (ctrl !== "" && !inside)) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) act();
  };
  window.addEventListener("keydown", press, true);
  // Escape closes lists and panels in the editor; unlike elsewhere on the page it does not stop the robots.
  element.addEventListener("keydown", (event) => event.key === "Escape" && event.stopPropagation());
  return () => window.removeEventListener("keydown", press, true);
}
