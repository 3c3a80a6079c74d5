// User actions, as messages, service calls and parameters. No DOM and no 3D scene.

import { startOf } from "../move/start.js";
import { timeDisabledReason } from "../state/disabled_reason.js";
import { FILE, targets } from "../state/index.js";
import { PARAMETERS, robotTopic } from "../state/names.js";
import { kindOf, sentenceOf } from "../browser/foreign_files.js";
import { isPython } from "../browser/python_name.js";
import { textOf } from "../browser/text_file.js";
import { learnParts } from "../playground/parts.js";
import { textRequest } from "./check_service.js";
import { RuntimeClient } from "./runtime_client.js";

/** @typedef {import("../protocol/client.js").Client} Client */
/** @typedef {import("../state/store.js").Store} Store */

/** From rcl_interfaces/msg/ParameterType. */
const NOT_SET = 0;
const STRING = 4;
const DOUBLE_ARRAY = 8;
const MB = 1_000_000;
/** Maximum size of a program file in bytes. */
export const LARGEST_PROGRAM = 1_000_000;
/**
 * Maximum size of a playground file in bytes. It may contain images, and as text it must fit into one message of the
 * bridge.
 */
export const LARGEST_PLAYGROUND = 3_000_000;

/**
 * Longer than the 20 ms between two button polls even at a quarter of real time (docs/spec/thymio-robot.md section 3).
 */
const SHORTEST_PRESS_MS = 120;

/** The reason for which the simulator does not place something: the name of what is there. */
const OCCUPIED = /: occupied by '(.*)'$/s;

/** The service that has the log of the run. */
export const RUN_LOG = "/simulator/get_run_log";
/** The service that starts a mission. */
export const START_MISSION = "/simulator/start_mission";
export const CHECK_MISSION = "/simulator/check_mission";
/** The service that has the primitives of shapes. */
export const PRIMITIVES = "/simulator/get_primitives";

/** File kinds by file name extension. */
const KINDS = { program: /\.(aesl|aseba|txt)$/i, playground: /\.(json|playground|xml|zip)$/i };

/** What `kindOf` says of files that are loaded as a program, and as a playground. */
const PROGRAMS = ["", "program"];
const PLAYGROUNDS = ["", "playground", "archive", "json"];

/** @param {{ name: string }} file */
export function isProgram({ name }) {
  return KINDS.program.test(name);
}

export class Actions {
  /**
   * @param {object} options
   * @param {Client} options.client
   * @param {Store} options.store
   * @param {(key: string, values?: Record<string, any>) => string} options.t
   * @param {() => string} options.language  language of the page
   * @param {() => number} [options.now]  clock in milliseconds
   * @param {(act: () => void, ms: number) => void} [options.later]
   */
  constructor({ client, store, t, language, now = () => performance.now(), later = setTimeout.bind(globalThis) }) {
    this.client = client;
    /** Requests to the Aseba runtime: the one way to load programs. */
    this.runtime = new RuntimeClient(client);
    this.store = store;
    this.t = t;
    this.language = language;
    this.now = now;
    this.later = later;
    /** @type {import("../python/node_client.js").NodeClient | null} the ROS node of this page */ this.node = null;
    /** @type {Map<string, number>} time of the press, by topic of the button */ this.pressTimes = new Map();
    /** @type {Map<string, readonly string[]>} robots on which the pad holds a button, by button */ this.held = new Map();
  }

  /** The robot that programs are loaded into; null: all robots. @returns {string | null} */
  get owner() {
    const { robots, selected, toAll } = this.store.state;
    return toAll || Object.keys(robots).length < 2 ? null : selected;
  }

  /**
   * Press or release a button of a robot. The robot polls its buttons, so a touch that is too short to be seen is
   * prolonged.
   *
   * @param {string} robot
   * @param {string} button
   * @param {boolean} pressed
   */
  press(robot, button, pressed) {
    const topic = robotTopic(robot, `_press/${button}`);
    const since = this.pressTimes.get(topic);
    const send = () => this.client.publish(topic, "std_msgs/msg/Bool", { data: pressed });
    if (pressed) {
      this.pressTimes.set(topic, this.now());
      return send();
    }
    const rest = since === undefined ? 0 : since + SHORTEST_PRESS_MS - this.now();
    if (rest <= 0) return send();
    this.later(() => {
      if (this.pressTimes.get(topic) === since) send(); // else it has been pressed again
    }, rest);
  }

  /**
   * Press or release a button of the addressed robots; it is released on those on which it was pressed.
   *
   * @param {string} button
   * @param {boolean} pressed
   */
  pressPad(button, pressed) {
    const robots = (pressed ? null : this.held.get(button)) ?? targets(this.store.state);
    if (pressed) this.held.set(button, robots);
    else this.held.delete(button);
    for (const robot of robots) this.press(robot, button, pressed);
  }

  /**
   * Apply a stimulus to the addressed robots.
   *
   * @param {string} name    topic relative to the robot
   * @param {string} type
   * @param {Record<string, any>} value
   */
  operate(name, type, value) {
    for (const robot of targets(this.store.state)) this.client.publish(robotTopic(robot, name), type, value);
  }

  /** Stop the addressed robots: their programs, and their wheels. */
  async stop() {
    this.node?.stop();
    const { services, robots } = this.store.state;
    const stops =
      this.owner === null ? services.filter((name) => name.endsWith("/aseba/stop")) : [this.programService("stop")];
    await Promise.all(stops.map((name) => this.call(name)));
    for (const robot of this.owner === null ? Object.keys(robots) : [this.owner]) {
      this.client.publish(robotTopic(robot, "cmd_vel"), "geometry_msgs/msg/Twist", {});
    }
  }

  /** Run, stop or reset the programs of the addressed robots. @param {"run" | "stop" | "reset"} verb */
  async program(verb) {
    const services = new Set(targets(this.store.state).map((robot) => this.programService(verb, robot)));
    await Promise.all([...services].map((service) => this.call(service)));
  }

  /**
   * The name of that service.
   *
   * @param {"run" | "stop" | "reset"} verb
   * @param {string} [robot]  without it, the selected one
   */
  programService(verb, robot = this.store.state.selected) {
    const own = robotTopic(robot, `aseba/${verb}`);
    return this.store.state.services.includes(own) ? own : `/aseba/${verb}`;
  }

  /** Pause time or let it run; a teacher's pause holds. @param {boolean} paused */
  async pause(paused) {
    const held = timeDisabledReason(this.store.state, this.t);
    if (held !== "") return this.store.dispatch({ type: "notice", level: "info", text: held });
    await this.call("/simulator/pause", { data: paused });
  }

  /** Run a number of ticks of 10 ms while the simulation is paused. @param {number} ticks */
  async step(ticks) {
    const chosen = await this.client.setParameters([{ name: PARAMETERS.stepTicks, value: ticks }]);
    if (!chosen.ok) return this.#report("/simulator/step", chosen);
    await this.call("/simulator/step");
  }

  /** Reset the world. The node of this page begins anew, as programs of robots do. */
  async reset() {
    const { node } = this;
    if (node?.isRunning) node.again(() => this.call("/simulator/reset"));
    else await this.call("/simulator/reset");
  }

  /** @param {number} factor  1: real time */
  async setFactor(factor) {
    const answer = await this.client.setParameters([{ name: PARAMETERS.factor, value: factor, type: "float64" }]);
    this.#report(PARAMETERS.factor, answer);
  }

  /**
   * Move a robot or an object; returns whether the simulator accepted the pose.
   *
   * @param {string} name   name in the world
   * @param {{ x: number, y: number, yaw: number }} pose  meters, radians
   */
  async place(name, { x, y, yaw }) {
    const value = { type: DOUBLE_ARRAY, double_array_value: [x, y, yaw] };
    const answer = await this.client.call("/simulator/set_poses", { parameters: [{ name, value }] });
    const result = answer.value?.results?.[0] ?? { successful: answer.ok, reason: answer.message };
    if (!result.successful) {
      const by = OCCUPIED.exec(result.reason)?.[1];
      const text = by === undefined ? this.t("move.refused") : this.t("move.refusedBy", { by });
      this.#report("/simulator/set_poses", { ok: false, message: result.reason }, text);
    } else {
      this.#report("/simulator/set_poses", { ok: true, message: "" });
      if (this.store.state.simulator?.paused) {
        this.store.dispatch({ type: "notice", level: "info", text: this.t("move.paused") });
      }
    }
    return result.successful;
  }

  /** Return a fallen robot to its start pose, or next to it if that is occupied. @param {string} robot  in topics */
  async putBack(robot) {
    const text = await this.playgroundText();
    if (text === null) return;
    const name = this.store.state.simulator?.worldNames[robot] ?? robot;
    await this.place(name, startOf(this.store.state, text, name));
  }

  /**
   * Start a mission: a shipped one by its name, or that of a file (JSON, or a ZIP archive). Returns whether it was started.
   * If not, a notice says why, with the place in the file; the mission before goes on, unless the playground was replaced.
   *
   * @param {string} name
   * @param {Uint8Array} [content]   of a file
   */
  async startMission(name, content) {
    const value = content === undefined ? { type: NOT_SET } : { type: STRING, string_value: dataUrl(name, content) };
    const answer = await this.client.call(START_MISSION, { parameters: [{ name, value }] });
    const { successful, reason } = answer.value?.results?.[0] ?? { successful: answer.ok, reason: answer.message };
    this.#report(START_MISSION, { ok: successful, message: reason }, this.t("mission.refused"));
    if (successful && this.store.state.simulator?.paused) await this.pause(false);
    return successful;
  }

  /**
   * Run the solutions of a mission in the simulator. Returns those that do not get all stars, by language with what they
   * get, and why they cannot run, else "".
   *
   * @param {string} name
   * @param {Uint8Array} content   of its file
   * @returns {Promise<{ failing: Record<string, boolean[]>, reason: string }>}
   */
  async checkMission(name, content) {
    const value = { type: STRING, string_value: dataUrl(name, content) };
    const answer = await this.client.call(CHECK_MISSION, { parameters: [{ name, value }] });
    const { successful, reason } = answer.value?.results?.[0] ?? { successful: answer.ok, reason: answer.message };
    return successful ? { failing: JSON.parse(reason || "{}"), reason: "" } : { failing: {}, reason };
  }

  endMission() {
    return this.call("/simulator/end_mission");
  }

  /** Start a built-in behavior on the addressed robots. @param {string} name */
  async loadExample(name) {
    const answer = await this.runtime.loadBuiltIn(this.owner, name, this.language());
    this.#report(PARAMETERS.behavior, answer);
    return answer;
  }

  /**
   * Load a program into the addressed robots; it starts at once.
   *
   * @param {string} name
   * @param {string} text
   * @returns {Promise<import("./runtime_client.js").Loaded>}
   */
  load(name, text) {
    return this.runtime.load(this.owner, name, text, this.language());
  }

  /** Send what a pupil has written to the class, which collects it (docs/classroom.md). @param {string} name @param {string} text */
  async sendDraft(name, text) {
    const { connection, parameters, readOnly } = this.store.state;
    if (connection !== "connected" || readOnly || !parameters[PARAMETERS.pupil]) return;
    const parameter = isPython(name) ? PARAMETERS.nodeDraft : PARAMETERS.draft;
    await this.client.setParameters([{ name: parameter, value: text }]);
  }

  /** Raise a hand, which the teacher of the class sees, or lower it. @param {boolean} raised */
  async raiseHand(raised) {
    this.#report(PARAMETERS.raisedHand, await this.client.setParameters([{ name: PARAMETERS.raisedHand, value: raised }]));
  }

  /** Load a program file, and note in the state what became of it. @param {string} name @param {string} text */
  async loadProgram(name, text) {
    this.store.dispatch({ type: "upload", what: "program", name, text });
    const { ok, message, fault } = await this.load(name, text);
    this.store.dispatch({ type: "uploaded", what: "program", message: ok ? null : message, fault });
  }

  /**
   * @param {string} name
   * @param {Uint8Array} [content]  content of a file; without it, `name` is a shipped playground
   * @param {string} [part]   name of one of several playgrounds in an archive
   */
  async loadPlayground(name, content, part = "") {
    this.store.dispatch({ type: "upload", what: "playground", name, text: "" });
    const value = content === undefined ? name : dataUrl(name, content, part);
    const isPresent = this.store.state.parameters[PARAMETERS.playground] === value;
    const answer = await this.client.setParameters([{ name: PARAMETERS.playground, value }]);
    if (answer.ok && isPresent) await this.reset();
    this.store.dispatch({ type: "uploaded", what: "playground", message: answer.ok ? null : answer.message });
  }

  /** The running playground as JSON text; null if the simulator does not report it. */
  async playgroundText() {
    const answer = await this.client.call("/simulator/get_playground");
    this.#report("/simulator/get_playground", answer);
    return answer.ok ? answer.message : null;
  }

  /**
   * Ask the simulator how it builds items of a playground; returns whether it has answered.
   *
   * @param {readonly import("../playground/parts.js").Item[]} items
   */
  learnParts(items) {
    return learnParts(items, async (shapes) => {
      const { value } = await this.client.call(PRIMITIVES, textRequest({ shapes }));
      const [answer] = value?.results ?? [];
      return answer?.successful ? answer.reason : null;
    });
  }

  /** The log of the run since its last reset, a gzip file; null if the simulator does not give it. */
  async runLog() {
    const answer = await this.client.call(RUN_LOG);
    this.#report(RUN_LOG, answer);
    return answer.ok ? Uint8Array.from(atob(answer.message), (letter) => letter.charCodeAt(0)) : null;
  }

  /**
   * Load a chosen or dropped file according to its extension.
   *
   * @param {File} file
   * @param {(text: string) => void} [refuse]   shows why it is not even sent
   */
  async loadFile(file, refuse = (text) => this.#refuse(text)) {
    const { name } = file;
    const kind = file.size > LARGEST_PLAYGROUND ? "" : kindOf(new Uint8Array(await file.arrayBuffer()));
    const isPlayground = KINDS.playground.test(name);
    const isText = isProgram(file) || (kind === "program" && !isPlayground);
    const fits = isText ? PROGRAMS : PLAYGROUNDS;
    if (!fits.includes(kind)) return refuse(`${name}: ${sentenceOf(kind, this.language())}`);
    const most = isText ? LARGEST_PROGRAM : LARGEST_PLAYGROUND;
    const isTooLarge = file.size > most;
    const tooLarge = this.t("file.tooLarge", { name, size: most / MB });
    if (isText) {
      if (isTooLarge) return refuse(tooLarge);
      const text = await textOf(file);
      if (text === null) return refuse(this.t("file.notText", { name }));
      await this.loadProgram(file.name, text);
    } else if (isPlayground) {
      if (isTooLarge) return refuse(tooLarge);
      await this.loadPlayground(file.name, new Uint8Array(await file.arrayBuffer()));
    } else refuse(this.t("file.unknown", { name }));
  }

  /** @param {string} text */
  #refuse(text) {
    this.store.dispatch({ type: "notice", level: "error", text, cause: FILE });
  }

  /** @param {string} service @param {Record<string, any>} [request] */
  async call(service, request) {
    this.#report(service, await this.client.call(service, request));
  }

  /**
   * Show an error until the same action succeeds.
   *
   * @param {string} cause
   * @param {{ ok: boolean, message: string }} answer   message: in English
   * @param {string} [text]   what failed, in the language of the page
   */
  #report(cause, { ok, message: technical }, text = this.t("action.refused")) {
    this.store.dispatch({ type: "solved", cause });
    if (!ok) this.store.dispatch({ type: "notice", level: "error", text, technical, cause });
  }
}

/** A file as a text. @param {string} name @param {Uint8Array} content @param {string} [part]  name of one of several files in it */
function dataUrl(name, content, part = "") {
  const chosen = part === "" ? "" : `;part=${encodeURIComponent(part)}`;
  return `data:application/octet-stream;name=${encodeURIComponent(name)}${chosen};base64,${base64(content)}`;
}

/** @param {Uint8Array} bytes */
function base64(bytes) {
  const step = 0x8000; // few enough to be arguments of one call
  let text = "";
  for (let from = 0; from < bytes.length; from += step) {
    text += String.fromCharCode(...bytes.subarray(from, from + step));
  }
  return btoa(text);
}
