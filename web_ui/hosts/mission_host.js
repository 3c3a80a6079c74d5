// Integrates missions into the page: the list, the card of the open mission, and the pupil's program of it. Loaded on
// demand; a visit without a mission loads nothing.

import { localStore } from "../browser/local_storage.js";
import { looksLikeMission } from "../missions/file_kind.js";
import { Progress } from "../missions/progress.js";
import { fetchMissions } from "../missions/steps.js";
import { disabledReason } from "../state/disabled_reason.js";
import { attemptOf, CONNECTION } from "../state/index.js";
import { missionText } from "../state/mission.js";
import { editorsOf, NODE } from "./program_host.js";

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {typeof import("../missions/index.js")} Module */

const LARGEST_MISSION = 20_000_000;
const MB = 1_000_000;

export class MissionHost {
  /** @type {Context | null} */ #context = null;
  /** @type {Module | null} */ #module = null;
  #isLoading = false;
  /** @type {InstanceType<Module["MissionCard"]> | null} */ #card = null;
  /** The mission that is shown. */ #name = "";
  /** @type {string | null} */ #language = null;
  /** Whether the page runs nodes; false until it is known. */ #runsNodes = false;
  /** Name of the document with the pupil's program. */ #document = "";
  /** Number of the try whose result was noted. */ #noted = "";

  /** @param {HTMLElement} slot   of the card, over the scene */
  constructor(slot) {
    this.slot = slot;
    this.progress = new Progress(localStore);
  }

  /** Editors that the open mission allows; null: all. */
  get editors() {
    return editorsOf(this.#context?.store.state.mission?.languages ?? null);
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.#context = context;
    context.program.onWritten = (document, text) => this.#keep(document, text);
    this.#removeCard();
  }

  /** Show the list of missions. */
  async openList() {
    /** @type {ReturnType<typeof fetchMissions> | null} */ let first = fetchMissions(); // while the module is loaded
    const [module, context] = [await this.#load(), this.#context];
    if (module === null || context === null) return;
    const { store, text, language } = context;
    module.openList({
      t: module.missionTranslator(language),
      language,
      progress: this.progress,
      steps: () => {
        const steps = first ?? fetchMissions();
        first = null;
        return steps;
      },
      choose: (name) => void this.start(name),
      open: (file) => void this.openFile(file),
      reason: () => disabledReason(store.state, text("page")),
    });
  }

  /** Start a shipped mission. @param {string} name */
  async start(name) {
    this.#context?.welcome.close();
    await this.#context?.actions.startMission(name);
  }

  /** Start the mission of a file. @param {File} file */
  async openFile(file) {
    const { actions, store, text } = /** @type {Context} */ (this.#context);
    if (file.size > LARGEST_MISSION) {
      const words = text("page")("file.tooLarge", { name: file.name, size: LARGEST_MISSION / MB });
      return store.dispatch({ type: "notice", level: "error", text: words });
    }
    this.#context?.welcome.close();
    await actions.startMission(file.name, new Uint8Array(await file.arrayBuffer()));
  }

  /** Start the mission of a file that was dropped; returns whether it is one. @param {File} file */
  async openOther(file) {
    if (!/\.(json|zip)$/i.test(file.name) || file.size > LARGEST_MISSION) return false;
    if (!looksLikeMission(new Uint8Array(await file.arrayBuffer()))) return false;
    await this.openFile(file);
    return true;
  }

  /** Call once per frame. @param {State} state */
  render(state) {
    const { mission } = state;
    if (mission === null) {
      this.#removeCard();
      if (this.#name !== "") this.#context?.program.limit(null);
      this.#name = "";
      return;
    }
    if (mission.name !== this.#name) this.#begin(mission);
    this.#note(state);
    if (this.#module === null) {
      if (!this.#isLoading) void this.#load().then(() => this.#context?.scene.invalidate());
      return;
    }
    const context = /** @type {Context} */ (this.#context);
    this.#card ??= new this.#module.MissionCard({
      context,
      t: this.#module.missionTranslator(context.language),
      slot: this.slot,
      language: () => this.#language,
      runsNodes: () => this.#runsNodes,
      commands: {
        program: (language) => void this.#program(language),
        step: () => this.#step(),
        again: () => void this.#again(),
        next: (name) => void this.start(name),
        list: () => void this.openList(),
        leave: () => void context.actions.endMission(),
      },
    });
    this.#card.render(state);
  }

  #removeCard() {
    this.#card?.destroy();
    this.#card = null;
  }

  /** Another mission is open. @param {import("../state/mission.js").Mission} mission */
  #begin(mission) {
    this.#name = mission.name;
    this.#context?.program.node?.leave();
    this.#document = "";
    this.#noted = "";
    const kept = this.progress.language(mission.name) ?? this.#language; // or that of the mission before
    const wanted = mission.languages.length === 1 ? mission.languages[0] : kept;
    this.#language = null;
    this.#context?.program.redraw();
    if (wanted !== null && mission.languages.includes(wanted)) void this.#program(wanted);
  }

  /** Open the pupil's program of a language: as it was left, or the one to start with. @param {string} language */
  async #program(language) {
    const context = /** @type {Context} */ (this.#context);
    const { mission, robots } = context.store.state;
    if (mission === null) return;
    this.#language = language;
    this.progress.keepLanguage(mission.name, language);
    if (mission.robot in robots) context.store.dispatch({ type: "select", robot: mission.robot });
    context.scene.invalidate();
    if (language === NODE) {
      this.#runsNodes = await context.program.mayRunNodes();
      context.scene.invalidate();
      if (!this.#runsNodes || this.#language !== NODE || this.#name !== mission.name) return;
    }
    const text = this.progress.program(mission.name, language) ?? mission.programs[language] ?? null;
    this.#document = ""; // until the program is open: what is written now belongs to another one
    const { toolbox } = mission;
    const isLimited = toolbox.hide.length > 0 || toolbox.modes !== null;
    const title = missionText(mission, context.language, "title");
    this.#document = await context.program.openAs(language, title, text, isLimited ? toolbox : null);
  }

  /** The next step of the solution in words; null: the program has all of it. */
  async #step() {
    const { store, program, language } = /** @type {Context} */ (this.#context);
    const kind = this.#language ?? "";
    const solution = store.state.mission?.solutions[kind];
    if (this.#module === null || solution === undefined) return null;
    return this.#module.nextStep({ kind, solution, own: kind === NODE && !this.#runsNodes ? "" : program.text, language });
  }

  /** Keep what the pupil has written. @param {string} document @param {string} text */
  #keep(document, text) {
    if (this.#name === "" || this.#language === null || document !== this.#document) return;
    this.progress.keepProgram(this.#name, this.#language, text);
  }

  /** Begin another try, with the same program. */
  async #again() {
    const { actions, store, program } = /** @type {Context} */ (this.#context);
    if (this.#language === NODE && this.#runsNodes && !program.node?.isRunning) return program.run();
    await actions.reset();
    if (store.state.simulator?.paused) await actions.pause(false);
  }

  /** Note the stars of a try that is over. @param {State} state */
  #note(state) {
    const attempt = attemptOf(state);
    if (attempt?.state !== "passed") return;
    const key = `${attempt.mission} ${attempt.tries}`;
    if (key === this.#noted) return;
    this.#noted = key;
    this.progress.note(attempt.mission, attempt.stars.filter((has) => has).length);
  }

  /** @returns {Promise<Module | null>} */
  async #load() {
    this.#isLoading = true;
    this.#module ??= await import("../missions/index.js").catch(() => null);
    if (this.#module === null && this.#context !== null) {
      const { store, text } = this.#context;
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
    }
    return this.#module;
  }
}
