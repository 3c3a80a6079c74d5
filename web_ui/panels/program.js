// The program of the robot: name and state, open, run, stop, restart. Compiler errors are shown in the rejected text
// while the previous program keeps running.

import { programOf } from "../state/index.js";
import { faultMessage, lineLabel, stateLabel } from "../state/program_status.js";
import { disabledReason } from "../state/disabled_reason.js";
import { behaviorChoice } from "./behaviors.js";
import { card, showRefusal } from "./card.js";
import { buttonOf, fileButton, h, icon, ICONS, lock, setAttribute, setText } from "./dom.js";
import { SUCCESS_MS } from "./notices.js";
import { sourceView } from "./source.js";

const VERBS = /** @type {const} */ ([
  ["run", ICONS.play],
  ["stop", ICONS.stop],
  ["reset", ICONS.restart],
]);

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function programPanel(context) {
  const { t, language, actions, store, announce, editor } = context;
  const behavior = behaviorChoice(context);
  const name = h("strong", { class: "name" });
  const stateElement = h("span", { class: "state" });
  const message = h("p", { class: "message", hidden: true });
  const verbs = VERBS.map(([verb, path]) => ({
    verb,
    button: h(
      "button",
      { type: "button", title: t(`program.${verb}`), onclick: () => actions.program(verb) },
      icon(path),
      t(`program.${verb}`),
    ),
  }));
  const file = fileButton({
    id: "program-file",
    label: t("program.open"),
    help: t("program.openHelp"),
    accept: ".aesl,.aseba,.txt",
    open: (chosen) => actions.loadFile(chosen),
  });
  const open = buttonOf(file);
  const upload = h("div", { class: "upload", hidden: true });
  const element = card(
    "program",
    t("program"),
    h("div", { class: "current" }, name, stateElement),
    message,
    h("div", { class: "row verbs" }, ...verbs.map(({ button }) => button)),
    h(
      "div",
      { class: "row" },
      file,
      h("small", {}, t("program.dropHint")),
    ),
    upload,
    behavior.element,
  );
  /** @type {import("../state/index.js").Upload | null} */ let shown = null;
  let announced = "";

  /** @param {import("../state/index.js").Upload | null} now */
  const showUpload = (now) => {
    if (now === shown) return;
    shown = now;
    upload.hidden = now === null;
    if (now === null) return upload.replaceChildren();
    upload.className = `upload ${now.phase}`;
    const { fault } = now;
    const placed = fault !== null && fault.line !== null;
    const headline =
      now.phase === "refused" && placed
        ? t("program.refusedAt", { name: now.name, line: fault.line ?? 0, column: fault.column ?? 0 })
        : t(`program.${now.phase}`, { name: now.name });
    const close = h(
      "button",
      {
        type: "button",
        class: "plain",
        "aria-label": t("program.close"),
        onclick: () => store.dispatch({ type: "forget", what: "program" }),
      },
      icon(ICONS.close),
    );
    upload.replaceChildren(h("p", { class: "headline" }, headline, close));
    if (fault !== null) {
      upload.append(
        placed ? sourceView(now.text, fault, t("program.source")) : h("p", { class: "fault" }, fault.text),
        h(
          "div",
          { class: "row" },
          h("small", {}, t("program.keeps")),
          h("button", { type: "button", onclick: () => editor.openText(now.name, now.text) }, t("program.edit")),
        ),
      );
    }
    if (now.phase === "accepted") {
      setTimeout(() => {
        if (store.state.uploads.program === now) store.dispatch({ type: "forget", what: "program" });
      }, SUCCESS_MS);
    }
    const words = fault === null ? headline : `${headline}: ${fault.text}`;
    announce(words);
    if (fault !== null) showRefusal(element, store, words, "program");
  };

  return {
    slot: "side",
    element,
    render(state) {
      behavior.render(state);
      const program = programOf(state);
      const timePaused = state.simulator?.paused ?? false;
      const word = program === null ? "" : stateLabel(program.state, t, timePaused);
      const reason = disabledReason(state, t);
      setText(name, program?.name || t("program.none"));
      setText(stateElement, word);
      setAttribute(stateElement, "data-state", timePaused && program?.state === "running" ? "paused" : (program?.state ?? ""));
      const { values, level, message: reported } = program ?? { values: {}, level: 0, message: "" };
      setText(message, level > 0 ? (faultMessage(values, language) || reported) + lineLabel(values, t) : "");
      message.hidden = message.textContent === "";
      for (const { verb, button } of verbs) {
        const there = state.services.includes(actions.programService(verb));
        lock(button, reason || (there ? "" : t("program.unavailable")));
      }
      lock(open, reason);
      const news = program === null ? "" : `${program.name}: ${word}`;
      if (news !== announced && news !== "") announce(news);
      announced = news;
      showUpload(state.uploads.program);
    },
  };
}
