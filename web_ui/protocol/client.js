// The WebSocket of a `Session`: connects, and reconnects every second. If the server requires another token,
// it stops reconnecting.
//
// Browsers do not say why a WebSocket does not open. If the server of the page answers all the while, several times, it
// is something in between that passes HTTP only, such as a proxy without the upgrade.

import { tokenProtocols } from "../browser/access_token.js";
import { Session, SUBPROTOCOLS } from "./session.js";

/** @typedef {import("./session.js").SessionEvent} SessionEvent */
/** @typedef {import("./session.js").ServiceAnswer} ServiceAnswer */
/** @typedef {import("./session.js").ParameterAnswer} ParameterAnswer */
/**
 * @typedef {SessionEvent | { type: "connecting", address: string } | { type: "connected" }
 *   | { type: "disconnected", isBlocked: boolean } | { type: "refused", withToken: boolean }} ClientEvent
 */

const RETRY_MS = 1000;

/** Attempts after which a connection counts as blocked; a server may start between an attempt and a request. */
const BLOCKED_ATTEMPTS = 3;

/** Id of the status of a server that requires a token, or another one: it says so before it closes the connection, with a
 * close code that not every proxy passes on. */
const ACCESS = "access";

export class Client {
  /**
   * @param {object} options
   * @param {string} options.address                 ws://host:port
   * @param {string} [options.token]                 access token; "" is none
   * @param {(event: ClientEvent) => void} options.emit
   * @param {(topic: string) => boolean} options.wants
   * @param {(topic: string) => number} options.urgency   topics with a smaller number are subscribed to first
   * @param {string[]} options.parameters
   * @param {() => Promise<boolean>} options.isServed     whether the server of the page answers
   */
  constructor({ address, token = "", emit, wants, urgency, parameters, isServed }) {
    this.address = address;
    this.token = token;
    this.emit = emit;
    this.wants = wants;
    this.urgency = urgency;
    this.parameters = parameters;
    this.isServed = isServed;
    /** Attempts in a row that have failed although the server answers. */
    this.blocked = 0;
    /** @type {Session | null} */ this.session = null;
  }

  /** Connect, and keep connecting for as long as the page is open. */
  start() {
    this.emit({ type: "connecting", address: this.address });
    const socket = new WebSocket(this.address, [...SUBPROTOCOLS, ...tokenProtocols(this.token)]);
    socket.binaryType = "arraybuffer";
    let isRefused = false;
    const emit = (/** @type {SessionEvent} */ event) => {
      isRefused ||= event.type === "status" && event.status.id === ACCESS;
      this.emit(event);
    };
    socket.addEventListener("open", () => {
      this.blocked = 0;
      this.session = new Session({
        send: (data) => socket.send(/** @type {string | BufferSource} */ (data)),
        emit,
        wants: this.wants,
        urgency: this.urgency,
        parameters: this.parameters,
      });
      this.emit({ type: "connected" });
    });
    socket.addEventListener("message", ({ data }) => this.session?.receive(data));
    socket.addEventListener("close", async () => {
      if (this.session === null) this.blocked = (await this.isServed()) ? this.blocked + 1 : 0;
      this.session?.close();
      this.session = null;
      this.emit({ type: "disconnected", isBlocked: this.blocked >= BLOCKED_ATTEMPTS });
      if (isRefused) return this.emit({ type: "refused", withToken: this.token !== "" });
      setTimeout(() => this.start(), RETRY_MS);
    });
  }

  /** Call when `wants` may return other results. */
  refresh() {
    this.session?.refresh();
  }

  /** @param {string} topic @param {string} schemaName @param {Record<string, any>} value */
  publish(topic, schemaName, value) {
    this.session?.publish(topic, schemaName, value);
  }

  /** @param {string} name @param {Record<string, any>} [request] @returns {Promise<ServiceAnswer>} */
  call(name, request) {
    return this.session?.call(name, request) ?? Promise.resolve({ ok: false, message: "not connected" });
  }

  /** @param {import("./session.js").Parameter[]} parameters @returns {Promise<ParameterAnswer>} */
  setParameters(parameters) {
    return (
      this.session?.setParameters(parameters) ??
      Promise.resolve({ ok: false, value: undefined, message: "not connected" })
    );
  }
}
