// ROS nodes in Python on the page: their errors, their output, and the client that runs them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { FileStore } from "../../web_ui/editor/file_store.js";
import { isUnsaved } from "../../web_ui/editor/documents.js";
import { Workspace } from "../../web_ui/editor/workspace.js";
import { LanguageChoice } from "../../web_ui/program_tab/language_choice.js";
import { appended, NodeClient } from "../../web_ui/python/node_client.js";
import { errorIn } from "../../web_ui/python/traceback.js";
import { newStorage } from "./support.js";

const FILE = "my node.py";

test("an error is in the innermost line of the program", () => {
  const output = [
    "hello",
    "Traceback (most recent call last):",
    `  File "${FILE}", line 12, in <module>`,
    "    rclpy.spin(A())",
    '  File "/x/rclpy/task.py", line 220, in _run',
    "    self.set_result(self._handler())",
    "                    ^^^^^^^^^^^^^^^",
    `  File "${FILE}", line 10, in tick`,
    "    print(name)",
    '  File "/x/other.py", line 1, in inside',
    "NameError: name 'name' is not defined",
    "",
  ].join("\n");
  assert.deepEqual(errorIn(output, FILE), { line: 10, message: "NameError: name 'name' is not defined" });
});

test("the error of a text that is no Python has its line, too", () => {
  const output = `  File "${FILE}", line 2\n    for x in 3\n              ^\nSyntaxError: expected ':'\n`;
  assert.deepEqual(errorIn(output, FILE), { line: 2, message: "SyntaxError: expected ':'" });
});

test("the last one counts, an exception without a message too, and other output is none", () => {
  const place = `  File "${FILE}", line 3, in f\n    f()\n`;
  assert.deepEqual(errorIn(`${place}ValueError: a\nlater\n${place.replace("3", "5")}KeyboardInterrupt\n`, FILE), {
    line: 5,
    message: "KeyboardInterrupt",
  });
  for (const output of ["", "line 3", "ValueError: a\n", `  File "other.py", line 3\nValueError: a\n`, `${place}word\n`]) {
    assert.equal(errorIn(output, FILE), null);
  }
});

test("a long output keeps its end, from the begin of a line", () => {
  assert.equal(appended("a\n", "b\n"), "a\nb\n");
  const long = appended("", "0123456789\n".repeat(10_000));
  assert.ok(long.length < 61_000);
  assert.match(long, /^…\n0123456789\n/);
  assert.ok(appended("", "x".repeat(200_000)).length < 61_000);
});

/** A client with its last socket, which a test drives. @param {string} [token] */
function newClient(token = "") {
  /** @type {any[]} */ const sockets = [];
  let changes = 0;
  const client = new NodeClient({
    page: "https://school.example/p/anna/?x=1#y",
    token,
    changed: () => (changes += 1),
    load: /** @type {any} */ (async (/** @type {URL} */ address, /** @type {any} */ { headers }) => {
      if (address.pathname !== "/p/anna/page-node.json") throw new Error(address.href);
      return { json: async () => ({ right: headers.Authorization ?? "local", may_run: true }) };
    }),
    open: (address, protocols) => {
      const socket = { address, protocols, sent: /** @type {any[]} */ ([]), isClosed: false };
      const api = { send: (/** @type {string} */ text) => socket.sent.push(JSON.parse(text)), close: () => (socket.isClosed = true) };
      sockets.push(Object.assign(socket, api));
      return /** @type {any} */ (socket);
    },
  });
  /** @param {any} message */
  const say = (message) => sockets.at(-1).onmessage({ data: JSON.stringify(message) });
  return { client, sockets, say, changes: () => changes };
}

const PROGRAM = { name: FILE, text: "print(1)", namespace: "", sim_time: true };

test("a program begins when all is ready, and what has to be before it is done", async () => {
  const { client, sockets, say } = newClient("secret");
  let isPrepared = false;
  client.run(PROGRAM, async () => (isPrepared = true));
  assert.equal(sockets[0].address, "wss://school.example/p/anna/page-node");
  assert.deepEqual(sockets[0].protocols, ["page-node", "token.secret"]);
  sockets[0].onopen();
  assert.deepEqual(sockets[0].sent, [{ op: "run", ...PROGRAM }]);
  assert.equal(client.state, "starting");
  say({ op: "ready", level: "namespaces" });
  await Promise.resolve();
  assert.ok(isPrepared);
  await Promise.resolve();
  assert.deepEqual(sockets[0].sent.at(-1), { op: "begin" });
  assert.equal(client.state, "running");
  say({ op: "output", text: "1\n" });
  say({ op: "ended", code: 0, reason: "" });
  assert.deepEqual([client.state, client.output, client.end], ["idle", "1\n", { code: 0, reason: "", text: "" }]);
  assert.ok(sockets[0].isClosed);
});

test("a second run ends the first one, whose messages do not count any more", () => {
  const { client, sockets } = newClient();
  client.run(PROGRAM);
  client.again();
  assert.ok(sockets[0].isClosed);
  sockets[0].onmessage({ data: '{"op":"output","text":"old"}' });
  sockets[0].onclose();
  assert.deepEqual([client.output, client.state], ["", "starting"]);
});

test("a program that is stopped while the world is prepared does not begin", async () => {
  const { client, sockets, say } = newClient();
  client.run(PROGRAM, async () => client.leave());
  say({ op: "ready" });
  await new Promise(setImmediate);
  assert.deepEqual(sockets[0].sent, []);
  assert.equal(client.state, "idle");
});

test("a program that is stopped before it begins ends at once, also while there is no connection yet", () => {
  const { client, sockets } = newClient();
  client.run(PROGRAM);
  sockets[0].send = () => {
    throw new Error("it is connecting");
  };
  client.stop();
  assert.deepEqual([client.state, sockets[0].isClosed], ["idle", true]);
});

test("a lost connection ends the node", () => {
  const { client, sockets } = newClient();
  client.run(PROGRAM);
  sockets[0].onclose();
  assert.deepEqual(client.end, { code: null, reason: "connection", text: "" });
});

test("the page knows what it may do", async () => {
  const { client } = newClient("secret");
  await client.learn();
  assert.deepEqual([client.right, client.mayRun], ["Bearer secret", true]);
  client.load = /** @type {any} */ (async () => ({ json: async () => JSON.parse("<!doctype html>") }));
  await client.learn(); // a server of files alone
  assert.deepEqual([client.right, client.mayRun], ["none", false]);
});

test("a file in Python is a document as it is, with a name that ends with .py", () => {
  const workspace = new Workspace({ fileStore: new FileStore(newStorage()), now: () => 0, changed: () => {} });
  const choice = new LanguageChoice({
    workspace,
    languages: [
      { id: "ros", holds: (_text, name = "") => name.endsWith(".py") },
      { id: "text", holds: () => true },
    ],
  });
  assert.equal(workspace.open("a.py", "\uFEFFif a < b & c:\r\n    pass"), null);
  assert.deepEqual([workspace.current.name, workspace.code], ["a.py", "if a < b & c:\n    pass"]);
  assert.deepEqual([choice.made, choice.shown, choice.choose("text")], ["ros", "ros", "new"]);
  workspace.edit("b = 1");
  assert.ok(isUnsaved(workspace.current));
  workspace.rename("other");
  assert.equal(workspace.current.name, "other.py");
  workspace.begin("other.py", "c");
  assert.equal(workspace.current.name, "other 2.py"); // the text before is kept under its name
  workspace.begin("new.py");
  assert.deepEqual([workspace.current.text, workspace.code, workspace.file.nodes], ["", "", []]);
});
