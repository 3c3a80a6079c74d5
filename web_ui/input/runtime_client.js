// Requests to the Aseba runtime: service calls, parameters and messages (docs/aseba_ros.md).

import { robotTopic } from "../state/names.js";
import { CHECK_SERVICE, checkRequest, firstFault, notesOf, readVerdict, targetRequest } from "./check_service.js";

/** @typedef {import("../protocol/client.js").Client} Client */
/** @typedef {{ ok: boolean, message: string }} Answer */
/** @typedef {"run" | "pause" | "stop" | "step" | "step_line" | "reset"} Verb */

const RUNTIME = "/aseba_runtime.";
const INTEGER = 2; // rcl_interfaces/msg/ParameterType
const INTEGER_ARRAY = 7;
const PROGRAM = "program ";
const MENU = "menu";

export class RuntimeClient {
  /** @param {Client} client */
  constructor(client) {
    this.client = client;
    /** @type {Map<string | null, string>} The last loaded program or behavior, by robot. */
    this.last = new Map();
  }

  /**
   * Restart programs that are loaded again: setting a parameter to its current value has no effect.
   *
   * @param {string | null} robot
   * @param {string} loaded     kind and content
   * @param {readonly string[]} robots  names of all robots
   */
  async #restartPrograms(robot, loaded, robots) {
    const isSame = this.last.get(robot) === loaded;
    this.last.clear();
    this.last.set(robot, loaded);
    if (!isSame) return;
    if (loaded.startsWith(PROGRAM)) await this.client.setParameters([{ name: `${RUNTIME}behaviour`, value: "" }]);
    for (const verb of /** @type {Verb[]} */ (["reset", "run"])) {
      await Promise.all((robot === null ? robots : [robot]).map((each) => this.control(each, verb)));
    }
  }

  /** @param {Parameters<typeof checkRequest>[0]} what @returns {Promise<import("./check_service.js").Verdict | null>} */
  async check(what) {
    const { ok, value } = await this.client.call(CHECK_SERVICE, checkRequest(what));
    return ok && value !== undefined ? readVerdict(value) : null;
  }

  /** The first error of a file, translated. @param {string} source @param {string} language */
  async fault(source, language) {
    const question = checkRequest({ source, language, events: [], constants: [] });
    const { ok, value } = await this.client.call(CHECK_SERVICE, question);
    return ok && value !== undefined ? firstFault(value) : null;
  }

  /** Notes about the nodes of a file, translated. @param {string} source @param {string} language */
  async notes(source, language) {
    const question = checkRequest({ source, language, events: [], constants: [] });
    const { ok, value } = await this.client.call(CHECK_SERVICE, question);
    return ok && value !== undefined ? notesOf(value) : [];
  }

  /**
   * The names that every robot offers, with translated help.
   *
   * @param {string} language
   * @returns {Promise<import("../editor/state.js").Target | null>}
   */
  async target(language) {
    const { ok, value } = await this.client.call(CHECK_SERVICE, targetRequest(language));
    return ok && value !== undefined ? (JSON.parse(value.result.reason).target ?? null) : null;
  }

  /**
   * Load a program into one robot, or into all for null; robots with their own program lose it.
   *
   * @param {string | null} robot
   * @param {string} name
   * @param {string} source
   * @param {readonly string[]} robots  names of all robots
   * @returns {Promise<Answer>}
   */
  async load(robot, name, source, robots) {
    const { ok, message } = await this.client.setParameters([
      ...this.#released(robot, robots),
      { name: `${prefix(robot)}script.name`, value: name },
      { name: `${prefix(robot)}script.source`, value: source },
    ]);
    if (ok) await this.#restartPrograms(robot, `${PROGRAM}${source}`, robots);
    return { ok, message: message.replace(`${prefix(robot)}script.source: `, "") };
  }

  /**
   * Start a built-in behavior on one robot, or on all for null. The menu, which starts the others, is always for all.
   *
   * @param {string | null} robot
   * @param {string} name
   * @param {readonly string[]} robots
   * @returns {Promise<Answer>}
   */
  async loadBuiltIn(robot, name, robots) {
    const owner = name === MENU ? null : robot;
    const isForSeveral = owner === null && robots.length > 1;
    if (isForSeveral) {
      // Some of them may have left the common behavior: ended first, it starts again on all.
      await this.client.setParameters([...this.#released(null, robots), { name: `${RUNTIME}behaviour`, value: "" }]);
    }
    const parameter = owner === null ? `${RUNTIME}behaviour` : `${prefix(owner)}script.path`;
    const answer = await this.client.setParameters([{ name: parameter, value: name }]);
    if (isForSeveral) this.last.clear();
    else if (answer.ok) await this.#restartPrograms(owner, `behavior ${name}`, robots);
    return answer;
  }

  /** Take the programs of their own from all robots. @param {string | null} robot @param {readonly string[]} robots */
  #released(robot, robots) {
    if (robot !== null || robots.length < 2) return [];
    return robots.flatMap((each) =>
      ["path", "source"].map((kind) => ({ name: `${prefix(each)}script.${kind}`, value: "" })),
    );
  }

  /** @param {string | null} robot @param {number[]} lines  of the file, from 1 @returns {Promise<Answer>} */
  setBreakpoints(robot, lines) {
    return this.client.setParameters([{ name: `${prefix(robot)}breakpoints`, value: lines }]);
  }

  /** @param {string} robot @param {Verb} verb @returns {Promise<Answer>} */
  control(robot, verb) {
    return this.client.call(robotTopic(robot, `aseba/${verb}`));
  }

  /** @param {string} robot @param {string} name @param {number[]} values @returns {Promise<Answer>} */
  async setVariable(robot, name, values) {
    const value =
      values.length === 1
        ? { type: INTEGER, integer_value: values[0] }
        : { type: INTEGER_ARRAY, integer_array_value: values };
    const request = { parameters: [{ name, value }] };
    const answer = await this.client.call(robotTopic(robot, "aseba/set_variables"), request);
    const [result] = answer.value?.results ?? [];
    return result === undefined ? answer : { ok: result.successful, message: result.reason };
  }

  /** @param {string} robot @param {string} event @param {number[]} values */
  emit(robot, event, values) {
    const layout = { dim: [{ label: event, size: values.length, stride: values.length }] };
    this.client.publish(robotTopic(robot, "_aseba/emit"), "std_msgs/msg/Int16MultiArray", { layout, data: values });
  }
}

/** Set parameters of one robot, or of all. @param {string | null} robot */
function prefix(robot) {
  return robot === null ? RUNTIME : `${RUNTIME}robots.${robot}.`;
}
