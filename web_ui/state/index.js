// The page's state and the one function that changes it: `state = reduce(state, message)`.
// Pure: no clock, no socket, no document; a message carries what it needs.

import { applyMarkers } from "./markers.js";
import { PARAMETERS, TRANSFORMS, isSensed, splitTopic } from "./names.js";
import { NEW_ROBOT, readStatus, reduceRobot } from "./robot.js";
import { applyTransforms } from "./transforms.js";

/** @typedef {import("./robot.js").Robot} Robot */
/** @typedef {import("./robot.js").Program} Program */
/** @typedef {import("./markers.js").Marker} Marker */
/** @typedef {{ text: string, line: number | null, column: number | null }} Fault  1-based place, where known */
/**
 * @typedef {object} Upload   something given to the simulator, and what came of it
 * @property {string} name
 * @property {string} text
 * @property {"sending" | "accepted" | "refused"} phase
 * @property {Fault | null} fault
 */
/** @typedef {"program" | "playground"} What */
/** @typedef {{ name: string, description: string }} Behavior */
/** @typedef {{ title: string, description: string }} Titles */
/** @typedef {Titles & { name: string, translations: Readonly<Record<string, Titles>> }} PlaygroundInfo  by language */
/**
 * @typedef {object} Simulator
 * @property {string} playground
 * @property {string} title
 * @property {string[]} notes   what its file says that is left out or looks like a mistake
 * @property {boolean} paused
 * @property {number} factor     wanted
 * @property {number} achieved
 * @property {string[] | null} robots  names; null where it does not say
 * @property {Readonly<Record<string, string>>} worldNames  of the robots, by those in topics
 * @property {string[]} fallen    robots that fell off an edge, by their names in topics
 * @property {string[]} movables  names of things that can be moved
 */
/**
 * What a person is reported beside the thing itself; `cause` names what it is about, so that it goes when that is gone.
 *
 * @typedef {{ id: number, level: "info" | "warning" | "error", text: string, cause: string }} Notice
 */
/**
 * @typedef {object} State
 * @property {"connecting" | "connected" | "lost" | "noToken" | "wrongToken"} connection
 * @property {boolean} readOnly   whether the server lets this page watch only
 * @property {boolean} greeted    whether the server of this connection has said who it is
 * @property {string} server
 * @property {string} sessionId
 * @property {string[]} topics
 * @property {string[]} services
 * @property {Readonly<Record<string, any>>} parameters
 * @property {Simulator | null} simulator
 * @property {PlaygroundInfo[]} playgrounds
 * @property {Behavior[]} behaviors  built-in programs
 * @property {ReadonlyMap<string, Marker>} markers  what stays where it is
 * @property {ReadonlyMap<string, Marker>} objects  movable things and doors
 * @property {Readonly<Record<string, Robot>>} robots
 * @property {Readonly<Record<string, Program>>} programs  by namespace of the runtime that says so
 * @property {string} selected     name of the robot the panels show
 * @property {number} timeNs       simulated time
 * @property {Readonly<{ program: Upload | null, playground: Upload | null }>} uploads
 * @property {Notice[]} notices
 * @property {number} noticeCount  how many there ever were: their ids
 */

/**
 * @typedef {{ type: "connecting", address: string } | { type: "connected" } | { type: "disconnected" }
 *   | { type: "refused", withToken: boolean }
 *   | { type: "serverInfo", name: string, sessionId: string, capabilities: string[], readOnly?: boolean }
 *   | { type: "channels", topics: string[] }
 *   | { type: "services", names: string[] }
 *   | { type: "message", topic: string, value: any, timeNs: bigint, nowMs?: number }
 *   | { type: "time", timeNs: bigint }
 *   | { type: "parameters", parameters: { name: string, value?: any }[] }
 *   | { type: "status", status: { level: number, message: string, id?: string } }
 *   | { type: "removeStatus", ids: string[] }
 *   | { type: "fault", what: string }
 *   | { type: "select", robot: string }
 *   | { type: "upload", what: What, name: string, text: string }
 *   | { type: "uploaded", what: What, message: string | null, fault?: Fault | null }
 *   | { type: "forget", what: What }
 *   | { type: "notice", level: Notice["level"], text: string, cause?: string }
 *   | { type: "solved", cause: string }
 *   | { type: "dismiss", id: number }} Message
 */

const KEPT_NOTICES = 4;

/** Cause of notices about a file that was not even sent. */
export const FILE = "file";
/** Cause of notices about what needs the simulator. */
export const CONNECTION = "connection";

/** @type {State} */
export const INITIAL = {
  connection: "connecting",
  readOnly: false,
  greeted: false,
  server: "",
  sessionId: "",
  topics: [],
  services: [],
  parameters: {},
  simulator: null,
  playgrounds: [],
  behaviors: [],
  markers: new Map(),
  objects: new Map(),
  robots: {},
  programs: {},
  selected: "",
  timeNs: 0,
  uploads: { program: null, playground: null },
  notices: [],
  noticeCount: 0,
};

/**
 * @param {State} state
 * @param {Message} message
 * @returns {State}
 */
export function reduce(state, message) {
  const step = /** @type {((state: State, message: any) => State) | undefined} */ (STEPS[message.type]);
  return step === undefined ? state : step(state, message);
}

/** One row per kind of message. */
const STEPS = /** @type {Record<string, (state: State, message: any) => State>} */ ({
  connecting: (state) => ({ ...state, connection: state.connection === "lost" ? "lost" : "connecting" }),
  connected: (state) =>
    withoutNotices({ ...state, connection: "connected", greeted: false, services: [], topics: [] }, [CONNECTION]),
  disconnected: (state) => ({ ...state, connection: "lost" }),
  refused: (state, { withToken }) => ({ ...state, connection: withToken ? "wrongToken" : "noToken" }),
  serverInfo(state, { name, sessionId, readOnly = false }) {
    const known = { ...state, greeted: true, server: name, sessionId, readOnly };
    if (sessionId === state.sessionId && sessionId !== "") return known;
    // On a connection that goes on, the simulation began anew: its topics stay, its time does not.
    if (state.greeted) return { ...known, timeNs: 0 };
    // Another simulator: what was known belongs to one that is no more.
    const { connection, notices, noticeCount, selected } = state;
    const remaining = notices.filter(({ cause }) => !isSimulators(cause));
    return { ...INITIAL, connection, notices: remaining, noticeCount, selected, readOnly, greeted: true, server: name, sessionId };
  },
  channels: withChannels,
  services: (state, { names }) => ({ ...state, services: names }),
  message: withTopic,
  time: (state, { timeNs }) => ({ ...state, timeNs: Number(timeNs) }),
  parameters: (state, { parameters }) => ({
    ...state,
    parameters: {
      ...state.parameters,
      ...Object.fromEntries(parameters.map((/** @type {any} */ p) => [p.name, p.value])),
    },
  }),
  status(state, { status }) {
    if (typeof status.id === "string" && status.id.startsWith("parameter:")) return state; // reported where it was asked
    if (status.id === "access") return state; // the connection panel says so in the page's language
    return withNotice(
      state,
      /** @type {const} */ (["info", "warning", "error"])[status.level] ?? "error",
      status.message,
      statusCause(status.id ?? ""),
    );
  },
  removeStatus: (state, { ids }) => withoutNotices(state, ids.map(statusCause)),
  fault: (state, { what }) => withNotice(state, "error", what),
  select: (state, { robot }) => withoutStaleReadings({ ...state, selected: robot }, state.selected),
  upload: (state, { what, name, text }) =>
    withoutNotices(withUpload(state, what, { name, text, phase: "sending", fault: null }), [uploadCause(what), FILE]),
  uploaded(state, { what, message, fault: reported = null }) {
    const upload = state.uploads[/** @type {What} */ (what)];
    if (upload === null) return state;
    const fault = message === null ? null : (reported ?? locate(message, upload.name));
    return withUpload(state, what, { ...upload, phase: fault === null ? "accepted" : "refused", fault });
  },
  forget: (state, { what }) => withUpload(state, what, null),
  notice: (state, { level, text, cause }) => withNotice(state, level, text, cause),
  solved: (state, { cause }) => withoutNotices(state, [cause]),
  dismiss: (state, { id }) => ({ ...state, notices: state.notices.filter((notice) => notice.id !== id) }),
});

/**
 * What a robot measured is forgotten when it is not followed any more: it would look like what it measures now.
 *
 * @param {State} state
 * @param {string} robot
 * @returns {State}
 */
function withoutStaleReadings(state, robot) {
  const known = state.robots[robot];
  if (known === undefined || isSensed(state, robot)) return state;
  return { ...state, robots: { ...state.robots, [robot]: { ...known, proximity: {}, ground: {}, raw: {} } } };
}

/** @param {State} state @param {{ topics: string[] }} message @returns {State} */
function withChannels(state, { topics }) {
  const names = new Set();
  for (const topic of topics) {
    const part = splitTopic(topic);
    if (part?.name === "_ground_truth/odom") names.add(part.robot);
  }
  const there = [...names].filter((name) => isKnownRobot(state, name)).sort(byName);
  const robots = Object.fromEntries(there.map((name) => [name, state.robots[name] ?? NEW_ROBOT]));
  return { ...state, topics, robots, selected: selection(state.selected, robots) };
}

/** thymio_2 before thymio_10. @param {string} one @param {string} other */
function byName(one, other) {
  return one.localeCompare(other, "en", { numeric: true });
}

/**
 * Whether the simulator, if it says so, has this robot: a topic may outlive it.
 *
 * @param {State} state
 * @param {string} robot
 */
function isKnownRobot({ simulator }, robot) {
  return simulator?.robots?.includes(robot) ?? true;
}

/** @param {State} state @param {Extract<Message, { type: "message" }>} message @returns {State} */
function withTopic(state, { topic, value, nowMs = 0 }) {
  const part = splitTopic(topic);
  if (part === null) return state;
  if (part.robot === null) return GLOBAL_STEPS[part.name](state, value, nowMs);
  if (part.name === "_aseba/status")
    return { ...state, programs: { ...state.programs, [part.robot]: readStatus(value) } };
  if (!isKnownRobot(state, part.robot)) return state;
  const robot = reduceRobot(state.robots[part.robot] ?? NEW_ROBOT, part.name, value, nowMs);
  return { ...state, robots: { ...state.robots, [part.robot]: robot } };
}

const GLOBAL_STEPS = /** @type {Record<string, (state: State, value: any, nowMs: number) => State>} */ ({
  [TRANSFORMS]: applyTransforms,
  "/_markers": (state, value) => ({ ...state, markers: applyMarkers(state.markers, value.markers) }),
  "/_markers/objects": (state, value) => ({ ...state, objects: applyMarkers(state.objects, value.markers) }),
  "/simulator/_state"(state, value) {
    const reported = JSON.parse(value.data);
    const simulator = {
      playground: reported.playground ?? "",
      title: reported.title ?? reported.playground ?? "",
      notes: reported.notes ?? [],
      paused: reported.paused ?? false,
      factor: reported.real_time_factor ?? 1,
      achieved: reported.achieved ?? 0,
      robots: reported.robots?.map((/** @type {any} */ { name }) => name) ?? null,
      worldNames: Object.fromEntries(
        (reported.robots ?? []).map((/** @type {any} */ { name, robot = name }) => [name, robot]),
      ),
      fallen: (reported.robots ?? []).filter((/** @type {any} */ robot) => robot.fallen).map((/** @type {any} */ { name }) => name),
      movables: reported.movables ?? [],
    };
    return withChannels({ ...state, simulator }, state);
  },
  "/aseba_runtime/_behaviours": (state, value) => ({ ...state, behaviors: JSON.parse(value.data) }),
  "/simulator/_playgrounds": (state, value) => ({
    ...state,
    playgrounds: JSON.parse(value.data).map(
      (/** @type {any} */ { name, title = name, description = "", translations = {} }) => ({
        name,
        title,
        description,
        translations,
      }),
    ),
  }),
});

/** @param {string} wanted @param {Record<string, Robot>} robots */
function selection(wanted, robots) {
  return wanted in robots ? wanted : (Object.keys(robots)[0] ?? "");
}

/** @param {State} state @param {Notice["level"]} level @param {string} text @param {string} [cause] @returns {State} */
function withNotice(state, level, text, cause = "") {
  if (state.notices.some((notice) => notice.text === text)) return state;
  const id = state.noticeCount + 1;
  return { ...state, noticeCount: id, notices: [...state.notices, { id, level, text, cause }].slice(-KEPT_NOTICES) };
}

/** Without the notices of causes that are gone. @param {State} state @param {readonly string[]} causes @returns {State} */
function withoutNotices(state, causes) {
  const notices = state.notices.filter(({ cause }) => cause === "" || !causes.includes(cause));
  return notices.length === state.notices.length ? state : { ...state, notices };
}

/** Cause of notices about a file that was refused. @param {What} what */
export function uploadCause(what) {
  return `upload ${what}`;
}

/** Cause of what the bridge reports under an id. @param {string} id */
function statusCause(id) {
  return `status ${id}`;
}

/** Whether a cause is gone with the simulator that reported it. @param {string} cause */
function isSimulators(cause) {
  return cause.startsWith("status ") || cause.startsWith("/");
}

/** @param {State} state @param {What} what @param {Upload | null} upload @returns {State} */
function withUpload(state, what, upload) {
  return { ...state, uploads: { ...state.uploads, [what]: upload } };
}

const NODE_AND_PARAMETER = new RegExp(`^(${Object.values(PARAMETERS).join("|").replaceAll(".", "\\.")}):\\s*`);

/**
 * The place and the words of a refusal: "/node.parameter: name: line 3, column 5: words".
 *
 * @param {string} message
 * @param {string} [name]  of what was refused, which need not be repeated
 * @returns {Fault}
 */
export function locate(message, name = "") {
  const reported = message.replace(NODE_AND_PARAMETER, "");
  const text = name !== "" && reported.startsWith(`${name}:`) ? reported.slice(name.length + 1).trim() : reported;
  const match = /line (\d+), column (\d+):?\s*/.exec(text);
  if (match === null) return { text, line: null, column: null };
  return { text: text.replace(match[0], ""), line: Number(match[1]), column: Number(match[2]) };
}

/** The program state of the selected robot, else of the runtime they share. @param {State} state */
export function programOf(state) {
  return state.programs[state.selected] ?? state.programs[""] ?? null;
}

/** @param {Robot | undefined} robot */
function visible(robot) {
  return robot === undefined ? null : { ...robot, trail: robot.trail.size, samples: robot.samples?.length ?? 0 };
}

/**
 * What tests see of the state: plain data, with the selected robot and its program at hand.
 *
 * @param {State} state
 */
export function snapshot(state) {
  return {
    ...state,
    markers: state.markers.size,
    objects: [...state.objects.values()].map(({ ns, pose }) => ({ name: ns.slice(ns.indexOf("/") + 1), pose })),
    robot: visible(state.robots[state.selected]),
    program: programOf(state),
  };
}
