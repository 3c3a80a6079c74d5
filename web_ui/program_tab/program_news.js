// What happens to the robot's program, whatever tab is open: its state for screen readers, and what became of a file
// that was dropped on the page. The panel is what the tab shows until a language is loaded.

import { exampleTitle } from "../examples/index.js";
import { SUCCESS_MS } from "../stage/notices.js";
import { programOf, uploadCause } from "../state/index.js";
import { faultMessage, stateWithLine } from "../state/program_status.js";
import { h } from "../ui/dom.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function programNews({ text, language, store, announce, program: host }) {
  const t = text("program");
  const exampleText = text("examples");
  let announced = "";
  /** @type {import("../state/index.js").Upload | null} */ let shown = null;

  /** The program and its state in a sentence. @param {import("../state/index.js").State} state */
  const sentenceOf = (state) => {
    const program = programOf(state);
    if (program === null || program.name === "") return "";
    const fault = faultMessage(program.values, language);
    const words = stateWithLine(program.values, t, state.simulator?.paused ?? false);
    return `${exampleTitle(program.name, exampleText)}: ${words}${fault === "" ? "" : `: ${fault}`}`;
  };

  /** @param {import("../state/index.js").Upload | null} now */
  const showUpload = (now) => {
    if (now === shown) return;
    shown = now;
    if (now === null || now.phase === "sending") return;
    const cause = uploadCause("program");
    const { name, fault } = now;
    store.dispatch({ type: "solved", cause });
    if (now.phase === "accepted") {
      store.dispatch({ type: "notice", level: "info", text: t("program.accepted", { name }), cause });
      setTimeout(() => {
        if (store.state.uploads.program === now) store.dispatch({ type: "forget", what: "program" });
      }, SUCCESS_MS);
      return;
    }
    const { line = null, column = null, text: message = "" } = fault ?? {};
    const headline =
      line === null
        ? `${t("program.refused", { name })}: ${message}`
        : t("program.refusedAt", { name, line, column: column ?? 1, message });
    const words = `${headline}. ${t("program.keeps")} ${line === null ? "" : t("program.look")}`.trim();
    store.dispatch({ type: "notice", level: "error", text: words, cause });
    announce(words);
    if (line !== null) void host.keepText(name, now.text); // there the mistake is explained at its place
  };

  return {
    slot: "program",
    element: h("p", { class: "program-wait", role: "status" }, t("program.wait")),
    watch(state) {
      const news = sentenceOf(state);
      if (news !== announced && news !== "") announce(news);
      announced = news;
      showUpload(state.uploads.program);
    },
  };
}
