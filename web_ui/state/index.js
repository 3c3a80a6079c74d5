// The page's state and the function that changes it: `state = reduce(state, message)`.
// Pure: no clock, no socket, no DOM; messages carry everything that is needed.

import { applyMarkers } from "./markers.js";
import { missionMarkers } from "./mission.js";
import { PARAMETERS, SCAN, TRANSFORMS, isSensed, splitTopic } from "./names.js";
import { NEW_ROBOT, readStatus, reduceRobot } from "./robot.js";
import { applyTransforms } from "./transforms.js";

/** @typedef {import("./robot.js").Robot} Robot */
/** @typedef {import("./robot.js").Program} Program */
/** @typedef {import("./markers.js").Marker} Marker */
/** @typedef {{ text: string, line: number | null, column: number | null }} Fault  position from 1, if known */
/**
 * @typedef {object} Upload   a file sent to the simulator, and the result
 * @property {string} name
 * @property {string} text
 * @property {"sending" | "accepted" | "refused"} phase
 * @property {Fault | null} fault
 */
/** @typedef {"program" | "playground"} UploadKind */
/** @typedef {{ name: string, description: string }} Behavior */
/** @typedef {{ title: string, description: string }} Titles */
/** @typedef {Titles & { name: string, translations: Readonly<Record<string, Titles>> }} PlaygroundInfo  by language */
/**
 * @typedef {object} Simulator
 * @property {string} playground
 * @property {string} title
 * @property {string[]} notes   warnings about the file
 * @property {boolean} paused
 * @property {number} factor     wanted real-time factor
 * @property {number} achieved
 * @property {string[] | null} robots  names; null if not reported
 * @property {Readonly<Record<string, string>>} worldNames  names of the robots in the world, by their names in topics
 * @property {string[]} fallen    robots that fell off an edge, by their names in topics
 * @property {string[]} movables  names of movable objects
 * @property {string[]} faults  what is wrong with endpoints and messages of ROS nodes, in English
 */
/** @typedef {Readonly<Record<string, string>>} Label   texts by language */
/**
 * A row of the sensor panel: the next words of a reading, each times `scale`; `full_scale` is the word that fills
 * the bar.
 *
 * @typedef {{ label: Label, unit: string, scale: number, digits: number, full_scale: number | null, words: number }} SensorValue
 */
/** @typedef {{ name: string, label: Label, values: readonly SensorValue[] }} SensorInfo   declaration of a sensor */
/**
 * A notice for the user; `cause` identifies its reason, so that it disappears when the reason is resolved.
 *
 * @typedef {{ id: number, level: "info" | "warning" | "error", text: string, technical: string, cause: string }} Notice
 *   text: in the language of the page, empty: a general sentence; technical: in English, behind "Details"
 */
/**
 * @typedef {object} State
 * @property {"connecting" | "connected" | "lost" | "blocked" | "noToken" | "wrongToken"} connection
 * @property {boolean} outdated   whether the server has a newer page than this one
 * @property {boolean} readOnly   whether the server restricts this page to read-only access
 * @property {boolean} identified    whether the server of this connection has identified itself
 * @property {string} server
 * @property {string} sessionId
 * @property {string[]} topics
 * @property {string[]} services
 * @property {Readonly<Record<string, any>>} parameters
 * @property {Simulator | null} simulator
 * @property {PlaygroundInfo[]} playgrounds
 * @property {Behavior[]} behaviors  built-in behaviors
 * @property {readonly SensorInfo[]} sensors   sensors whose values are shown by their declarations
 * @property {boolean} sensorsShown   whether the sensor panel is open
 * @property {ReadonlyMap<string, Marker>} markers  static markers
 * @property {ReadonlyMap<string, Marker>} objects  movable objects and doors
 * @property {import("./mission.js").Mission | null} mission   the open mission
 * @property {import("./mission.js").Try | null} attempt   its present try
 * @property {ReadonlyMap<string, Marker>} missionMarkers   zones of the mission, and the way of a try that is over
 * @property {Readonly<Record<string, Robot>>} robots
 * @property {Readonly<Record<string, Program>>} programs  by namespace of the runtime
 * @property {string} selected     name of the robot whose values are shown
 * @property {boolean} toAll       whether actions go to all robots; only with several
 * @property {number} timeNs       simulated time
 * @property {Readonly<{ program: Upload | null, playground: Upload | null }>} uploads
 * @property {Notice[]} notices
 * @property {number} noticeCount  total number of notices so far, the source of their ids
 */

/**
 * @typedef {{ type: "connecting", address: string } | { type: "connected" } | { type: "disconnected", isBlocked?: boolean }
 *   | { type: "outdated" }
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
 *   | { type: "address", all: boolean }
 *   | { type: "showSensors", shown: boolean }
 *   | { type: "upload", what: UploadKind, name: string, text: string }
 *   | { type: "uploaded", what: UploadKind, message: string | null, fault?: Fault | null }
 *   | { type: "forget", what: UploadKind }
 *   | { type: "notice", level: Notice["level"], text: string, technical?: string, cause?: string }
 *   | { type: "solved", cause: string }
 *   | { type: "dismiss", id: number }} Message
 */

const MAX_NOTICES = 4;

/** Cause of notices about a file that was rejected by the page. */
export const FILE = "file";
/** Cause of notices about missing connection. */
export const CONNECTION = "connection";

/** @type {State} */
export const INITIAL = {
  connection: "connecting",
  outdated: false,
  readOnly: false,
  identified: false,
  server: "",
  sessionId: "",
  topics: [],
  services: [],
  parameters: {},
  simulator: null,
  playgrounds: [],
  behaviors: [],
  sensors: [],
  sensorsShown: false,
  markers: new Map(),
  objects: new Map(),
  mission: null,
  attempt: null,
  missionMarkers: new Map(),
  robots: {},
  programs: {},
  selected: "",
  toAll: false,
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
  connecting: (state) => (["lost", "blocked"].includes(state.connection) ? state : { ...state, connection: "connecting" }),
  connected: (state) =>
    withoutNotices({ ...state, connection: "connected", identified: false, services: [], topics: [] }, [CONNECTION]),
  disconnected: (state, { isBlocked = false }) => ({ ...state, connection: isBlocked ? "blocked" : "lost" }),
  outdated: (state) => ({ ...state, outdated: true }),
  refused: (state, { withToken }) => ({ ...state, connection: withToken ? "wrongToken" : "noToken" }),
  serverInfo(state, { name, sessionId, readOnly = false }) {
    const known = { ...state, identified: true, server: name, sessionId, readOnly };
    if (sessionId === state.sessionId && sessionId !== "") return known;
    // On the same connection the simulation was restarted: topics stay, time is reset.
    if (state.identified) return { ...known, timeNs: 0 };
    // Another simulator: discard the data of the previous one.
    const { connection, outdated, notices, noticeCount, selected, sensorsShown } = state;
    const remaining = notices.filter(({ cause }) => !isSimulatorCause(cause));
    const own = { connection, outdated, notices: remaining, noticeCount, selected, sensorsShown };
    return { ...INITIAL, ...own, readOnly, identified: true, server: name, sessionId };
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
    if (typeof status.id === "string" && status.id.startsWith("parameter:")) return state; // shown where it was set
    if (status.id === "access") return state; // the connection panel shows it, translated
    const level = /** @type {const} */ (["info", "warning", "error"])[status.level] ?? "error";
    return withNotice(state, { level, text: "", technical: status.message, cause: statusCause(status.id ?? "") });
  },
  removeStatus: (state, { ids }) => withoutNotices(state, ids.map(statusCause)),
  fault: (state, { what }) => withNotice(state, { level: "error", text: "", technical: what }),
  select: (state, { robot }) => withoutStaleReadings({ ...state, selected: robot, toAll: false }, state.selected),
  address: (state, { all }) => ({ ...state, toAll: all && Object.keys(state.robots).length > 1 }),
  showSensors: (state, { shown }) => ({ ...state, sensorsShown: shown }),
  upload: (state, { what, name, text }) =>
    withoutNotices(withUpload(state, what, { name, text, phase: "sending", fault: null }), [uploadCause(what), FILE]),
  uploaded(state, { what, message, fault: reported = null }) {
    const upload = state.uploads[/** @type {UploadKind} */ (what)];
    if (upload === null) return state;
    const fault = message === null ? null : (reported ?? locate(message, upload.name));
    return withUpload(state, what, { ...upload, phase: fault === null ? "accepted" : "refused", fault });
  },
  forget: (state, { what }) => withUpload(state, what, null),
  notice: (state, { level, text, technical, cause }) => withNotice(state, { level, text, technical, cause }),
  solved: (state, { cause }) => withoutNotices(state, [cause]),
  dismiss: (state, { id }) => ({ ...state, notices: state.notices.filter((notice) => notice.id !== id) }),
});

/**
 * Discard the readings of a robot that is no longer subscribed to: they would look current.
 *
 * @param {State} state
 * @param {string} robot
 * @returns {State}
 */
function withoutStaleReadings(state, robot) {
  const known = state.robots[robot];
  if (known === undefined || isSensed(state, robot)) return state;
  return { ...state, robots: { ...state.robots, [robot]: { ...known, proximity: {}, ground: {}, raw: {}, scan: null } } };
}

/** @param {State} state @param {{ topics: string[] }} message @returns {State} */
function withChannels(state, { topics }) {
  const robotsWith = (/** @type {string} */ wanted) =>
    topics.flatMap((topic) => {
      const part = splitTopic(topic);
      return part?.name === wanted && part.robot !== null ? [part.robot] : [];
    });
  const simulated = robotsWith("_ground_truth/odom");
  const scanned = robotsWith(SCAN);
  const programmed = robotsWith("_aseba/status");
  const real = robotsWith("odom").filter((name) => programmed.includes(name) && !simulated.includes(name));
  const there = [...simulated, ...real].filter((name) => isKnownRobot(state, name)).sort(byName);
  const robots = Object.fromEntries(
    there.map((name) => {
      const known = state.robots[name] ?? NEW_ROBOT;
      const isReal = real.includes(name);
      const hasLidar = scanned.includes(name);
      const isSame = known.isReal === isReal && known.hasLidar === hasLidar;
      return [name, isSame ? known : { ...known, isReal, hasLidar, scan: hasLidar ? known.scan : null }];
    }),
  );
  const toAll = state.toAll && there.length > 1;
  return { ...state, topics, robots, toAll, selected: selection(state.selected, robots) };
}

/** Numeric order: thymio_2 before thymio_10. @param {string} one @param {string} other */
function byName(one, other) {
  return one.localeCompare(other, "en", { numeric: true });
}

/**
 * Whether the simulator has this robot, if it reports its robots: a topic may outlive its robot.
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
  "/simulator/_mission": (state, value) => withMission(state, JSON.parse(value.data), state.attempt),
  "/simulator/_mission/try": (state, value) => withMission(state, state.mission, JSON.parse(value.data)),
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
      faults: reported.faults ?? [],
    };
    return withChannels(withFaults({ ...state, simulator }, state.simulator?.faults ?? []), state);
  },
  "/aseba_runtime/_behaviours": (state, value) => ({ ...state, behaviors: JSON.parse(value.data) }),
  "/simulator/_sensors": (state, value) => ({ ...state, sensors: JSON.parse(value.data) }),
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

/**
 * A try of another mission does not count: both messages come in any order.
 *
 * @param {State} state
 * @param {import("./mission.js").Mission | null} mission
 * @param {import("./mission.js").Try | null} attempt
 * @returns {State}
 */
function withMission(state, mission, attempt) {
  const shown = mission !== null && attempt?.mission === mission.name ? attempt : null;
  return { ...state, mission, attempt, missionMarkers: missionMarkers(mission, shown) };
}

/** The present try of the open mission. @param {State} state */
export function attemptOf({ mission, attempt }) {
  return mission !== null && attempt?.mission === mission.name ? attempt : null;
}

/** @param {string} wanted @param {Record<string, Robot>} robots */
function selection(wanted, robots) {
  return wanted in robots ? wanted : (Object.keys(robots)[0] ?? "");
}

/**
 * @param {State} state
 * @param {{ level: Notice["level"], text: string, technical?: string, cause?: string }} notice
 * @returns {State}
 */
function withNotice(state, { level, text, technical = "", cause = "" }) {
  if (state.notices.some((notice) => notice.text === text && notice.technical === technical)) return state;
  const id = state.noticeCount + 1;
  const notices = [...state.notices, { id, level, text, technical, cause }].slice(-MAX_NOTICES);
  return { ...state, noticeCount: id, notices };
}

/** Remove the notices of resolved causes. @param {State} state @param {readonly string[]} causes @returns {State} */
function withoutNotices(state, causes) {
  const notices = state.notices.filter(({ cause }) => cause === "" || !causes.includes(cause));
  return notices.length === state.notices.length ? state : { ...state, notices };
}

/**
 * Show what is new among the faults of ROS nodes, and hide what is no longer true.
 *
 * @param {State} state @param {readonly string[]} before @returns {State}
 */
function withFaults(state, before) {
  const now = state.simulator?.faults ?? [];
  const gone = before.filter((line) => !now.includes(line)).map(faultCause);
  return now
    .filter((line) => !before.includes(line))
    .reduce(
      (shown, line) => withNotice(shown, { level: "warning", text: "", technical: line, cause: faultCause(line) }),
      withoutNotices(state, gone),
    );
}

/** Cause of notices about a fault of a ROS node. @param {string} line */
function faultCause(line) {
  return `fault ${line}`;
}

/** Cause of notices about a rejected file. @param {UploadKind} what */
export function uploadCause(what) {
  return `upload ${what}`;
}

/** Cause of status messages of the bridge, by id. @param {string} id */
function statusCause(id) {
  return `status ${id}`;
}

/** Whether a cause ends with the simulator that reported it. @param {string} cause */
function isSimulatorCause(cause) {
  return cause.startsWith("status ") || cause.startsWith("/");
}

/** @param {State} state @param {UploadKind} what @param {Upload | null} upload @returns {State} */
function withUpload(state, what, upload) {
  return { ...state, uploads: { ...state.uploads, [what]: upload } };
}

const NODE_AND_PARAMETER = new RegExp(`^(${Object.values(PARAMETERS).join("|").replaceAll(".", "\\.")}):\\s*`);

/**
 * Split a rejection into position and message: "/node.parameter: name: line 3, column 5: message".
 *
 * @param {string} message
 * @param {string} [name]  name of the rejected file, which is removed from the message
 * @returns {Fault}
 */
export function locate(message, name = "") {
  const reported = message.replace(NODE_AND_PARAMETER, "");
  const text = name !== "" && reported.startsWith(`${name}:`) ? reported.slice(name.length + 1).trim() : reported;
  const match = /line (\d+), column (\d+):?\s*/.exec(text);
  if (match === null) return { text, line: null, column: null };
  return { text: text.replace(match[0], ""), line: Number(match[1]), column: Number(match[2]) };
}

/** Names of the robots that actions go to. @param {State} state @returns {readonly string[]} */
export function targets({ robots, selected, toAll }) {
  return toAll ? Object.keys(robots) : [selected];
}

/** The program state of the selected robot, else of the shared runtime. @param {State} state */
export function programOf(state) {
  return state.programs[state.selected] ?? state.programs[""] ?? null;
}

/** @param {Robot | undefined} robot */
function visible(robot) {
  return robot === undefined ? null : { ...robot, trail: robot.trail.size, samples: robot.samples?.length ?? 0 };
}

/**
 * A snapshot of the state for tests: plain data, with the selected robot and its program.
 *
 * @param {State} state
 */
export function snapshot(state) {
  return {
    ...state,
    markers: state.markers.size,
    missionMarkers: [...state.missionMarkers.keys()],
    objects: [...state.objects.values()].map(({ ns, pose }) => ({ name: ns.slice(ns.indexOf("/") + 1), pose })),
    robot: visible(state.robots[state.selected]),
    program: programOf(state),
  };
}
