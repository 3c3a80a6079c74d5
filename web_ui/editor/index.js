// The editor: connects tabs, toolbar, text, tools and footer of one session. It draws the state of session, page and
// text, and forwards user actions.

import { openSearchPanel } from "@codemirror/search";

import { translator } from "../i18n/index.js";
import { LARGEST_PROGRAM } from "../input/actions.js";
import { h } from "../panels/dom.js";
import { locate } from "../state/index.js";
import { robotTopic } from "../state/names.js";
import { faultMessage, lineOf, lineLabel, stateLabel } from "../state/program_status.js";
import { textOf } from "../browser/text_file.js";
import { allEvents, readAesl } from "./aesl.js";
import { breakpointLines, showBreakpoints, showPlace } from "./breakpoints.js";
import { CHECK_SERVICE, marks } from "./checking.js";
import { isInRobot } from "./documents.js";
import { download } from "./download.js";
import { footer } from "./footer.js";
import { header } from "./header.js";
import { hintBar, repairLabel } from "./hint.js";
import { Lexicon } from "./lexicon.js";
import { Link } from "./link.js";
import { createText } from "./text.js";
import { toolbar, watchKeys } from "./toolbar.js";
import { toolbox } from "./tools/index.js";
import PHRASES from "../i18n/codemirror.texts.js";
import WORDS from "../i18n/editor.texts.js";
import { ALL } from "./workspace.js";

import "./editor.css";

export { EditorSession } from "./editor_session.js";
export { splitEditorTopic } from "./state.js";

const CHECK_DELAY_MS = 300;
const THYMIO = "thymio-II";

/** @typedef {import("./link.js").Verb} Verb */
/** @typedef {import("./documents.js").Document} Document */
/** @typedef {import("./checking.js").Verdict} Verdict */

/**
 * @param {object} options
 * @param {import("./editor_session.js").EditorSession} options.session
 * @param {import("../protocol/client.js").Client} options.client
 * @param {import("../state/store.js").Store} options.store
 * @param {string} options.language
 * @param {import("../i18n/index.js").Translate} options.pageText
 * @param {(text: string) => void} options.announce
 * @param {() => void} options.close
 */
export function createEditor({ session, client, store, language, pageText, announce, close }) {
  const t = translator(language, WORDS);
  const link = new Link(client);
  const { workspace } = session;
  /** @type {Verdict | null} */ let verdict = null;
  /** @type {{ text: string, repair: import("./checking.js").Repair } | null} */ let correction = null;
  /** @type {import("./aesl.js").Aesl} */ let file = readAesl(workspace.current.text);
  let fileText = workspace.current.text;
  /** @type {any} */ let statusShown = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ let checkTimer;
  let checks = 0;
  let isChecked = true; // or in progress; false: the check service was not available
  let scheduled = false;
  let said = "";

  const robots = () => Object.keys(store.state.robots);
  /** The robot whose values are shown. */
  const robot = () => (workspace.tab === ALL ? store.state.selected : workspace.tab);
  /** The robot that the tab's program is for; null for all robots. */
  const owner = () => (workspace.tab === ALL ? null : workspace.tab);
  const status = () => store.state.programs[robot()] ?? null;
  const lexicon = new Lexicon(language);
  const target = () => lexicon.translate(session.state.targets[robot()] ?? null);

  const element = h("section", { class: "editor", "aria-label": t("editor") });
  const redraw = () => {
    if (scheduled || !element.isConnected) return;
    scheduled = true;
    requestAnimationFrame(() => {
      scheduled = false;
      render();
    });
  };

  /** @param {string} text @param {"good" | "warning" | "error" | ""} kind */
  const report = (text, kind) => {
    foot.report({ text, kind });
    announce(text);
  };

  /** @param {string} code */
  const codeChanged = (code) => {
    workspace.edit(code);
    checkSoon();
    redraw();
  };

  const vocabulary = () => ({
    target: target(),
    events: allEvents(file),
    constants: file.constants,
    variables: verdict?.variables ?? [],
  });

  const code = h("div", { class: "code" });
  const text = createText({
    parent: code,
    kept: session.texts,
    label: t("editor.code"),
    phrases: PHRASES[language] ?? {},
    vocabulary,
    changed: codeChanged,
    toggleBreakpoint: (line) => toggleBreakpoint(line),
    repairLabel: (content, repair) => repairLabel(t, content, repair),
    correct: () => correct(),
  });
  /** Apply the proposed repair; the text is checked again. */
  const correct = () => {
    if (correction === null || !text.repair(correction.text, correction.repair)) return;
    correction = null;
    hints.show(null);
    announce(t("hint.done"));
  };
  const hints = hintBar(t, correct);

  /** Check the text shortly after the last change. */
  const checkSoon = () => {
    clearTimeout(checkTimer);
    checkTimer = setTimeout(check, CHECK_DELAY_MS);
  };
  const check = async () => {
    const number = ++checks;
    const source = workspace.code;
    const known = readAesl(workspace.current.text);
    const answer = await link.check({ source, language, events: allEvents(known), constants: known.constants });
    if (number !== checks || source !== workspace.code) return; // a newer check is in progress
    verdict = answer;
    if (answer === null) {
      isChecked = false;
      foot.report({ text: t("check.unknown"), kind: "" });
      return;
    }
    const found = marks(source, answer);
    text.mark(found);
    const [first] = [...answer.errors, ...answer.warnings];
    const { hint = "", repair = null } = found.find((mark) => mark.hint !== undefined) ?? {};
    correction = repair && { text: source, repair };
    hints.show(hint === "" ? null : { text: hint, button: repair === null ? "" : repairLabel(t, source, repair) });
    if (first === undefined) foot.report({ text: `✓ ${t("check.ok")}`, kind: "good" });
    else {
      const kind = answer.errors.length > 0 ? "error" : "warning";
      const said = first.line === null ? first.message : t("check.error", { line: first.line, message: first.message });
      foot.report({ text: `${kind === "error" ? "✕" : "⚠"} ${said}`, kind });
      if (kind === "error") announce(hint === "" ? said : `${said}. ${hint}`);
    }
    redraw();
  };

  /** Show another text. */
  const show = () => {
    text.show(`${workspace.tab} ${workspace.current.node} ${workspace.current.name}`, workspace.code);
    verdict = null;
    correction = null;
    hints.show(null);
    statusShown = null;
    check();
    redraw();
  };
  session.onText = show;

  const firstLine = () => Number(status()?.values.first_line ?? 1) || 1;
  /** Whether the robot runs exactly the text that is shown. */
  const isShown = () => {
    const { source } = workspace.current;
    const program = target()?.program;
    const node = file.nodes[workspace.current.node]?.name ?? "";
    const name = status()?.values.node ?? "";
    const same = name === "" || name === node || file.nodes.length === 1;
    return isInRobot(workspace.current) && program?.file === source && same;
  };

  /** @param {number} line */
  const toggleBreakpoint = async (line) => {
    const lines = breakpointLines(text.view.state);
    const wanted = lines.includes(line) ? lines.filter((each) => each !== line) : [...lines, line];
    showBreakpoints(text.view, wanted);
    if (isInRobot(workspace.current)) await sendBreakpoints();
  };
  const sendBreakpoints = async () => {
    const first = firstLine();
    const lines = breakpointLines(text.view.state).map((line) => line + first - 1);
    const { ok, message } = await link.setBreakpoints(owner(), lines);
    if (!ok) {
      report(message, "error");
      statusShown = null; // restores the breakpoints in effect
      redraw();
    }
  };

  const load = async () => {
    const { tab } = workspace;
    const { name, text: source } = workspace.current;
    const { ok, message } = await link.load(owner(), name, source, robots());
    if (!ok) {
      const fault = (await link.fault(source, language)) ?? locate(message, name);
      report(
        fault.line === null ? fault.text : t("check.error", { line: codeLine(fault.line), message: fault.text }),
        "error",
      );
      return false;
    }
    workspace.loaded(tab, source);
    report(t("editor.loaded", { name }), "good");
    if (readAesl(source).nodes.some((node) => node.name !== THYMIO)) {
      const notes = await link.notes(source, language);
      if (notes.length > 0) report(`${t("editor.loaded", { name })}: ${notes.join("; ")}`, "warning");
    }
    // Send the current breakpoints: one may have been set while the request was in progress.
    if (workspace.tab === tab && breakpointLines(text.view.state).length > 0) await sendBreakpoints();
    redraw();
    return true;
  };
  /** Convert a line of the file to a line of the code that is shown. @param {number} line */
  const codeLine = (line) => {
    const units = file.nodes[workspace.current.node]?.units ?? [];
    const before = units.length === 0 ? 1 : fileText.slice(0, units[0].from).split("\n").length;
    return Math.max(line - before + 1, 1);
  };

  /** @param {Verb} verb */
  const can = (verb) => affected().some((name) => store.state.services.includes(robotTopic(name, `aseba/${verb}`)));
  const affected = () => (workspace.tab === ALL ? robots() : [workspace.tab]);
  /** @param {Verb} verb */
  const control = async (verb) => {
    const answers = await Promise.all(affected().map((name) => link.control(name, verb)));
    const refused = answers.find(({ ok }) => !ok);
    if (refused !== undefined) report(refused.message, "error");
  };

  /** @type {import("./toolbar.js").EditorCommands} */
  const commands = {
    newFile: () => workspace.newFile(),
    open: (chosen) => open(chosen),
    choose(choice) {
      if ("recent" in choice) {
        const { recent } = choice;
        if (!recent.unsaved) return openText(recent.name, recent.text);
        workspace.restore(recent);
        return text.view.focus();
      }
      workspace.follow();
      link.loadBuiltIn(owner(), choice.sample, robots()).then(({ ok, message }) => ok || report(message, "error"));
    },
    save() {
      const { name, text: content } = workspace.current;
      download(name, content, "application/xml");
      workspace.saved();
      redraw();
    },
    load: () => void load(),
    run: () => void (isInRobot(workspace.current) ? control("run") : load()),
    control: (verb) => void control(verb),
    resize(step) {
      session.resize(step);
      redraw();
    },
    find: () => openSearchPanel(text.view),
  };

  /** @param {File} chosen */
  const open = async (chosen) => {
    if (chosen.size > LARGEST_PROGRAM) return report(t("editor.tooLarge", { name: chosen.name }), "error");
    const content = await textOf(chosen);
    if (content === null) return report(pageText("file.notText", { name: chosen.name }), "error");
    openText(chosen.name, content);
  };
  /** @param {string} name @param {string} content */
  const openText = (name, content) => {
    const refusal = workspace.open(name, content);
    if (refusal !== null) report(t("editor.refused", { ...refusal }), "error");
    text.view.focus();
  };

  /** @param {import("./file_store.js").Kept} kept */
  const draftLabel = ({ name, time }) => t("editor.draft", { name, time: new Date(time).toLocaleString(language) });
  const head = header({
    t,
    draftLabel,
    session,
    redraw,
    close,
    select: (name) => store.dispatch({ type: "select", robot: name }),
  });
  const bar = toolbar(t, commands, draftLabel);
  const foot = footer(t, () => {
    const [first] = [...(verdict?.errors ?? []), ...(verdict?.warnings ?? [])];
    if (first?.line) goTo(first.line, first.column ?? 1);
  });
  /** @param {number} line @param {number} column */
  const goTo = (line, column) => {
    const { doc } = text.view.state;
    if (line > doc.lines) return;
    const at = doc.line(line);
    text.view.dispatch({ selection: { anchor: Math.min(at.from + column - 1, at.to) }, scrollIntoView: true });
    text.view.focus();
  };
  const tools = toolbox({
    t,
    session,
    announce,
    redraw,
    insert(words) {
      text.view.dispatch(text.view.state.replaceSelection(words));
      text.view.focus();
    },
    setVariable: (variable, values) => link.setVariable(robot(), variable, values),
    emit: (event, values) => link.emit(robot(), event, values),
    define(kind, entry, value) {
      workspace.define(kind, entry, value);
      checkSoon();
      redraw();
    },
  });
  element.append(
    head.element,
    bar.element,
    head.draft,
    h("div", { class: "editor-body" }, code, tools.element),
    h("div", { class: "editor-end" }, hints.element, foot.element),
  );
  const removeKeys = watchKeys(element, commands);

  const drawStatus = () => {
    const now = status();
    const values = now?.values ?? {};
    const key = now === null || !isShown() ? "other" : now;
    if (key !== statusShown) {
      statusShown = key;
      if (key === "other") showPlace(text.view, null);
      else {
        const first = firstLine();
        const inForce = JSON.parse(values.breakpoints || "[]").map((/** @type {number} */ line) => line - first + 1);
        showBreakpoints(text.view, inForce);
        const line = lineOf(values);
        showPlace(text.view, line > 0 ? { line, fault: values.state === "fault" } : null);
        for (const [line, became] of Object.entries(JSON.parse(values.breakpoints_moved || "{}"))) {
          if (became === null) announce(t("breakpoint.none", { line: Number(line) - first + 1 }));
        }
      }
    }
    const fault = faultMessage(values, language);
    const timePaused = store.state.simulator?.paused ?? false;
    const words = values.state ? stateLabel(values.state, pageText, timePaused) + lineLabel(values, pageText) : "";
    const sentence = words + (fault ? `: ${fault}` : "");
    foot.robot(timePaused && values.state === "running" ? "paused" : (values.state ?? ""), sentence);
    if (sentence !== said) {
      said = sentence;
      announce(said);
    }
    /** @param {string} name @returns {import("./footer.js").Share} */
    const reported = (name) =>
      values[`${name}_size`] === undefined ? null : [Number(values[`${name}_used`]), Number(values[`${name}_size`])];
    const use = verdict?.use;
    foot.memories({
      variables: use?.variables ?? reported("variables"),
      bytecode: use?.bytecode ?? reported("bytecode"),
      stack: use?.stack ?? reported("stack"),
    });
  };

  const render = () => {
    if (!session.tabs(robots()).includes(workspace.tab)) workspace.choose(ALL);
    if (store.state.services.includes(CHECK_SERVICE)) {
      void lexicon.ask(link, redraw);
      if (!isChecked) {
        isChecked = true;
        void check();
      }
    }
    workspace.setRobotProgram(ALL, session.state.targets[store.state.selected]?.program);
    if (workspace.tab !== ALL) workspace.setRobotProgram(workspace.tab, target()?.program);
    if (workspace.current.text !== fileText) {
      fileText = workspace.current.text;
      file = readAesl(fileText);
    }
    element.style.setProperty("--code-size", `${session.fontSize}px`);
    head.render(session.tabs(robots()), file);
    drawStatus();
    const offline = store.state.connection === "connected" ? "" : pageText("connection.needed");
    bar.render(can, workspace.fileStore.recent(), session.state.behaviors, offline);
    tools.render({
      robot: robot(),
      target: target(),
      variables: session.state.variables[robot()] ?? null,
      log: session.state.log,
      file,
      offline,
    });
  };

  return {
    element,
    redraw,
    open,
    openText,
    /** Call after the editor has been added to the page. */
    start() {
      show();
      render();
      text.view.focus();
    },
    destroy() {
      clearTimeout(checkTimer);
      removeKeys();
      text.destroy();
      element.remove();
    },
  };
}

/** @typedef {ReturnType<typeof createEditor>} Editor */
