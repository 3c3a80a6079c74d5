// Requests to the server of the class, with the token of the teacher (thymio_sim_ros/classroom/requests.py).

/** @typedef {{ state: string, program: string, line: string, fault: string }} PupilProgram */
/** @typedef {{ robots?: Record<string, number[]>, objects?: Record<string, number[] | null> }} Overview */
/**
 * @typedef {object} Pupil
 * @property {string} id
 * @property {string} name
 * @property {"waiting" | "starting" | "running" | "broken"} phase  of the pupil's simulator
 * @property {string} reason      why it ended last
 * @property {number} restarts
 * @property {boolean} paused
 * @property {boolean} held       whether the teacher has paused it, which holds
 * @property {number} achieved    real-time factor
 * @property {string[]} fallen
 * @property {PupilProgram[]} programs
 * @property {Overview} overview
 * @property {string} plan        names the playground
 * @property {string} notice      the message on the pupil's page
 * @property {string} hand       when the pupil raised a hand; "": it is not raised
 * @property {string} trouble    in the mission that is open: fallen, stuck, idle, tries (many of them got no further), or ""
 * @property {string} link
 * @property {string} watch       link to watch only
 */
/** @typedef {{ pupils: Pupil[], shown: string | null, has_room: boolean }} ClassState   has_room: whether pupils can choose their names */

/** @typedef {{ address: string, code: string, url: string, qr: string }} Room */

/** The server does not accept the token of this page. */
export class TokenError extends Error {}

export class ClassApi {
  /** @param {string} token */
  constructor(token) {
    this.headers = { Authorization: `Bearer ${token}` };
  }

  /** @returns {Promise<ClassState>} */
  async state() {
    return (await this.#fetch("state")).json();
  }

  /** @param {string} plan @returns {Promise<import("./plan.js").Plan>} */
  async plan(plan) {
    return (await this.#fetch(`plans/${plan}`)).json();
  }

  /** @returns {Promise<{ name: string, url: string, qr: string }[]>} */
  async sheet() {
    return (await this.#fetch("sheet")).json();
  }

  /** The address for pupils with its code, and both as a link with its QR code. @returns {Promise<Room>} */
  async room() {
    return (await this.#fetch("room")).json();
  }

  async programs() {
    return (await this.#fetch("programs.zip")).blob();
  }

  /** Names of the pupils who have no program. @returns {Promise<string[]>} */
  async missing() {
    return (await this.#fetch("missing")).json();
  }

  /** @returns {Promise<import("./handout_table.js").Handout[]>} */
  async handouts() {
    return (await this.#fetch("handouts")).json();
  }

  /**
   * The shipped missions in steps, from the simulator of a pupil; none if it does not answer.
   *
   * @param {string} pupil
   * @returns {Promise<readonly import("../missions/list.js").Step[]>}
   */
  async missions(pupil) {
    const answer = await fetch(`../p/${pupil}/missions.json`).catch(() => null);
    return answer?.ok ? ((await answer.json()).steps ?? []) : [];
  }

  /** A link with which pupils open a hand-out. @param {string} id @returns {Promise<{ name: string, url: string, qr: string }>} */
  async handoutLink(id) {
    return (await this.#fetch(`handouts/${id}`)).json();
  }

  async results() {
    return (await this.#fetch("results.csv")).blob();
  }

  /** @param {import("./hand_out.js").Given} given */
  handOut(given) {
    return this.#post("handout", given);
  }

  /** @param {string} handout  its id */
  takeBack(handout) {
    return this.#post("take_back", { handout });
  }

  /** @param {readonly string[]} pupils */
  lowerHands(pupils) {
    return this.#post("lower", { pupils });
  }

  /** @param {readonly string[] | null} pupils  null: all @param {boolean} paused */
  pause(pupils, paused) {
    return this.#post("pause", { pupils, paused });
  }

  /** @param {readonly string[] | null} pupils @param {string} text */
  message(pupils, text) {
    return this.#post("message", { pupils, text });
  }

  /** @param {readonly string[] | null} pupils */
  restart(pupils) {
    return this.#post("restart", { pupils });
  }

  /** @param {string | null} pupil */
  show(pupil) {
    return this.#post("show", { pupil });
  }

  /** @param {string} action @param {object} fields */
  #post(action, fields) {
    return this.#fetch(action, { method: "POST", body: JSON.stringify(fields) });
  }

  /** @param {string} name @param {RequestInit} [options] */
  async #fetch(name, options = {}) {
    const answer = await fetch(`class/${name}`, { headers: this.headers, ...options });
    if (answer.status === 401 || answer.status === 429) throw new TokenError();
    if (!answer.ok) throw new Error(await answer.text());
    return answer;
  }
}
