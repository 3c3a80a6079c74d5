// A ROS node that the suite runs for this page: a WebSocket beside that of the bridge (thymio_sim_ros/page_nodes/server.py).
// No DOM.

import { tokenProtocols } from "../browser/access_token.js";

/** Characters of the output that are kept: its end. */
const MOST_OUTPUT = 60_000;
const PERMISSION = "page-node.json";
/** Path and sub-protocol. */
const SOCKET = "page-node";

/** @typedef {{ name: string, text: string, namespace: string, sim_time: boolean }} NodeProgram   sim_time: its time is simulated */
/**
 * How a node has ended: `code` of its process, null if it was ended; `reason`: "" by itself or by the user, else a word
 * (page_nodes/server.py); `text`: more in English.
 *
 * @typedef {{ code: number | null, reason: string, text: string }} End
 */
/** @typedef {Pick<WebSocket, "send" | "close"> & { onopen: any, onmessage: any, onclose: any }} Socket */

/**
 * Output with a further part; a long one loses its begin.
 *
 * @param {string} output
 * @param {string} part
 */
export function appended(output, part) {
  const all = output + part;
  if (all.length <= MOST_OUTPUT) return all;
  const end = all.slice(-MOST_OUTPUT);
  const line = end.indexOf("\n");
  return `…\n${line < 0 ? end : end.slice(line + 1)}`;
}

export class NodeClient {
  /** @type {Socket | null} */ #socket = null;
  /** @type {() => Promise<unknown>} */ #prepare = async () => {};

  /**
   * @param {object} options
   * @param {string} options.page     address of the page
   * @param {string} options.token    "" for none
   * @param {() => void} options.changed
   * @param {typeof fetch} [options.load]
   * @param {(address: string, protocols: string[]) => Socket} [options.open]
   */
  constructor({
    page,
    token,
    changed,
    load = fetch.bind(globalThis),
    open = (address, protocols) => new WebSocket(address, protocols),
  }) {
    this.page = page;
    this.token = token;
    this.changed = changed;
    this.load = load;
    this.open = open;
    /** @type {"idle" | "starting" | "running" | "stopping"} */ this.state = "idle";
    /** What the page may do: a word of page_nodes/who.py, "none" where the server runs no nodes, "" not known yet. */
    this.right = "";
    this.mayRun = false;
    /** @type {NodeProgram | null} the last one */ this.program = null;
    this.output = "";
    /** @type {End | null} null: it runs, or none has run */ this.end = null;
  }

  get isRunning() {
    return this.state !== "idle";
  }

  /** Ask what the page may do. */
  async learn() {
    try {
      /** @type {Record<string, string>} */ const headers = this.token === "" ? {} : { Authorization: `Bearer ${this.token}` };
      const answer = await this.load(new URL(PERMISSION, this.page), { headers, cache: "no-store" });
      const { right, may_run: mayRun } = await answer.json();
      this.right = String(right) || "none";
      this.mayRun = mayRun === true;
    } catch {
      this.right = "none";
      this.mayRun = false;
    }
    this.changed();
  }

  /**
   * Run a program; the one that runs ends. `prepare` is waited for when all is ready, before the program begins.
   *
   * @param {NodeProgram} program
   * @param {() => Promise<unknown>} [prepare]
   */
  run(program, prepare = async () => {}) {
    this.#leave();
    this.program = program;
    this.#prepare = prepare;
    this.output = "";
    this.end = null;
    this.state = "starting";
    const address = new URL(SOCKET, this.page);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    const socket = this.open(address.href, [SOCKET, ...tokenProtocols(this.token)]);
    this.#socket = socket;
    socket.onopen = () => socket.send(JSON.stringify({ op: "run", ...program }));
    socket.onmessage = (/** @type {{ data: string }} */ { data }) => this.#receive(socket, JSON.parse(data));
    socket.onclose = () => this.#socket === socket && this.#ended({ code: null, reason: "connection", text: "" });
    this.changed();
  }

  /** Run the program of the last time once more. @param {() => Promise<unknown>} [prepare] */
  again(prepare) {
    if (this.program !== null) this.run(this.program, prepare);
  }

  /** End the node as Ctrl-C does. */
  stop() {
    if (this.state === "starting") return this.leave(); // nothing of the program has run
    if (!this.isRunning) return;
    this.state = "stopping";
    this.#socket?.send(JSON.stringify({ op: "stop" }));
    this.changed();
  }

  /** Forget the output; what a node that has ended said of its end, too. */
  clear() {
    this.output = "";
    this.end = null;
    this.changed();
  }

  /** End the node at once, without waiting for it. */
  leave() {
    if (this.isRunning) this.#ended({ code: null, reason: "", text: "" });
  }

  /** @param {Socket} socket @param {any} message */
  #receive(socket, message) {
    if (socket !== this.#socket) return;
    if (message.op === "ready") return void this.#begin(socket);
    if (message.op === "output") this.output = appended(this.output, message.text);
    if (message.op === "ended") {
      const { code = null, reason = "", text = "" } = message;
      return this.#ended({ code, reason, text });
    }
    this.changed();
  }

  /** @param {Socket} socket */
  async #begin(socket) {
    await this.#prepare();
    if (socket !== this.#socket) return; // stopped meanwhile
    socket.send(JSON.stringify({ op: "begin" }));
    if (this.state === "starting") this.state = "running";
    this.changed();
  }

  /** @param {End} end */
  #ended(end) {
    this.#leave();
    this.state = "idle";
    this.end = end;
    this.changed();
  }

  #leave() {
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
  }
}
