// Topic names: those of the simulator, those of a robot, and those that the page subscribes to.
// A single robot has no namespace; of several each has its own (docs/spec/ros-interface.md section 2).

/** The sensors in Thymio's order 0…6. */
export const PROXIMITY = ["left", "center_left", "center", "center_right", "right", "rear_left", "rear_right"];
export const GROUND = ["left", "right"];
export const BUTTONS = ["forward", "left", "center", "right", "backward"];

/** The transforms of all robots. */
export const TRANSFORMS = "/tf";

export const GLOBAL_TOPICS = [
  TRANSFORMS,
  "/_markers",
  "/_markers/objects",
  "/simulator/_state",
  "/simulator/_playgrounds",
  "/simulator/_sensors",
  "/simulator/_mission",
  "/simulator/_mission/try",
  "/aseba_runtime/_behaviours",
];

/** The topic of a lidar, which a simulated robot can have. */
export const SCAN = "scan";

/** Topics of one robot, relative to its namespace. */
export const ROBOT_TOPICS = [
  "_ground_truth/odom",
  "odom",
  "joint_states",
  SCAN,
  "_led/state",
  "_aseba/status",
  "_pen/trail",
  "_sound/state",
  "_sound/state/wave",
  "_sound/state/samples",
  ...PROXIMITY.map((name) => `proximity/${name}`),
  ...GROUND.map((name) => `ground/${name}`),
  ...BUTTONS.map((name) => `buttons/${name}`),
];

/** A sensor's integers; which sensors there are is known from `/simulator/_sensors`. */
const RAW_TOPIC = /^\/(?:([^/]+)\/)?(_raw\/(\w+))$/;
/** Sensors whose integers the scene draws, with the beams. */
const DRAWN_SENSORS = ["proximity", "ground"];
/** Sensors whose rows in the sensor panel are not derived from their declarations. */
const PANEL_SENSORS = ["motor", "remote", "comm"];

/** With more robots than this, topics for panels and beams are subscribed to for the selected robot only. */
export const MANY_ROBOTS = 4;

/** Topics that are needed to draw a robot. */
const DRAWN = /^(?:_ground_truth|joint_states|_led|buttons|_pen|_sound|_aseba)\b/;
/** Topics that the transforms replace while the simulation runs. */
const POSE_TOPICS = /^(?:_ground_truth|joint_states)\b/;

/** @typedef {{ isByTransforms: boolean | null, isReal?: boolean }} Placed  null: no transforms have come */
/**
 * @typedef {object} SubscriptionState   the part of the state that determines the subscriptions
 * @property {Readonly<Record<string, Placed>>} robots
 * @property {string} selected
 * @property {readonly string[]} topics              all that are published
 * @property {{ paused: boolean } | null} simulator
 * @property {readonly { name: string }[]} sensors   sensors that declare rows of the sensor panel
 * @property {boolean} sensorsShown                  whether the sensor panel is open
 */

/** @param {Pick<SubscriptionState, "robots">} state */
function hasManyRobots({ robots }) {
  return Object.keys(robots).length > MANY_ROBOTS;
}

/**
 * Whether beams and values of a robot are subscribed to.
 *
 * @param {Pick<SubscriptionState, "selected"> & { robots: Readonly<Record<string, unknown>> }} state
 * @param {string} robot
 */
export function isSensed({ robots, selected }, robot) {
  return robot === selected || Object.keys(robots).length <= MANY_ROBOTS;
}

/**
 * Whether the page wants to subscribe to a topic now.
 *
 * @param {SubscriptionState} state
 * @param {string} topic
 */
export function isWatched(state, topic) {
  const part = splitTopic(topic);
  if (part === null) return false;
  if (part.robot === null) return topic !== TRANSFORMS || hasManyRobots(state);
  if (part.name === "odom") return state.robots[part.robot]?.isReal ?? false;
  const sensor = RAW_TOPIC.exec(topic)?.[3];
  if (sensor !== undefined && !isSensorShown(state, sensor)) return false;
  if (isSensed(state, part.robot)) return true;
  if (POSE_TOPICS.test(part.name) && !needsPose(state, part.robot)) return false;
  return DRAWN.test(part.name);
}

/** Transforms give a pose, unless time stands still or they are not of this robot. @param {SubscriptionState} state @param {string} robot */
function needsPose({ robots, simulator, topics }, robot) {
  if (simulator?.paused || !topics.includes(TRANSFORMS)) return true;
  return robots[robot]?.isByTransforms === false;
}

/**
 * How soon a topic is subscribed to: what concerns all robots first, then the selected robot, then the others' lights.
 *
 * @param {Pick<SubscriptionState, "selected">} state
 * @param {string} topic
 */
export function urgencyOf({ selected }, topic) {
  const { robot, name } = splitTopic(topic) ?? { robot: null, name: topic };
  if (robot === null) return 0;
  if (robot === selected) return 1;
  return name === "_led/state" ? 2 : 3;
}

/**
 * Whether the integers of a sensor are drawn, or shown by the open sensor panel.
 *
 * @param {Pick<SubscriptionState, "sensors" | "sensorsShown">} state
 * @param {string} sensor
 */
function isSensorShown({ sensors, sensorsShown }, sensor) {
  if (DRAWN_SENSORS.includes(sensor)) return true;
  return sensorsShown && (PANEL_SENSORS.includes(sensor) || sensors.some(({ name }) => name === sensor));
}

/** A key that changes whenever `isWatched` may return another result for the same topics. @param {SubscriptionState} state */
export function subscriptionKey(state) {
  const sensors = state.sensorsShown ? state.sensors.map(({ name }) => name).join() : "closed";
  const real = Object.entries(state.robots).flatMap(([name, { isReal }]) => (isReal ? [`/${name}`] : []));
  const shown = [sensors, ...real].join(" ");
  if (!hasManyRobots(state)) return shown;
  const placed = Object.values(state.robots).map(({ isByTransforms }) => Number(isByTransforms ?? 2));
  return `${shown} ${state.selected} ${placed.join("")} ${state.simulator?.paused}`;
}

export const PARAMETERS = /** @type {const} */ ({
  playground: "/simulator.playground",
  factor: "/simulator.real_time_factor",
  stepTicks: "/simulator.step_ticks",
  source: "/aseba_runtime.script.source",
  behavior: "/aseba_runtime.behaviour",
  programName: "/aseba_runtime.script.name",
  notice: "/web_ui.notice",
  noticeLink: "/web_ui.notice_link",
  pupil: "/web_ui.pupil",
  pausedByTeacher: "/web_ui.paused_by_teacher",
  raisedHand: "/web_ui.raised_hand",
  handouts: "/web_ui.handouts",
  draft: "/web_ui.draft",
  nodeDraft: "/web_ui.node_draft",
});

/**
 * Split a topic into robot and relative name; null if the page does not use it.
 *
 * @param {string} topic
 * @returns {{ robot: string | null, name: string } | null}
 */
export function splitTopic(topic) {
  if (GLOBAL_TOPICS.includes(topic)) return { robot: null, name: topic };
  const raw = RAW_TOPIC.exec(topic);
  if (raw !== null) return { robot: raw[1] ?? "", name: raw[2] };
  const name = ROBOT_TOPICS.find((relative) => topic.endsWith(`/${relative}`));
  if (name === undefined) return null;
  const robot = topic.slice(1, -(name.length + 1));
  return robot.includes("/") ? null : { robot, name };
}

/** @param {string} robot @param {string} name */
export function robotTopic(robot, name) {
  return robot === "" ? `/${name}` : `/${robot}/${name}`;
}
