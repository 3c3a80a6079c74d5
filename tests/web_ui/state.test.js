import assert from "node:assert/strict";
import { test } from "node:test";

import { INITIAL, locate, programOf, reduce, snapshot, targets } from "../../web_ui/state/index.js";
import { Store } from "../../web_ui/state/store.js";
import { applyMarkers } from "../../web_ui/state/markers.js";
import { isWatched, splitTopic, subscriptionKey } from "../../web_ui/state/names.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";
import { captured } from "./support.js";

/** @typedef {import("../../web_ui/state/index.js").Message} Message */
/** @typedef {import("../../web_ui/state/index.js").State} State */

/** @param {Message[]} messages @param {State} [state] */
function after(messages, state = INITIAL) {
  return messages.reduce(reduce, state);
}

/** @param {string} topic @param {any} value @param {number} [nowMs] @returns {Message} */
function message(topic, value, nowMs = 0) {
  return { type: "message", topic, value, timeNs: 0n, nowMs };
}

/** @param {any} data @returns {{ data: string }} */
function json(data) {
  return { data: JSON.stringify(data) };
}

test("topics are split into robot and name", () => {
  assert.deepEqual(splitTopic("/_led/state"), { robot: "", name: "_led/state" });
  assert.deepEqual(splitTopic("/thymio_1/_led/state"), { robot: "thymio_1", name: "_led/state" });
  assert.deepEqual(splitTopic("/_markers"), { robot: null, name: "/_markers" });
  assert.deepEqual(splitTopic("/odom"), { robot: "", name: "odom" });
  assert.equal(splitTopic("/imu"), null);
  assert.equal(splitTopic("/a/b/_led/state"), null);
});

test("robots are found by their ground truth topics", () => {
  const state = after([
    { type: "channels", topics: ["/thymio_0/_ground_truth/odom", "/thymio_1/_ground_truth/odom", "/clock"] },
  ]);
  assert.deepEqual(Object.keys(state.robots), ["thymio_0", "thymio_1"]);
  assert.equal(state.selected, "thymio_0");
});

test("a real robot, which has no ground truth, is drawn where its odometry is", () => {
  const { value } = captured("nav_msgs/msg/Odometry");
  const topics = ["/odom", "/_aseba/status", "/a/odom", "/a/_aseba/status", "/a/_ground_truth/odom", "/other/odom"];
  const state = after([
    { type: "channels", topics },
    message("/odom", value, 10),
    message("/a/odom", value, 10),
  ]);
  assert.deepEqual(Object.keys(state.robots), ["", "a"]);
  assert.equal(state.robots[""].latest?.arrivedMs, 10);
  assert.equal(state.robots.a.latest, null);
  assert.ok(isWatched(state, "/odom"));
  assert.ok(!isWatched(state, "/a/odom"));
  assert.notEqual(subscriptionKey(state), subscriptionKey(INITIAL));
});

test("a robot that stays keeps its state, and stays selected", () => {
  const state = after([
    { type: "channels", topics: ["/a/_ground_truth/odom", "/b/_ground_truth/odom"] },
    { type: "select", robot: "b" },
    message("/b/buttons/left", { data: true }),
    { type: "channels", topics: ["/b/_ground_truth/odom"] },
  ]);
  assert.equal(state.selected, "b");
  assert.equal(state.robots.b.buttons.left, true);
});

test("the last two poses are kept, with their heading", () => {
  const { value } = captured("nav_msgs/msg/Odometry");
  const { latest, previous } = after([
    message("/_ground_truth/odom", value, 10),
    message("/_ground_truth/odom", value, 60),
  ]).robots[""];
  assert.deepEqual([previous?.arrivedMs, latest?.arrivedMs, latest?.stampNs], [10, 60, 12_340_000_000]);
  assert.ok(Math.abs((latest?.pose.yaw ?? 0) - 2 * Math.atan2(0.6, 0.8)) < 1e-12);
});

test("LED levels are split into groups", () => {
  const { leds } = after([message("/_led/state", captured("std_msgs/msg/Float32MultiArray").value)]).robots[""];
  assert.deepEqual(leds, { top: [0, 0.5, 1], remote: [0.25] });
});

test("wheels are found by name, with or without a prefix", () => {
  const value = { name: ["a/right_wheel_joint", "a/left_wheel_joint"], position: [2, 1], velocity: [4, 3] };
  const { wheels, wheelSpeeds } = after([message("/a/joint_states", value)]).robots.a;
  assert.deepEqual(
    [wheels, wheelSpeeds],
    [
      { left: 1, right: 2 },
      { left: 3, right: 4 },
    ],
  );
});

test("sensors are kept by name", () => {
  const robot = after([
    message("/proximity/rear_left", { range: Infinity }),
    message("/ground/left", { range: -Infinity }),
    message("/_raw/proximity", { data: [0, 0, 4505, 0, 0, 0, 0] }),
  ]).robots[""];
  assert.deepEqual(
    [robot.proximity, robot.ground, robot.raw.proximity[2]],
    [{ rear_left: Infinity }, { left: -Infinity }, 4505],
  );
});

test("a robot's own runtime has priority over the shared one", () => {
  const status = captured("diagnostic_msgs/msg/DiagnosticStatus").value;
  const shared = after([{ type: "channels", topics: ["/a/_ground_truth/odom"] }, message("/_aseba/status", status)]);
  const { values, ...program } = programOf(shared) ?? { values: {} };
  assert.deepEqual(program, { state: "running", name: "line.aesl", message: "paused", level: 1, line: "" });
  assert.equal(values.state, "running");
  assert.deepEqual(Object.keys(shared.robots), ["a"]);
  const own = reduce(shared, message("/a/_aseba/status", { ...status, values: [{ key: "state", value: "fault" }] }));
  assert.equal(programOf(own)?.state, "fault");
});

test("robots have names in the world, and movable objects are listed", () => {
  const robots = [{ name: "", frame: "base_link", robot: "thymio" }];
  const { simulator } = after([message("/simulator/_state", json({ robots, movables: ["can"] }))]);
  assert.deepEqual([simulator?.worldNames, simulator?.movables], [{ "": "thymio" }, ["can"]]);
});

test("built-in behaviors are reported as JSON", () => {
  const { behaviors } = after([message("/aseba_runtime/_behaviours", json([{ name: "menu", description: "d" }]))]);
  assert.deepEqual(behaviors, [{ name: "menu", description: "d" }]);
});

test("the simulator and its playgrounds are reported as JSON", () => {
  const { simulator, playgrounds } = after([
    message(
      "/simulator/_state",
      json({ playground: "line", title: "Line", paused: true, real_time_factor: 2, achieved: 1.5 }),
    ),
    message("/simulator/_playgrounds", json([{ name: "line", title: "Line", description: "d" }, { name: "base" }])),
  ]);
  assert.deepEqual(simulator, { playground: "line", title: "Line", notes: [], paused: true, factor: 2, achieved: 1.5, robots: null, worldNames: {}, fallen: [], movables: [], faults: [] });
  assert.deepEqual(playgrounds[1], { name: "base", title: "base", description: "", translations: {} });
});

test("a ROS node that is not connected is reported once, and no longer than it is there", () => {
  const report = (/** @type {string[]} */ ...faults) => message("/simulator/_state", json({ faults }));
  const first = after([report("a", "b")]);
  assert.deepEqual(first.notices.map(({ level, technical }) => [level, technical]), [["warning", "a"], ["warning", "b"]]);
  const [{ id }] = first.notices;
  const dismissed = reduce(reduce(first, { type: "dismiss", id }), report("a", "b"));
  assert.deepEqual(dismissed.notices.map(({ technical }) => technical), ["b"]);
  assert.deepEqual(reduce(dismissed, report("a")).notices, []);
});

test("moving markers are separate from static ones", () => {
  const marker = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  const can = { ...marker, ns: "solid/can" };
  let state = after([
    message("/_markers/objects", { markers: [{ action: 3 }, can] }),
    message("/_markers", { markers: [{ action: 3 }, marker] }),
  ]);
  assert.deepEqual([state.markers.size, state.objects.size], [1, 1]);
  assert.deepEqual(snapshot(state).objects, [{ name: "can", pose: marker.pose }]);
  state = reduce(state, message("/_markers/objects", { markers: [{ action: 3 }] }));
  assert.deepEqual([state.markers.size, state.objects.size], [1, 0]);
});

test("a pen trail belongs to its robot", () => {
  const marker = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  const state = after([
    { type: "channels", topics: ["/a/_ground_truth/odom", "/b/_ground_truth/odom"] },
    message("/a/_pen/trail", { markers: [{ action: 3 }, { ...marker, ns: "a/pen" }] }),
  ]);
  assert.deepEqual([state.robots.a.trail.size, state.robots.b.trail.size, state.markers.size], [1, 0, 0]);
});

test("markers are replaced by namespace and id, and all deleted", () => {
  const marker = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  const first = applyMarkers(new Map(), [marker, { ...marker, id: 8 }]);
  assert.deepEqual([...first.keys()], ["solid/wall/7", "solid/wall/8"]);
  assert.equal(applyMarkers(first, [{ ...marker, action: 2 }]).size, 1);
  assert.deepEqual(
    [
      ...applyMarkers(first, [
        { ...marker, action: 3 },
        { ...marker, ns: "x" },
      ]).keys(),
    ],
    ["x/7"],
  );
  assert.equal(first.size, 2);
});

test("a program is being sent, then loaded", () => {
  const sending = after([{ type: "upload", what: "program", name: "a.aesl", text: "x" }]);
  assert.deepEqual(sending.uploads.program, { name: "a.aesl", text: "x", phase: "sending", fault: null });
  assert.equal(
    reduce(sending, { type: "uploaded", what: "program", message: null }).uploads.program?.phase,
    "accepted",
  );
});

test("a rejected program keeps its text and the position of the error", () => {
  const { program } = after([
    { type: "upload", what: "program", name: "a.aesl", text: "x" },
    {
      type: "uploaded",
      what: "program",
      message: "/aseba_runtime.script.source: a.aesl: line 3, column 5: no such variable",
    },
  ]).uploads;
  assert.deepEqual(program, {
    name: "a.aesl",
    text: "x",
    phase: "refused",
    fault: { text: "no such variable", line: 3, column: 5 },
  });
});

test("a rejection without position keeps its message", () => {
  assert.deepEqual(locate("/simulator.playground: robots: found 0"), {
    text: "robots: found 0",
    line: null,
    column: null,
  });
  assert.deepEqual(locate("x.json: line 2, column 1: no"), { text: "x.json: no", line: 2, column: 1 });
});

test("rejected parameters are reported at their request, other statuses as notices", () => {
  const state = after([
    { type: "status", status: { level: 2, message: "refused", id: "parameter:/a.x" } },
    { type: "status", status: { level: 1, message: "slow" } },
    { type: "status", status: { level: 1, message: "slow" } },
    { type: "fault", what: "a frame is too short" },
  ]);
  assert.deepEqual(
    state.notices.map(({ level, text, technical }) => [level, text, technical]),
    [
      ["warning", "", "slow"],
      ["error", "", "a frame is too short"],
    ],
  );
  assert.equal(reduce(state, { type: "dismiss", id: state.notices[0].id }).notices.length, 1);
});

test("only the last notices are kept", () => {
  const { notices } = after(["a", "b", "c", "d", "e"].map((text) => ({ type: "notice", level: "info", text })));
  assert.deepEqual(
    notices.map(({ text }) => text),
    ["b", "c", "d", "e"],
  );
});

test("a lost connection is shown until there is a new one, and the view stays", () => {
  const lost = after([
    { type: "connected" },
    message("/buttons/left", { data: true }),
    { type: "disconnected" },
    { type: "connecting", address: "" },
  ]);
  assert.equal(lost.connection, "lost");
  assert.equal(lost.robots[""].buttons.left, true);
  assert.equal(reduce(lost, { type: "connected" }).connection, "connected");
});

/** @param {string} sessionId @returns {Message} */
function greeting(sessionId) {
  return { type: "serverInfo", name: "bridge", sessionId, capabilities: [] };
}

test("after a reconnection the same simulation continues, another one starts with empty state", () => {
  const lost = after([
    { type: "connected" },
    greeting("1"),
    message("/buttons/left", { data: true }),
    { type: "disconnected" },
    { type: "connected" },
  ]);
  assert.equal(reduce(lost, greeting("1")).robots[""].buttons.left, true);
  assert.deepEqual(reduce(lost, greeting("2")).robots, {});
});

test("a simulation that restarts keeps its topics, and its time starts at zero", () => {
  const state = after([
    { type: "connected" },
    greeting("1"),
    { type: "channels", topics: ["/_ground_truth/odom"] },
    { type: "time", timeNs: 5n },
    greeting("2"),
  ]);
  assert.deepEqual([state.topics, Object.keys(state.robots), state.timeNs], [["/_ground_truth/odom"], [""], 0]);
});

test("unknown topics and messages change nothing", () => {
  assert.equal(reduce(INITIAL, message("/clock", {})), INITIAL);
  assert.equal(reduce(INITIAL, /** @type {any} */ ({ type: "from the future" })), INITIAL);
});

test("a snapshot is plain data with the selected robot at hand", () => {
  const state = after([
    { type: "channels", topics: ["/a/_ground_truth/odom", "/b/_ground_truth/odom"] },
    { type: "select", robot: "b" },
  ]);
  const { robot, program, markers } = JSON.parse(JSON.stringify(snapshot(state)));
  assert.deepEqual([robot.buttons.center, program, markers], [false, null, 0]);
});

test("a removed robot disappears even if its topics still exist", () => {
  const reported = (/** @type {string[]} */ ...names) =>
    message("/simulator/_state", json({ playground: "p", robots: names.map((name) => ({ name })) }));
  const channels = { type: "channels", topics: ["/a/_ground_truth/odom", "/_ground_truth/odom"] };
  const odometry = message("/a/_raw/ground", { data: [] });
  const { robots, selected } = after(/** @type {any} */ ([channels, reported("a"), reported(""), odometry, channels]));
  assert.deepEqual([Object.keys(robots), selected], [[""], ""]);
  assert.deepEqual(Object.keys(after(/** @type {any} */ ([reported(""), channels, reported("a")])).robots), ["a"]);
});

test("with many robots, beams and values are subscribed to for the selected robot only", () => {
  /** @param {number} count */
  const state = (count) => ({
    selected: "r1",
    simulator: null,
    sensors: [],
    sensorsShown: true,
    topics: [],
    robots: Object.fromEntries(Array.from({ length: count }, (_, number) => [`r${number}`, NEW_ROBOT])),
  });
  const topics = ["/r0/_ground_truth/odom", "/r0/_led/state", "/r0/_raw/proximity", "/r1/_raw/proximity", "/_markers"];
  /** @param {number} count */
  const watched = (count) => topics.filter((topic) => isWatched(state(count), topic));
  assert.deepEqual(watched(2), topics);
  assert.deepEqual(watched(20), topics.filter((topic) => topic !== "/r0/_raw/proximity"));
  assert.equal(isWatched(state(20), "/r1/no/such"), false);
});

test("integers that only the sensor panel shows are wanted while it is open", () => {
  const topics = ["/_raw/compass", "/_raw/motor", "/_raw/leds", "/_raw/ground"];
  const wanted = (/** @type {State} */ state) => topics.filter((topic) => isWatched(state, topic));
  const shown = after([
    { type: "channels", topics: ["/_ground_truth/odom"] },
    message("/simulator/_sensors", json([{ name: "compass", label: { en: "compass" }, values: [] }])),
  ]);
  assert.deepEqual(wanted(shown), ["/_raw/ground"]);
  const open = after([{ type: "showSensors", shown: true }], shown);
  assert.deepEqual(wanted(open), ["/_raw/compass", "/_raw/motor", "/_raw/ground"]);
  assert.notEqual(subscriptionKey(open), subscriptionKey(shown));
  const heard = after([message("/_raw/compass", { data: [90] })], open);
  assert.deepEqual(heard.robots[""].raw.compass, [90]);
});

test("with many robots, readings are discarded when another robot is selected", () => {
  const names = ["a", "b", "c", "d", "e"];
  const topics = (/** @type {number} */ count) => names.slice(0, count).map((name) => `/${name}/_ground_truth/odom`);
  const story = (/** @type {number} */ count) =>
    after([
      { type: "channels", topics: topics(count) },
      message("/a/_raw/ground", { data: [1, 2] }),
      { type: "select", robot: "b" },
      { type: "select", robot: "a" },
    ]).robots.a.raw;
  assert.deepEqual(story(2), { ground: [1, 2] });
  assert.deepEqual(story(5), {});
});

test("robots are in the order of their numbers", () => {
  const topics = ["/thymio_10/_ground_truth/odom", "/thymio_2/_ground_truth/odom", "/anna/_ground_truth/odom"];
  assert.deepEqual(Object.keys(after([{ type: "channels", topics }]).robots), ["anna", "thymio_2", "thymio_10"]);
});

test("a notice disappears with its cause, and one of the bridge when the bridge removes it", () => {
  const store = new Store();
  /** @param {import("../../web_ui/state/index.js").Message[]} messages */
  const reported = (...messages) => {
    for (const message of messages) store.dispatch(message);
    return store.state.notices.map(({ text, technical }) => text || technical);
  };
  reported({ type: "notice", level: "error", text: "refused", cause: "/simulator/step" });
  reported({ type: "notice", level: "error", text: "for good" });
  reported({ type: "status", status: { level: 2, message: "too many", id: "channels" } });
  assert.deepEqual(reported({ type: "solved", cause: "/simulator/step" }), ["for good", "too many"]);
  assert.deepEqual(reported({ type: "removeStatus", ids: ["channels"] }), ["for good"]);
  reported({ type: "notice", level: "error", text: "no connection", cause: "connection" });
  assert.deepEqual(reported({ type: "connected" }), ["for good"]);
});

test("a notice about a file disappears with the next attempt", () => {
  const store = new Store();
  store.dispatch({ type: "notice", level: "error", text: "no playground", cause: "file" });
  store.dispatch({ type: "notice", level: "error", text: "bad.json", cause: "upload playground" });
  store.dispatch({ type: "notice", level: "error", text: "bad.aesl", cause: "upload program" });
  store.dispatch({ type: "upload", what: "playground", name: "good.json", text: "" });
  assert.deepEqual(
    store.state.notices.map(({ text }) => text),
    ["bad.aesl"],
  );
});

test("the id of a notice is never reused", () => {
  const store = new Store();
  store.dispatch({ type: "notice", level: "info", text: "one" });
  const [{ id }] = store.state.notices;
  store.dispatch({ type: "dismiss", id });
  store.dispatch({ type: "notice", level: "info", text: "two" });
  assert.notEqual(store.state.notices[0].id, id);
});

test("fallen robots are listed by their names in topics", () => {
  const robots = [
    { name: "", robot: "thymio", fallen: true },
    { name: "b", robot: "blue", fallen: false },
  ];
  const { simulator } = after([message("/simulator/_state", json({ playground: "table", robots }))]);
  assert.deepEqual(simulator?.fallen, [""]);
});

test("actions go to the selected robot, or to all of several until one is selected", () => {
  const two = reduce(INITIAL, { type: "channels", topics: ["/a/_ground_truth/odom", "/b/_ground_truth/odom"] });
  assert.deepEqual(targets(two), ["a"]);
  const all = reduce(two, { type: "address", all: true });
  assert.deepEqual([targets(all), all.selected], [["a", "b"], "a"]);
  assert.deepEqual(targets(reduce(all, { type: "select", robot: "b" })), ["b"]);
  const one = reduce(all, { type: "channels", topics: ["/a/_ground_truth/odom"] });
  assert.deepEqual([one.toAll, targets(one)], [false, ["a"]]);
  assert.equal(reduce(one, { type: "address", all: true }).toAll, false);
});
