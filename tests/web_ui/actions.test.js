import assert from "node:assert/strict";
import { test } from "node:test";

import { Actions, LARGEST_PLAYGROUND, LARGEST_PROGRAM } from "../../web_ui/input/actions.js";
import { LOAD_SERVICE } from "../../web_ui/input/check_service.js";
import { Store } from "../../web_ui/state/store.js";

/** @typedef {import("../../web_ui/state/index.js").Message} Message */

/** Actions over a client that notes what it is asked, and answers as reported. */
function prepared({ ok = true, message = "", value = /** @type {any} */ (undefined) } = {}) {
  /** @type {any[]} */ const asked = [];
  const client = {
    publish: (/** @type {any[]} */ ...given) => asked.push(["publish", ...given]),
    call: async (/** @type {any[]} */ ...given) => {
      asked.push(["call", ...given]);
      return { ok, message, value };
    },
    setParameters: async (/** @type {any} */ given) => {
      asked.push(["set", given]);
      return { ok, message, value: undefined };
    },
  };
  const store = new Store();
  const options = { client: /** @type {any} */ (client), store, t: (/** @type {string} */ key) => key, language: () => "de" };
  const actions = new Actions({ ...options, later: (act) => act() });
  return { actions, asked, store };
}

/** @param {Store} store @param {string[]} topics @param {string[]} names */
function connect(store, topics, names) {
  store.dispatch({ type: "channels", topics });
  store.dispatch({ type: "services", names });
}

test("a button press is published to its robot", () => {
  const { actions, asked } = prepared();
  actions.press("", "left", true);
  actions.press("thymio_1", "left", false);
  assert.deepEqual(asked, [
    ["publish", "/_press/left", "std_msgs/msg/Bool", { data: true }],
    ["publish", "/thymio_1/_press/left", "std_msgs/msg/Bool", { data: false }],
  ]);
});

test("a button of the pad goes to the addressed robots, and is released where it was pressed", () => {
  const { actions, asked, store } = prepared();
  connect(store, ["/a/_ground_truth/odom", "/b/_ground_truth/odom"], []);
  store.dispatch({ type: "address", all: true });
  actions.pressPad("left", true);
  store.dispatch({ type: "select", robot: "b" });
  actions.pressPad("left", false);
  assert.deepEqual(
    asked.map(([, topic, , { data }]) => `${topic} ${data}`),
    ["/a/_press/left true", "/b/_press/left true", "/a/_press/left false", "/b/_press/left false"],
  );
});

test("a stimulus is published to the selected robot", () => {
  const { actions, asked, store } = prepared();
  connect(store, ["/a/_ground_truth/odom", "/b/_ground_truth/odom"], []);
  store.dispatch({ type: "select", robot: "b" });
  actions.operate("_press/clap", "std_msgs/msg/Float32", { data: 1 });
  assert.deepEqual(asked.splice(0), [["publish", "/b/_press/clap", "std_msgs/msg/Float32", { data: 1 }]]);
  store.dispatch({ type: "address", all: true });
  actions.operate("_press/tap", "std_msgs/msg/Empty", {});
  assert.deepEqual(
    asked.map(([, topic]) => topic),
    ["/a/_press/tap", "/b/_press/tap"],
  );
});

test("of several robots, only the selected one is stopped", async () => {
  const { actions, asked, store } = prepared();
  connect(store, ["/a/_ground_truth/odom", "/b/_ground_truth/odom"], ["/a/aseba/stop", "/b/aseba/stop"]);
  store.dispatch({ type: "select", robot: "b" });
  await actions.stop();
  assert.deepEqual(
    asked.map(([, name]) => name),
    ["/b/aseba/stop", "/b/cmd_vel"],
  );
});

test("a program goes to the selected robot, to all, or to the only one", async () => {
  const { actions, asked, store } = prepared();
  /** The texts of the only request. @param {() => Promise<any>} act */
  const asks = async (act) => {
    await act();
    const [[, service, { parameters }], ...others] = asked.splice(0);
    assert.deepEqual([service, others], [LOAD_SERVICE, []]);
    return parameters.map((/** @type {any} */ { name, value }) => `${name}=${value.string_value}`).join(" ");
  };
  assert.equal(await asks(() => actions.load("x.aesl", "x")), "source=x name=x.aesl language=de");
  connect(store, ["/a/_ground_truth/odom", "/b/_ground_truth/odom"], []);
  assert.equal(await asks(() => actions.load("y.aesl", "y")), "source=y name=y.aesl language=de robot=a");
  assert.equal(await asks(() => actions.loadExample("explorer")), "behaviour=explorer language=de robot=a");
  store.dispatch({ type: "address", all: true });
  assert.equal(await asks(() => actions.load("z.aesl", "z")), "source=z name=z.aesl language=de");
  assert.equal(await asks(() => actions.loadExample("explorer")), "behaviour=explorer language=de");
});

test("stop ends every program first, and then sets every speed to zero", async () => {
  const { actions, asked, store } = prepared();
  connect(store, ["/a/_ground_truth/odom", "/b/_ground_truth/odom"], ["/a/aseba/stop", "/b/aseba/stop", "/a/aseba/run"]);
  store.dispatch({ type: "address", all: true });
  await actions.stop();
  assert.deepEqual(
    asked.map(([kind, name]) => `${kind} ${name}`),
    ["call /a/aseba/stop", "call /b/aseba/stop", "publish /a/cmd_vel", "publish /b/cmd_vel"],
  );
});

test("a robot's own runtime is called, else the shared one", async () => {
  const { actions, asked, store } = prepared();
  connect(store, ["/a/_ground_truth/odom"], ["/aseba/run", "/aseba/stop", "/a/aseba/run"]);
  await actions.program("run");
  await actions.program("stop");
  assert.deepEqual(
    asked.map(([, name]) => name),
    ["/a/aseba/run", "/aseba/stop"],
  );
});

test("a rejected call is reported", async () => {
  const { actions, store } = prepared({ ok: false, message: "not paused" });
  await actions.step(10);
  assert.deepEqual(
    store.state.notices.map(({ level, text, technical }) => [level, text, technical]),
    [["error", "action.refused", "not paused"]],
  );
});

test("a program file is sent to the runtime with its name", async () => {
  const { actions, asked, store } = prepared();
  await actions.loadFile(new File(["onevent prox\n"], "line.aesl"));
  const [[, service, { parameters }]] = asked;
  assert.equal(service, LOAD_SERVICE);
  assert.deepEqual(
    parameters.map((/** @type {any} */ { value }) => value.string_value),
    ["onevent prox\n", "line.aesl", "de"],
  );
  assert.equal(store.state.uploads.program?.phase, "accepted");
});

test("a playground file is sent to the simulator with its name", async () => {
  const { actions, asked, store } = prepared({ ok: false, message: "/simulator.playground: robots: found 0" });
  await actions.loadFile(new File(["{}"], "my own.JSON"));
  const value = "data:application/octet-stream;name=my%20own.JSON;base64,e30=";
  assert.deepEqual(asked, [["set", [{ name: "/simulator.playground", value }]]]);
  assert.equal(store.state.uploads.playground?.fault?.text, "robots: found 0");
});

test("archives and Aseba's playgrounds are sent byte by byte", async () => {
  const { actions, asked } = prepared();
  const bytes = Uint8Array.from({ length: 100_000 }, (_, index) => index % 256);
  for (const name of ["maze.playground", "maze.zip", "world.xml"]) {
    await actions.loadFile(new File([bytes], name));
    const [, [{ value }]] = asked.at(-1);
    assert.deepEqual(Buffer.from(value.split(",")[1], "base64"), Buffer.from(bytes));
  }
});

test("a shipped playground is sent by name", async () => {
  const { actions, asked } = prepared();
  await actions.loadPlayground("base");
  assert.deepEqual(asked, [["set", [{ name: "/simulator.playground", value: "base" }]]]);
});

test("files of other kinds, and too large ones, are not sent", async () => {
  const { actions, asked, store } = prepared();
  await actions.loadFile(new File(["x"], "holiday.png"));
  await actions.loadFile(new File(["x".repeat(LARGEST_PROGRAM + 1)], "long.aesl"));
  await actions.loadFile(new File(["x".repeat(LARGEST_PLAYGROUND + 1)], "large.json"));
  assert.deepEqual(asked, []);
  assert.deepEqual(
    store.state.notices.map(({ text }) => text),
    ["file.unknown", "file.tooLarge"],
  );
});

test("a robot is placed by a service, and a rejection becomes a notice", async () => {
  for (const successful of [true, false]) {
    const { actions, asked, store } = prepared({ value: { results: [{ successful, reason: "a wall" }] } });
    assert.equal(await actions.place("thymio", { x: 1, y: 2, yaw: 3 }), successful);
    const parameters = [{ name: "thymio", value: { type: 8, double_array_value: [1, 2, 3] } }];
    assert.deepEqual(asked, [["call", "/simulator/set_poses", { parameters }]]);
    assert.equal(store.state.notices.length, successful ? 0 : 1);
  }
});

test("what is in the way of a robot is named in the language of the page", async () => {
  const reason = "'thymio' cannot be placed at 1.000, 2.000 m: occupied by 'box_1'";
  const { actions, store } = prepared({ value: { results: [{ successful: false, reason }] } });
  await actions.place("thymio", { x: 1, y: 2, yaw: 3 });
  assert.deepEqual(
    store.state.notices.map(({ text, technical }) => [text, technical]),
    [["move.refusedBy", reason]],
  );
});

test("a simulator that cannot move objects is reported", async () => {
  const { actions, store } = prepared({ ok: false, message: "not available" });
  assert.equal(await actions.place("thymio", { x: 0, y: 0, yaw: 0 }), false);
  assert.equal(store.state.notices.length, 1);
});

test("the world starts again with a playground that it has", async () => {
  const { actions, asked, store } = prepared();
  store.dispatch({ type: "parameters", parameters: [{ name: "/simulator.playground", value: "base" }] });
  await actions.loadPlayground("base");
  assert.deepEqual(asked.map(([, name]) => name).slice(1), ["/simulator/reset"]);
});

test("a rejected program is explained in the language of the page", async () => {
  const errors = [{ line: 1, column: 9, length: 5, message: "kein Ereignis heißt 'zzzzz'", kind: "unknown-event", node: "" }];
  const value = { result: { successful: false, reason: JSON.stringify({ errors }) } };
  const { actions, asked, store } = prepared({ value });
  const client = /** @type {any} */ (actions.client);
  await actions.loadProgram("a.aesl", "onevent zzzzz");
  assert.deepEqual(store.state.uploads.program?.fault, { text: "kein Ereignis heißt 'zzzzz'", line: 1, column: 9 });
  assert.deepEqual(asked[0][2].parameters[2], { name: "language", value: { type: 4, string_value: "de" } });
  client.call = async () => ({ ok: false, message: "gone" });
  await actions.loadProgram("a.aesl", "onevent zzzzz");
  assert.equal(store.state.uploads.program?.fault?.text, "gone");
});

test("a touch lasts long enough to be polled by the robot", () => {
  const { asked, store } = prepared();
  let now = 0;
  /** @type {[() => void, number][]} */ const waiting = [];
  const client = /** @type {any} */ ({ publish: (/** @type {any} */ _topic, /** @type {any} */ _type, /** @type {any} */ { data }) => asked.push(data) });
  const later = (/** @type {() => void} */ act, /** @type {number} */ ms) => waiting.push([act, ms]);
  const actions = new Actions({ client, store, t: (key) => key, language: () => "en", now: () => now, later });
  actions.press("", "left", true);
  now = 20;
  actions.press("", "left", false);
  assert.deepEqual([asked, waiting.map(([, ms]) => ms)], [[true], [100]]);
  waiting[0][0]();
  assert.deepEqual(asked, [true, false]);
  now = 500;
  actions.press("", "left", true);
  now = 510;
  actions.press("", "left", false);
  now = 520;
  actions.press("", "left", true); // again, before the first was let go
  waiting[1][0]();
  now = 900;
  actions.press("", "left", false);
  assert.deepEqual(asked, [true, false, true, true, false]);
});

test("a step has the selected length", async () => {
  const { actions, asked } = prepared();
  await actions.step(100);
  assert.deepEqual(asked, [
    ["set", [{ name: "/simulator.step_ticks", value: 100 }]],
    ["call", "/simulator/step", undefined],
  ]);
});

test("an error disappears when the action succeeds", async () => {
  const refused = prepared({ ok: false, message: "not paused" });
  await refused.actions.step(1);
  const done = new Actions({
    client: /** @type {any} */ ({ call: async () => ({ ok: true, message: "" }), setParameters: async () => ({ ok: true }) }),
    store: refused.store,
    t: (key) => key,
    language: () => "de",
  });
  await done.step(1);
  assert.deepEqual(refused.store.state.notices, []);
});

test("a teacher's pause holds, and the page says so", async () => {
  const { actions, asked, store } = prepared();
  store.dispatch({ type: "parameters", parameters: [{ name: "/web_ui.paused_by_teacher", value: true }] });
  await actions.pause(false);
  assert.deepEqual(asked, []);
  assert.equal(store.state.notices[0].text, "time.pausedByTeacher");
  store.dispatch({ type: "parameters", parameters: [{ name: "/web_ui.paused_by_teacher", value: false }] });
  await actions.pause(false);
  assert.deepEqual(asked, [["call", "/simulator/pause", { data: false }]]);
});

test("solutions that do not pass come from the simulator, or why they cannot run", async () => {
  const results = [{ successful: true, reason: '{"vpl": [true, false]}' }];
  const { actions, asked } = prepared({ value: { results } });
  assert.deepEqual(await actions.checkMission("bus.zip", new Uint8Array([1])), { failing: { vpl: [true, false] }, reason: "" });
  assert.equal(asked[0][1], "/simulator/check_mission");
  results[0] = { successful: false, reason: "line 1: no" };
  assert.deepEqual(await actions.checkMission("bus.zip", new Uint8Array([1])), { failing: {}, reason: "line 1: no" });
});

test("what a pupil writes is sent to the class, and what others write is not", async () => {
  const { actions, asked, store } = prepared();
  store.dispatch({ type: "connected" });
  await actions.sendDraft("bus.aesl", "var a");
  assert.deepEqual(asked, []);
  store.dispatch({ type: "parameters", parameters: [{ name: "/web_ui.pupil", value: "Ada" }] });
  await actions.sendDraft("bus.aesl", "var a");
  await actions.sendDraft("bus.py", "import rclpy");
  assert.deepEqual(asked, [
    ["set", [{ name: "/web_ui.draft", value: "var a" }]],
    ["set", [{ name: "/web_ui.node_draft", value: "import rclpy" }]],
  ]);
});
