// The toolbar: file buttons on the left, robot buttons on the right, and their keyboard shortcuts.

import { plainKey } from "../input/keyboard.js";
import { fileButton, h, icon, ICONS, lock } from "../panels/dom.js";

/** @typedef {import("./runtime_client.js").Verb} Verb */
/** @typedef {import("./file_store.js").StoredFile} StoredFile */
/** @typedef {{ recent: StoredFile } | { sample: string }} Choice   an entry of the list of recent files and examples */
/** @typedef {import("./commands.js").EditorCommands} EditorCommands */

const SAVE = "M5 3h11l5 5v13H3V3zm2 2v5h8V5zm5 8a3 3 0 1 0 0 6 3 3 0 0 0 0-6z";
const PUSHABLE = "M11 3h2v9h4l-5 6-5-6h4zM4 19h16v2H4z";
const NEXT = "M4 5h12v2H4zM4 11h7v2H4zM4 17h12v2H4zM15 9l5 3.500-5 3.500z";
const FIND =
  "M10 3a7 7 0 1 0 4.200 12.600L20 21.400 21.400 20l-5.800-5.800A7 7 0 0 0 10 3zm0 2a5 5 0 1 1 0 10 5 5 0 0 1 0-10z";
const NEW = "M5 2h9l5 5v15H5zm8 2H7v16h10V8h-4z";

const VERBS = /** @type {const} */ ([
  ["pause", ICONS.pause, "F10"],
  ["stop", ICONS.stop, ""],
  ["step_line", NEXT, "F7"],
  ["step", ICONS.step, "Shift+F7"],
  ["reset", ICONS.restart, "F8"],
]);

/**
 * @param {import("../i18n/index.js").Translate} t
 * @param {EditorCommands} commands
 * @param {(kept: StoredFile) => string} draftLabel   text about an unsaved draft
 */
export function toolbar(t, commands, draftLabel) {
  /** @param {string} name @param {string} path @param {string} key @param {() => void} act @param {boolean} [worded] */
  const button = (name, path, key, act, worded = false) => {
    const title = key === "" ? t(`editor.${name}`) : `${t(`editor.${name}`)} (${key})`;
    const words = worded ? [h("span", {}, t(`editor.${name}`))] : [];
    return h(
      "button",
      { type: "button", title, "aria-label": t(`editor.${name}`), "data-verb": name, onclick: act },
      path === "" ? "" : icon(path),
      ...words,
    );
  };
  const choice = h("select", { class: "recent", "aria-label": t("editor.choose") });
  /** @type {Choice[]} entries after the heading */ let choices = [];
  choice.addEventListener("change", () => {
    const chosen = choices[choice.selectedIndex - 1];
    choice.value = "";
    if (chosen !== undefined) void commands.choose(chosen);
  });
  const load = button("load", PUSHABLE, "Ctrl+Enter", () => void commands.load(), true);
  const run = button("run", ICONS.play, "F9", () => void commands.run(), true);
  const verbs = VERBS.map(([verb, path, key]) => ({
    verb: /** @type {Verb} */ (verb),
    element: button(verb, path, key, () => void commands.control(verb)),
  }));
  /** @param {string} name @param {string} sign @param {number} step */
  const sizer = (name, sign, step) => {
    const title = t(`editor.${name}`);
    const attributes = { type: "button", title, "aria-label": `${sign} ${title}`, onclick: () => commands.resize(step) };
    return h("button", attributes, sign);
  };
  const element = h(
    "div",
    { class: "editor-bar", role: "toolbar", "aria-label": t("editor.toolbar") },
    h(
      "div",
      { class: "group" },
      button("new", NEW, "", () => commands.newFile()),
      fileButton({
        id: "editor-file",
        label: "",
        help: t("editor.open"),
        accept: ".aesl,.aseba,.txt",
        open: (file) => void commands.open(file),
      }),
      button("save", SAVE, "Ctrl+S", () => commands.save()),
      choice,
      button("find", FIND, "Ctrl+F", () => commands.find()),
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
