// One connection of the Foxglove protocol without I/O: received frames become events, outgoing frames
// are passed to `send`. `client.js` connects it to a WebSocket, tests to a list. Topics, services and parameters have
// their names without namespace; `namespace.js` converts them to full names.

import { decode, encode } from "./cdr.js";
import { messageFrame, parseFrame, serviceRequestFrame } from "./frames.js";
import { Namespace } from "./namespace.js";
import { parseSchema } from "./ros2msg.js";

/** @typedef {import("./ros2msg.js").Definition} Definition */
/** @typedef {{ id: number, topic: string, encoding: string, schemaName: string, schema: string }} Channel */
/** @typedef {{ encoding: string, schemaName: string, schemaEncoding: string, schema: string }} MessageType */
/** @typedef {{ id: number, name: string, type: string, request: MessageType, response: MessageType }} Service */
/** @typedef {{ name: string, value?: any, type?: string }} Parameter */
/** @typedef {{ level: number, message: string, id?: string }} Status */

/**
 * @typedef {{ type: "serverInfo", name: string, sessionId: string, capabilities: string[], readOnly: boolean }
 *   | { type: "channels", topics: string[] }
 *   | { type: "services", names: string[] }
 *   | { type: "message", topic: string, value: any, timeNs: bigint }
 *   | { type: "time", timeNs: bigint }
 *   | { type: "parameters", parameters: Parameter[] }
 *   | { type: "status", status: Status }
 *   | { type: "removeStatus", ids: string[] }
 *   | { type: "fault", what: string }} SessionEvent
 */

/** @typedef {{ ok: boolean, value: any, message: string }} ParameterAnswer */
/**
 * `value` is the whole answer; `ok` and `message` are its fields of that name if it has them, else true and "".
 *
 * @typedef {{ ok: boolean, message: string, value?: any }} ServiceAnswer
 */

/** The names of the subprotocol in order of preference; the server chooses. */
export const SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];

export const STATUS_ERROR = 2;

/** @param {string} element  primitive type */
function multiArray(element) {
  return [
    "MultiArrayLayout layout",
    `${element}[] data`,
    "=".repeat(80),
    "MSG: std_msgs/MultiArrayLayout",
    "MultiArrayDimension[] dim",
    "uint32 data_offset",
    "=".repeat(80),
    "MSG: std_msgs/MultiArrayDimension",
    "string label",
    "uint32 size",
    "uint32 stride",
  ].join("\n");
}

/** Definitions of published messages; a server that knows the topic advertises the same. */
const PUBLISHED_SCHEMAS = /** @type {Record<string, string>} */ ({
  "std_msgs/msg/Bool": "bool data",
  "std_msgs/msg/Empty": "",
  "std_msgs/msg/Float32": "float32 data",
  "std_msgs/msg/Int8": "int8 data",
  "std_msgs/msg/ColorRGBA": "float32 r\nfloat32 g\nfloat32 b\nfloat32 a",
  "std_msgs/msg/Float32MultiArray": multiArray("float32"),
  "std_msgs/msg/Int16MultiArray": multiArray("int16"),
  "geometry_msgs/msg/Twist": [
    "Vector3 linear",
    "Vector3 angular",
    "=".repeat(80),
    "MSG: geometry_msgs/Vector3",
    "float64 x",
    "float64 y",
    "float64 z",
  ].join("\n"),
});

export class Session {
  /**
   * @param {object} options
   * @param {(data: string | Uint8Array) => void} options.send
   * @param {(event: SessionEvent) => void} options.emit
   * @param {(topic: string) => boolean} options.wants  whether to subscribe to a topic
   * @param {(topic: string) => number} [options.urgency]   topics with a smaller number are subscribed to first
   * @param {string[]} [options.parameters]             parameters to watch
   */
  constructor({ send, emit, wants, urgency = () => 0, parameters = [] }) {
    this.send = send;
    this.emit = emit;
    this.wants = wants;
    this.urgency = urgency;
    this.watched = parameters;
    this.names = new Namespace();
    /** @type {Map<number, Channel>} */ this.channels = new Map();
    /** @type {Map<number, { channel: Channel, topic: string, definition: Definition }>} */ this.subscriptions = new Map();
    /** @type {Map<string, Service>} */ this.services = new Map();
    /** @type {Map<string, { id: number, definition: Definition }>} */ this.published = new Map();
    /** @type {Map<number, { service: Service, resolve: (answer: ServiceAnswer) => void }>} */ this.calls = new Map();
    /**
     * @type {Map<string, { name: string, refusal: string | null, resolve: (answer: ParameterAnswer) => void }>}
     */
    this.requests = new Map();
    this.nextId = 1;
    /** Whether the server restricts this client to read-only access. */
    this.readOnly = false;
  }

  /** Process one frame of the server: text or binary. @param {string | ArrayBuffer} data */
  receive(data) {
    try {
      if (typeof data === "string") this.#receiveText(JSON.parse(data));
      else this.#receiveBinary(data);
    } catch (error) {
      this.emit({ type: "fault", what: error instanceof Error ? error.message : String(error) });
    }
  }

  /**
   * Publish a message; the channel is advertised on first use. Does nothing on a read-only connection.
   *
   * @param {string} topic
   * @param {string} schemaName
   * @param {Record<string, any>} value
   */
  publish(topic, schemaName, value) {
    if (this.readOnly) return;
    let channel = this.published.get(topic);
    if (channel === undefined) {
      const schema = PUBLISHED_SCHEMAS[schemaName];
      channel = { id: this.nextId++, definition: parseSchema(schemaName, schema) };
      this.published.set(topic, channel);
      this.#sendJson({
        op: "advertise",
        channels: [
          { id: channel.id, topic: this.names.outer(topic), encoding: "cdr", schemaName, schema, schemaEncoding: "ros2msg" },
        ],
      });
    }
    this.send(messageFrame(channel.id, encode(channel.definition, value)));
  }

  /**
   * Call a service of any type.
   *
   * @param {string} name
   * @param {Record<string, any>} request
   * @returns {Promise<ServiceAnswer>}
   */
  call(name, request = {}) {
    const service = this.services.get(this.names.outer(name));
    if (service === undefined) return Promise.resolve({ ok: false, message: `${name} is not available` });
    const callId = this.nextId++;
    try {
      const definition = parseSchema(service.request.schemaName, service.request.schema);
      const frame = serviceRequestFrame(service.id, callId, "cdr", encode(definition, request));
      return new Promise((resolve) => {
        this.calls.set(callId, { service, resolve });
        this.send(frame);
      });
    } catch (error) {
      return Promise.resolve({ ok: false, message: `${name}: ${error instanceof Error ? error.message : error}` });
    }
  }

  /**
   * Set parameters. A rejection arrives as an error status named `parameter:<name>` before the answer; the
   * result is about the last parameter of the list.
   *
   * @param {Parameter[]} parameters
   * @returns {Promise<ParameterAnswer>}
   */
  setParameters(parameters) {
    const id = `set-${this.nextId++}`;
    return new Promise((resolve) => {
      const { name } = parameters[parameters.length - 1];
      this.requests.set(id, { name, refusal: null, resolve });
      const named = parameters.map((parameter) => ({ ...parameter, name: this.names.outer(parameter.name) }));
      this.#sendJson({ op: "setParameters", parameters: named, id });
    });
  }

  /** The connection has ended: pending requests fail. */
  close() {
    for (const { resolve } of this.calls.values()) resolve({ ok: false, message: "connection lost" });
    for (const { resolve } of this.requests.values())
      resolve({ ok: false, value: undefined, message: "connection lost" });
    this.calls.clear();
    this.requests.clear();
  }

  /** @param {any} message */
  #receiveText(message) {
    const handler = TEXT_HANDLERS[message.op];
    if (handler !== undefined) handler(this, message);
  }

  /** @param {ArrayBuffer} data */
  #receiveBinary(data) {
    const frame = parseFrame(data);
    if (frame.op === "time") this.emit({ type: "time", timeNs: frame.timeNs });
    else if (frame.op === "message") {
      const subscription = this.subscriptions.get(frame.subscriptionId);
      if (subscription === undefined) return; // was still in transit when we unsubscribed
      const value = decode(subscription.definition, frame.payload);
      this.emit({ type: "message", topic: subscription.topic, value, timeNs: frame.timeNs });
    } else if (frame.op === "serviceResponse") {
      const call = this.calls.get(frame.callId);
      if (call === undefined) return;
      this.calls.delete(frame.callId);
      const { schemaName, schema } = call.service.response;
      try {
        const value = decode(parseSchema(schemaName, schema), frame.payload);
        call.resolve({ ok: value.success ?? true, message: value.message ?? "", value });
      } catch (error) {
        call.resolve({ ok: false, message: "the answer cannot be decoded" });
        throw error;
      }
    }
  }

  /** @param {Channel[]} channels */
  advertise(channels) {
    for (const channel of channels) this.channels.set(channel.id, channel);
    const isRenamed = this.names.choose([...this.channels.values()].map(({ topic }) => topic));
    if (isRenamed) this.#forgetNames();
    this.#emitChannels(); // first: what is wanted depends on how many robots there are
    this.refresh();
    if (!isRenamed) return;
    this.emitServices();
    this.watchParameters();
  }

  /** The namespace has changed: all names are different. */
  #forgetNames() {
    const subscriptionIds = [...this.subscriptions.keys()];
    if (subscriptionIds.length > 0) this.#sendJson({ op: "unsubscribe", subscriptionIds });
    this.subscriptions.clear();
    this.published.clear();
  }

  /** Call when `wants` may return other results: updates the subscriptions. */
  refresh() {
    const unwanted = [...this.subscriptions].filter(([, { topic }]) => !this.wants(topic)).map(([id]) => id);
    for (const id of unwanted) this.subscriptions.delete(id);
    if (unwanted.length > 0) this.#sendJson({ op: "unsubscribe", subscriptionIds: unwanted });
    const subscribed = new Set([...this.subscriptions.values()].map(({ channel }) => channel.id));
    this.#subscribe([...this.channels.values()].filter(({ id }) => !subscribed.has(id)));
  }

  /** Subscribe to the wanted channels among these. @param {Channel[]} channels */
  #subscribe(channels) {
    const subscriptions = [];
    const named = channels.map((channel) => ({ channel, topic: this.names.inner(channel.topic) ?? "" }));
    const wanted = named.filter(({ channel, topic }) => channel.encoding === "cdr" && topic !== "" && this.wants(topic));
    for (const { channel, topic } of wanted.sort((one, other) => this.urgency(one.topic) - this.urgency(other.topic))) {
      const definition = this.#definitionOf(channel);
      if (definition === null) continue;
      const id = this.nextId++;
      this.subscriptions.set(id, { channel, topic, definition });
      subscriptions.push({ id, channelId: channel.id });
    }
    if (subscriptions.length > 0) this.#sendJson({ op: "subscribe", subscriptions });
  }

  /** @param {number[]} ids */
  unadvertise(ids) {
    for (const id of ids) this.channels.delete(id);
    for (const [id, { channel }] of this.subscriptions) {
      if (ids.includes(channel.id)) this.subscriptions.delete(id);
    }
    this.#emitChannels();
  }

  /** Request the watched parameters, and subscribe to their changes. */
  watchParameters() {
    if (this.watched.length === 0) return;
    const parameterNames = this.watched.map((name) => this.names.outer(name));
    this.#sendJson({ op: "subscribeParameterUpdates", parameterNames });
    this.#sendJson({ op: "getParameters", parameterNames, id: "watched" });
  }

  /** Store a channel. An invalid schema disables only its own channel. @param {Channel} channel */
  #definitionOf({ topic, schemaName, schema }) {
    try {
      return parseSchema(schemaName, schema);
    } catch (error) {
      this.emit({ type: "fault", what: `${topic}: ${error instanceof Error ? error.message : error}` });
      return null;
    }
  }

  #emitChannels() {
    const topics = this.innerNames([...this.channels.values()].map((channel) => channel.topic));
    this.emit({ type: "channels", topics: topics.sort() });
  }

  emitServices() {
    this.emit({ type: "services", names: this.innerNames([...this.services.keys()]).sort() });
  }

  /** The page's names of those that belong to the suite. @param {string[]} names */
  innerNames(names) {
    return names.map((name) => this.names.inner(name)).filter((name) => name !== null);
  }

  /** @param {object} message */
  #sendJson(message) {
    this.send(JSON.stringify(message));
  }
}

/** Handlers of the server's JSON messages; unknown ones are ignored. */
const TEXT_HANDLERS = /** @type {Record<string, (session: Session, message: any) => void>} */ ({
  serverInfo(session, { name, sessionId = "", capabilities = [], metadata = {} }) {
    session.names.prefer(metadata.namespace ?? "");
    session.readOnly = metadata.access === "read_only";
    session.emit({ type: "serverInfo", name, sessionId, capabilities, readOnly: session.readOnly });
    if (capabilities.includes("parameters")) session.watchParameters();
  },
  advertise: (session, { channels }) => session.advertise(channels),
  unadvertise: (session, { channelIds }) => session.unadvertise(channelIds),
  advertiseServices(session, { services }) {
    for (const service of services) session.services.set(service.name, service);
    session.emitServices();
  },
  unadvertiseServices(session, { serviceIds }) {
    for (const [name, service] of session.services) {
      if (serviceIds.includes(service.id)) session.services.delete(name);
    }
    session.emitServices();
  },
  parameterValues(session, { parameters: reported, id }) {
    const parameters = reported.flatMap((/** @type {Parameter} */ parameter) => {
      const name = session.names.inner(parameter.name);
      return name === null ? [] : [{ ...parameter, name }];
    });
    session.emit({ type: "parameters", parameters });
    const request = session.requests.get(id);
    if (request === undefined) return;
    session.requests.delete(id);
    const value = parameters.find((/** @type {Parameter} */ parameter) => parameter.name === request.name)?.value;
    request.resolve({ ok: request.refusal === null, value, message: request.refusal ?? "" });
  },
  status(session, { level, message: reported, id }) {
    const message = session.names.inner(reported) ?? reported; // it may start with the name of a parameter
    session.emit({ type: "status", status: id === undefined ? { level, message } : { level, message, id } });
    if (level < STATUS_ERROR) return;
    for (const request of session.requests.values()) {
      if (id === `parameter:${session.names.outer(request.name)}`) request.refusal = message;
    }
  },
  removeStatus: (session, { statusIds }) => session.emit({ type: "removeStatus", ids: statusIds }),
  serviceCallFailure(session, { callId, message }) {
    session.calls.get(callId)?.resolve({ ok: false, message });
    session.calls.delete(callId);
  },
});
