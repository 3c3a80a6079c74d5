import assert from "node:assert/strict";
import { test } from "node:test";

import { Namespace } from "../../web_ui/protocol/namespace.js";
import { Session } from "../../web_ui/protocol/session.js";
import { bytes, captured, serverFrame } from "./support.js";

/** @param {string} [bridge] @param {string[]} [topics] */
function namespace(bridge = "/", topics = []) {
  const names = new Namespace();
  names.prefer(bridge);
  names.choose(topics);
  return names;
}

test("without a namespace all names are as they are", () => {
  const names = namespace("/", ["/simulator/_state", "/odom"]);
  for (const name of ["/odom", "/tf", "/anna/_led/state", "/simulator.playground"]) {
    assert.equal(names.inner(name), name);
    assert.equal(names.outer(name), name);
  }
});

test("in a namespace, names are shortened and restored, except names of all namespaces", () => {
  const names = namespace("/lab1", ["/lab1/simulator/_state"]);
  for (const [whole, name] of [
    ["/lab1/odom", "/odom"],
    ["/lab1/anna/_led/state", "/anna/_led/state"],
    ["/lab1/simulator.playground", "/simulator.playground"],
    ["/tf", "/tf"],
    ["/clock", "/clock"],
  ]) {
    assert.equal(names.inner(whole), name);
    assert.equal(names.outer(name), whole);
  }
});

test("names of another suite are ignored", () => {
  const names = namespace("/lab1", ["/lab1/simulator/_state", "/lab2/simulator/_state"]);
  for (const name of ["/lab2/odom", "/lab10/odom", "/odom"]) assert.equal(names.inner(name), null);
});

test("a simulator is found where the bridge is, else below", () => {
  for (const [bridge, topics, prefix] of /** @type {[string, string[], string][]} */ ([
    ["/", ["/b/simulator/_state", "/simulator/_state", "/a/simulator/_state"], ""],
    ["/", ["/b/simulator/_state", "/a/simulator/_state"], "/a"],
    ["/b", ["/b/simulator/_state", "/simulator/_state", "/a/simulator/_state"], "/b"],
    ["/b", ["/a/simulator/_state", "/b/c/simulator/_state", "/bc/simulator/_state"], "/b/c"],
    ["/b", ["/a/simulator/_state"], "/b"],
    ["/b", [], "/b"],
  ])) {
    assert.equal(namespace(bridge, topics).prefix, prefix);
  }
});

test("the simulator that was found first stays, until the bridge's own comes", () => {
  const names = namespace("/", ["/b/simulator/_state"]);
  assert.equal(names.choose(["/a/simulator/_state", "/b/simulator/_state"]), false);
  assert.equal(names.prefix, "/b");
  assert.equal(names.choose(["/simulator/_state", "/a/simulator/_state", "/b/simulator/_state"]), true);
  assert.equal(names.prefix, "");
});

// --- the session

const TRIGGER = captured("std_srvs/srv/Trigger_Response");

/** @param {string} name @param {number} id */
function service(name, id) {
  const half = { encoding: "cdr", schemaEncoding: "ros2msg" };
  return {
    id,
    name,
    type: "std_srvs/srv/Trigger",
    request: { ...half, schemaName: "std_srvs/srv/Trigger_Request", schema: "" },
    response: { ...half, schemaName: "std_srvs/srv/Trigger_Response", schema: TRIGGER.schema },
  };
}

/** @param {number} id @param {string} topic @param {string} schemaName */
function channel(id, topic, schemaName = "std_msgs/msg/Bool") {
  return { id, topic, encoding: "cdr", schemaName, schema: captured(schemaName).schema, schemaEncoding: "ros2msg" };
}

/** @param {string} bridge */
function opened(bridge) {
  /** @type {any[]} */ const sent = [];
  /** @type {any[]} */ const events = [];
  const session = new Session({
    send: (data) => sent.push(typeof data === "string" ? JSON.parse(data) : data),
    emit: (event) => events.push(event),
    wants: (topic) => /^(?:\/anna)?\/buttons\/left$|_state$/.test(topic),
    parameters: ["/simulator.playground"],
  });
  /** @param {object} message */
  const receive = (message) => session.receive(JSON.stringify(message));
  receive({ op: "serverInfo", name: "x", capabilities: ["parameters"], metadata: { namespace: bridge } });
  return { session, sent, events, receive };
}

test("a session in a namespace sends full names and reports short ones", async () => {
  const { session, sent, events, receive } = opened("/lab1");
  assert.deepEqual(
    sent.map(({ op, parameterNames }) => [op, parameterNames]),
    [
      ["subscribeParameterUpdates", ["/lab1/simulator.playground"]],
      ["getParameters", ["/lab1/simulator.playground"]],
    ],
  );
  const names = ["/lab1/simulator/_state", "/lab1/anna/buttons/left", "/lab2/anna/buttons/left", "/buttons/left", "/tf"];
  receive({ op: "advertise", channels: names.map((name, id) => channel(id, name)) });
  assert.deepEqual(events.at(-1), { type: "channels", topics: ["/anna/buttons/left", "/simulator/_state", "/tf"] });
  const [{ subscriptions }] = sent.splice(2);
  assert.deepEqual(subscriptions.map((/** @type {any} */ { channelId }) => channelId), [0, 1]);
  const { hex } = captured("std_msgs/msg/Bool");
  session.receive(serverFrame(1, [[4, subscriptions[1].id], [8, 1n]], bytes(hex)));
  assert.equal(events.at(-1).topic, "/anna/buttons/left");

  session.publish("/anna/cmd_vel", "std_msgs/msg/Bool", { data: true });
  assert.equal(sent.find(({ op }) => op === "advertise").channels[0].topic, "/lab1/anna/cmd_vel");

  receive({ op: "advertiseServices", services: [service("/lab1/simulator/reset", 1), service("/lab2/simulator/reset", 2)] });
  assert.deepEqual(events.at(-1), { type: "services", names: ["/simulator/reset"] });
  void session.call("/simulator/reset");
  assert.equal(new DataView(sent.at(-1).buffer, sent.at(-1).byteOffset).getUint32(1, true), 1);

  receive({ op: "parameterValues", parameters: [{ name: "/lab1/simulator.playground", value: "line" }, { name: "/lab2/x.y", value: 1 }] });
  assert.deepEqual(events.at(-1).parameters, [{ name: "/simulator.playground", value: "line" }]);
  const answer = session.setParameters([{ name: "/simulator.playground", value: "nowhere" }]);
  const { parameters, id } = sent.at(-1);
  assert.deepEqual(parameters, [{ name: "/lab1/simulator.playground", value: "nowhere" }]);
  receive({ op: "status", level: 2, message: "/lab1/simulator.playground: no", id: "parameter:/lab1/simulator.playground" });
  receive({ op: "parameterValues", parameters: [{ name: "/lab1/simulator.playground", value: "line" }], id });
  assert.deepEqual(await answer, { ok: false, value: "line", message: "/simulator.playground: no" });
});

test("a simulator that appears in another namespace changes all names", () => {
  const { sent, events, receive } = opened("/");
  receive({ op: "advertiseServices", services: [service("/lab1/simulator/reset", 1)] });
  receive({ op: "advertise", channels: [channel(1, "/buttons/left")] });
  const [, , { subscriptions: first }] = sent.splice(0);
  receive({ op: "advertise", channels: [channel(2, "/lab1/simulator/_state"), channel(3, "/lab1/buttons/left")] });
  assert.deepEqual(
    sent.map(({ op }) => op),
    ["unsubscribe", "subscribe", "subscribeParameterUpdates", "getParameters"],
  );
  assert.deepEqual(sent[0].subscriptionIds, first.map((/** @type {any} */ { id }) => id));
  assert.deepEqual(sent[1].subscriptions.map((/** @type {any} */ { channelId }) => channelId), [2, 3]);
  assert.deepEqual(sent[3].parameterNames, ["/lab1/simulator.playground"]);
  assert.deepEqual(events.filter(({ type }) => type === "services").at(-1).names, ["/simulator/reset"]);
  const { topics } = events.filter(({ type }) => type === "channels").at(-1);
  assert.deepEqual(topics, ["/buttons/left", "/simulator/_state"]);
});
