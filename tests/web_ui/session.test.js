import assert from "node:assert/strict";
import { test } from "node:test";

import { Session } from "../../web_ui/protocol/session.js";
import { bytes, captured, serverFrame } from "./support.js";

/** @typedef {import("../../web_ui/protocol/session.js").SessionEvent} SessionEvent */

/** A session with lists in place of the socket and the page. */
function opened() {
  /** @type {(string | Uint8Array)[]} */ const sent = [];
  /** @type {SessionEvent[]} */ const events = [];
  const session = new Session({
    send: (data) => sent.push(data),
    emit: (event) => events.push(event),
    wants: (topic) => topic !== "/unwanted",
    parameters: ["/simulator.playground"],
  });
  /** @param {object} message */
  const receive = (message) => session.receive(JSON.stringify(message));
  const json = () =>
    sent.filter((data) => typeof data === "string").map((data) => JSON.parse(/** @type {string} */ (data)));
  return { session, sent, events, receive, json };
}

/** @param {number} id @param {string} topic @param {string} schemaName */
function channel(id, topic, schemaName) {
  return { id, topic, encoding: "cdr", schemaName, schema: captured(schemaName).schema, schemaEncoding: "ros2msg" };
}

const TRIGGER = {
  id: 4,
  name: "/simulator/reset",
  type: "std_srvs/srv/Trigger",
  request: { encoding: "cdr", schemaName: "std_srvs/srv/Trigger_Request", schemaEncoding: "ros2msg", schema: "" },
  response: {
    encoding: "cdr",
    schemaName: "std_srvs/srv/Trigger_Response",
    schemaEncoding: "ros2msg",
    schema: captured("std_srvs/srv/Trigger_Response").schema,
  },
};

test("wanted topics are subscribed to, and their messages arrive decoded", () => {
  const { receive, session, json, events } = opened();
  receive({
    op: "advertise",
    channels: [channel(1, "/unwanted", "std_msgs/msg/Bool"), channel(2, "/buttons/left", "std_msgs/msg/Bool")],
  });
  const [{ op, subscriptions }] = json();
  assert.equal(op, "subscribe");
  assert.deepEqual(
    subscriptions.map((/** @type {any} */ s) => s.channelId),
    [2],
  );
  session.receive(
    serverFrame(
      1,
      [
        [4, subscriptions[0].id],
        [8, 5n],
      ],
      bytes(captured("std_msgs/msg/Bool").hex),
    ),
  );
  assert.deepEqual(events.at(-1), { type: "message", topic: "/buttons/left", value: { data: true }, timeNs: 5n });
});

test("a removed channel leaves the list, and its late messages are dropped", () => {
  const { receive, session, json, events } = opened();
  receive({ op: "advertise", channels: [channel(2, "/buttons/left", "std_msgs/msg/Bool")] });
  receive({ op: "unadvertise", channelIds: [2] });
  session.receive(
    serverFrame(
      1,
      [
        [4, json()[0].subscriptions[0].id],
        [8, 5n],
      ],
      bytes(captured("std_msgs/msg/Bool").hex),
    ),
  );
  assert.deepEqual(events.at(-1), { type: "channels", topics: [] });
});

test("parameters are requested once the server announces the capability", () => {
  const { receive, json } = opened();
  receive({ op: "serverInfo", name: "bridge", capabilities: ["parameters"], sessionId: "1" });
  assert.deepEqual(
    json().map(({ op }) => op),
    ["subscribeParameterUpdates", "getParameters"],
  );
});

test("publishing advertises the topic once", () => {
  const { session, json, sent } = opened();
  session.publish("/_press/left", "std_msgs/msg/Bool", { data: true });
  session.publish("/_press/left", "std_msgs/msg/Bool", { data: false });
  assert.deepEqual(
    json().map(({ op, channels }) => [op, channels[0].topic, channels[0].encoding]),
    [["advertise", "/_press/left", "cdr"]],
  );
  const id = json()[0].channels[0].id;
  assert.deepEqual(
    sent.slice(1).map((data) => Buffer.from(data).toString("hex")),
    [`01${hex32(id)}0001000001`, `01${hex32(id)}0001000000`],
  );
});

test("a zero twist is written as rclpy writes it", () => {
  const { session, sent } = opened();
  session.publish("/cmd_vel", "geometry_msgs/msg/Twist", { linear: { x: 0.125 }, angular: { z: -2.5 } });
  assert.equal(Buffer.from(sent[1]).toString("hex").slice(10), captured("geometry_msgs/msg/Twist").hex);
});

test("a service call returns the answer of the service", async () => {
  const { session, receive, sent } = opened();
  receive({ op: "advertiseServices", services: [TRIGGER] });
  const answer = session.call("/simulator/reset");
  const request = Buffer.from(sent[0]);
  assert.equal(request.toString("hex").slice(26), "636472" + "0001000000");
  const response = Buffer.concat([Buffer.from("cdr"), bytes(captured("std_srvs/srv/Trigger_Response").hex)]);
  session.receive(
    serverFrame(
      3,
      [
        [4, 4],
        [4, request.readUInt32LE(5)],
        [4, 3],
      ],
      response,
    ),
  );
  assert.deepEqual(await answer, { ok: true, message: "done", value: { success: true, message: "done" } });
});

test("a failed service call returns the reason", async () => {
  const { session, receive, sent } = opened();
  receive({ op: "advertiseServices", services: [TRIGGER] });
  const answer = session.call("/simulator/reset");
  receive({ op: "serviceCallFailure", serviceId: 4, callId: Buffer.from(sent[0]).readUInt32LE(5), message: "gone" });
  assert.deepEqual(await answer, { ok: false, message: "gone" });
});

test("a missing service is reported immediately", async () => {
  const { session } = opened();
  assert.deepEqual(await session.call("/nowhere"), { ok: false, message: "/nowhere is not available" });
});

test("an accepted parameter is answered with its value", async () => {
  const { session, receive, json } = opened();
  const answer = session.setParameters([{ name: "/a.x", value: 2 }]);
  receive({ op: "parameterValues", parameters: [{ name: "/a.x", value: 2 }], id: json()[0].id });
  assert.deepEqual(await answer, { ok: true, value: 2, message: "" });
});

test("a parameter is rejected by the status before its answer", async () => {
  const { session, receive, json } = opened();
  const answer = session.setParameters([
    { name: "/a.name", value: "n" },
    { name: "/a.x", value: 2 },
  ]);
  receive({ op: "status", level: 2, message: "/a.x: line 3, column 5: no", id: "parameter:/a.x" });
  receive({
    op: "parameterValues",
    parameters: [
      { name: "/a.name", value: "n" },
      { name: "/a.x", value: 1 },
    ],
    id: json()[0].id,
  });
  assert.deepEqual(await answer, { ok: false, value: 1, message: "/a.x: line 3, column 5: no" });
});

test("an earlier rejection does not affect a later request", async () => {
  const { session, receive, json } = opened();
  receive({ op: "status", level: 2, message: "old", id: "parameter:/a.x" });
  const answer = session.setParameters([{ name: "/a.x", value: 2 }]);
  receive({ op: "parameterValues", parameters: [{ name: "/a.x", value: 2 }], id: json()[0].id });
  assert.equal((await answer).ok, true);
});

test("nothing stays pending when the connection is lost", async () => {
  const { session, receive } = opened();
  receive({ op: "advertiseServices", services: [TRIGGER] });
  const answers = [session.call("/simulator/reset"), session.setParameters([{ name: "/a.x", value: 2 }])];
  session.close();
  assert.deepEqual(
    (await Promise.all(answers)).map(({ ok, message }) => [ok, message]),
    [
      [false, "connection lost"],
      [false, "connection lost"],
    ],
  );
});

test("an invalid message is one fault, and the next message is processed", () => {
  const { session, receive, events } = opened();
  session.receive("{");
  session.receive(new ArrayBuffer(0));
  receive({ op: "something new" });
  receive({ op: "removeStatus", statusIds: ["a"] });
  assert.deepEqual(
    events.map(({ type }) => type),
    ["fault", "fault", "removeStatus"],
  );
});

test("a channel with an invalid schema does not affect the others", () => {
  const { receive, json, events } = opened();
  const broken = { ...channel(1, "/broken", "std_msgs/msg/Bool"), schema: "nonsense" };
  receive({ op: "advertise", channels: [broken, channel(2, "/buttons/left", "std_msgs/msg/Bool")] });
  assert.deepEqual(
    json()[0].subscriptions.map((/** @type {any} */ s) => s.channelId),
    [2],
  );
  assert.ok(events.some(({ type }) => type === "fault"));
});

test("the state knows all robots before anything is subscribed to, and what is urgent comes first", () => {
  /** @type {string[]} */ const known = [];
  /** @type {any[]} */ const sent = [];
  const session = new Session({
    send: (data) => sent.push(JSON.parse(String(data))),
    emit: (event) => event.type === "channels" && known.push(...event.topics),
    wants: (topic) => known.length === 2 && known.includes(topic),
    urgency: (topic) => (topic === "/tf" ? 0 : 1),
  });
  session.advertise([channel(1, "/a/buttons/left", "std_msgs/msg/Bool"), channel(2, "/tf", "std_msgs/msg/Bool")]);
  assert.deepEqual(sent[0].subscriptions.map((/** @type {any} */ { channelId }) => channelId), [2, 1]);
});

/** @param {number} value */
function hex32(value) {
  const buffer = Buffer.alloc(4);
  buffer.writeUInt32LE(value);
  return buffer.toString("hex");
}
