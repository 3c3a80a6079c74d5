// Robot data of the editor: targets, variables, events, built-in behaviors (docs/aseba_ros.md).
// Pure: `state = reduce(state, message)`.

/** @typedef {{ name: string, help: string, topic?: string }} Named   topic: of the help */
/** @typedef {Named & { size: number, address: number, hidden: boolean }} TargetVariable */
/** @typedef {Named & { parameters: { name: string, size: number }[], hidden: boolean }} Native */
/**
 * @typedef {object} ProgramInfo
 * @property {string} name
 * @property {boolean} [foreign]  came as bytecode: source and file are its instructions
 * @property {string} node
 * @property {number} first_line
 * @property {string} source  code of the node
 * @property {string} file    the whole text that was loaded
 * @property {{ name: string, size: number, topic: string | null }[]} events
 * @property {{ name: string, value: number }[]} constants
 * @property {{ name: string, size?: number }[]} variables
 */
/**
 * @typedef {object} Target
 * @property {TargetVariable[]} variables
 * @property {Named[]} events
 * @property {Native[]} natives
 * @property {string[]} keywords
 * @property {string[]} [topics]   in the order of the help
 * @property {Record<string, number>} limits
 * @property {ProgramInfo | null} [program]
 */
/** @typedef {{ id: number, timeNs: bigint, robot: string, name: string, values: number[] }} LoggedEvent */
/** @typedef {{ timeNs: bigint, values: ReadonlyMap<string, number[]> }} Variables */
/**
 * @typedef {object} EditorState
 * @property {Readonly<Record<string, Target>>} targets     by robot
 * @property {Readonly<Record<string, Variables>>} variables
 * @property {readonly LoggedEvent[]} log                   oldest first
 * @property {readonly { name: string, description: string }[]} behaviors
 */

export const MAX_LOGGED_EVENTS = 500;

/** @type {EditorState} */
export const INITIAL = { targets: {}, variables: {}, log: [], behaviors: [] };

const BEHAVIORS = "/aseba_runtime/_behaviours";
const ROBOT_TOPIC = /^\/(?:([^/]+)\/)?_aseba\/(target|variables|events)$/;

/**
 * @param {string} topic
 * @returns {{ robot: string, name: string } | null} null for what the editor does not watch
 */
export function splitEditorTopic(topic) {
  if (topic === BEHAVIORS) return { robot: "", name: "behaviors" };
  const match = ROBOT_TOPIC.exec(topic);
  return match === null ? null : { robot: match[1] ?? "", name: match[2] };
}

/** @typedef {{ type: "message", topic: string, value: any, timeNs: bigint } | { type: "forgetLog" } | { type: "disconnected" }} Message */

/**
 * @param {EditorState} state
 * @param {Message} message
 * @returns {EditorState}
 */
export function reduce(state, message) {
  if (message.type === "forgetLog") return { ...state, log: [] };
  if (message.type === "disconnected") return { ...state, variables: {} };
  if (message.type !== "message") return state;
  const { topic, value, timeNs } = message;
  const part = splitEditorTopic(topic);
  if (part === null) return state;
  const { robot, name } = part;
  if (name === "behaviors") return { ...state, behaviors: JSON.parse(value.data) };
  if (name === "target") return { ...state, targets: { ...state.targets, [robot]: JSON.parse(value.data) } };
  if (name === "variables") {
    const variables = { timeNs, values: byLabel(value) };
    return { ...state, variables: { ...state.variables, [robot]: variables } };
  }
  const [{ label = "?" } = {}] = value.layout.dim;
  const id = 1 + (state.log.at(-1)?.id ?? 0);
  const entry = { id, timeNs, robot, name: label, values: [...value.data] };
  return { ...state, log: [...state.log, entry].slice(-MAX_LOGGED_EVENTS) };
}

/** The values of a labeled array, one name per dimension. @param {any} message */
function byLabel({ layout, data }) {
  /** @type {Map<string, number[]>} */ const values = new Map();
  let from = 0;
  for (const { label, size } of layout.dim) {
    values.set(label, data.slice(from, from + size));
    from += size;
  }
  return values;
}
