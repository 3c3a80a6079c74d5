// The program of the robot: name and state, open, run, stop, restart. Compiler errors are shown in the rejected text
// while the previous program keeps running.

import { programOf } from "../state/index.js";
import { faultMessage, lineLabel, stateLabel } from "../state/program_status.js";
import { disabledReason } from "../state/disabled_reason.js";
import { exampleChoice } from "../examples/index.js";
import { uploadCause } from "../state/index.js";
import { SUCCESS_MS } from "../stage/notices.js";
import { buttonOf, fileButton, h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { sourceView } from "./source.js";

const VERBS = /** @type {const} */ ([
  ["run", "run"],
  ["stop", "stop"],
  ["reset", "reset"],
]);

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function programPanel(context) {
  const { text, language, actions, store, announce, program: host, workspace } = context;
  const t = text("program");
  const pageText = text("page");
  const example = exampleChoice(context);
  const name = h("strong", { class: "name" });
  const stateElement = h("span", { class: "chip", id: "program-state" });
  const message = h("p", { class: "message", hidden: true });
  const verbs = VERBS.map(([verb, drawing]) => ({
    verb,
    button: h(
      "button",
      {
        type: "button",
        class: "btn line slim",
        "data-program": verb,
        title: t(`program.${verb}`),
        onclick: () => void actions.program(verb),
      },
      icon(drawing),
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
  const element = h(
    "section",
    { class: "program-card", "aria-label": t("program") },
    h("div", { class: "row" }, name, stateElement, h("span", { class: "grow" }), ...verbs.map(({ button }) => button)),
    message,
    h("div", { class: "row" }, example.element, h("span", { class: "grow" }), file),
    upload,
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
        class: "btn icon",
        "aria-label": t("program.close"),
        onclick: () => store.dispatch({ type: "forget", what: "program" }),
      },
      icon("close"),
    );
    upload.replaceChildren(h("p", { class: "headline" }, headline, close));
    if (fault !== null) {
      upload.append(
        placed ? sourceView(now.text, fault, t("program.source")) : h("p", { class: "fault" }, fault.text),
        h(
          "div",
          { class: "row" },
          h("small", {}, t("program.keeps")),
          h(
            "button",
            { type: "button", class: "btn you", onclick: () => void host.openText(now.name, now.text) },
            t("program.edit"),
          ),
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
    if (fault !== null && workspace.tab !== "program") {
      store.dispatch({ type: "notice", level: "error", text: words, cause: uploadCause("program") });
    }
  };

  /** The state of the program in a word. @param {import("../state/index.js").State} state */
  const wordOf = (state) => {
    const program = programOf(state);
    return program === null ? "" : stateLabel(program.state, t, state.simulator?.paused ?? false);
  };

  return {
    slot: "program",
    element,
    watch(state) {
      const program = programOf(state);
      const news = program === null ? "" : `${program.name}: ${wordOf(state)}`;
      if (news !== announced && news !== "") announce(news);
      announced = news;
      showUpload(state.uploads.program);
    },
    render(state) {
      example.render(state);
      const program = programOf(state);
      const timePaused = state.simulator?.paused ?? false;
      const word = wordOf(state);
      const reason = disabledReason(state, pageText);
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
    },
  };
}
