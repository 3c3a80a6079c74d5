// Requests to the Aseba runtime: service calls, parameters and messages (docs/aseba_ros.md).

import { robotTopic } from "../state/names.js";
import {
  CHECK_SERVICE,
  checkRequest,
  LOAD_SERVICE,
  readLoaded,
  readVerdict,
  targetRequest,
  textRequest,
} from "./check_service.js";

/** @typedef {import("../protocol/client.js").Client} Client */
/** @typedef {{ ok: boolean, message: string }} Answer */
/** @typedef {"run" | "pause" | "stop" | "step" | "step_line" | "reset"} Verb */

/**
 * What became of a program: `fault` is its first mistake, `message` any other reason; both translated.
 *
 * @typedef {{ ok: boolean, message: string, fault: import("./check_service.js").Fault | null, notes: string[] }} Loaded
 */

const RUNTIME = "/aseba_runtime.";
const INTEGER = 2; // rcl_interfaces/msg/ParameterType
const INTEGER_ARRAY = 7;

export class RuntimeClient {
  /** @param {Client} client */
  constructor(client) {
    this.client = client;
  }

  /** @param {Parameters<typeof checkRequest>[0]} what @returns {Promise<import("./check_service.js").Verdict | null>} */
  async check(what) {
    const { ok, value } = await this.client.call(CHECK_SERVICE, checkRequest(what));
    return ok && value !== undefined ? readVerdict(value) : null;
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
   * Load a program into one robot, or into all for null, and start it; for all, no robot keeps a program of its own.
   *
   * @param {string | null} robot
   * @param {string} name
   * @param {string} source
   * @param {string} language  of the answer
   */
  load(robot, name, source, language) {
    return this.#start(robot, { source, name, language });
  }

  /**
   * Start a built-in behavior on one robot, or on all for null. The menu, which starts the others, is always for all.
   *
   * @param {string | null} robot
   * @param {string} name
   * @param {string} language  of the answer
   */
  loadBuiltIn(robot, name, language) {
    return this.#start(robot, { behaviour: name, language });
  }

  /** @param {string | null} robot @param {Record<string, string>} what @returns {Promise<Loaded>} */
  async #start(robot, what) {
    const request = textRequest(robot === null ? what : { ...what, robot });
    const { ok, message, value } = await this.client.call(LOAD_SERVICE, request);
    return value === undefined ? { ok, message, fault: null, notes: [] } : readLoaded(value);
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
