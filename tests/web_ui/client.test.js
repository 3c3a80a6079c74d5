import assert from "node:assert/strict";
import { test } from "node:test";

import { Client } from "../../web_ui/protocol/client.js";
import { INITIAL, reduce } from "../../web_ui/state/index.js";

/**
 * The connection states of a page whose WebSockets never open, after each attempt.
 *
 * @param {import("node:test").TestContext} t
 * @param {boolean[]} served  whether the server of the page answers, by attempt
 */
async function statesOf(t, served) {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  /** @type {EventTarget[]} */ const sockets = [];
  class NeverOpen extends EventTarget {
    constructor() {
      super();
      sockets.push(this);
    }
  }
  const real = globalThis.WebSocket;
  globalThis.WebSocket = /** @type {any} */ (NeverOpen);
  t.after(() => void (globalThis.WebSocket = real));
  let state = INITIAL;
  const states = [];
  const client = new Client({
    address: "ws://localhost/",
    emit: (event) => void (state = reduce(state, event)),
    wants: () => true,
    urgency: () => 0,
    parameters: [],
    isServed: async () => served[sockets.length - 1],
  });
  client.start();
  for (const _ of served) {
    sockets.at(-1)?.dispatchEvent(Object.assign(new Event("close"), { code: 1006 }));
    await new Promise(setImmediate);
    t.mock.timers.tick(1000);
    states.push(state.connection);
  }
  return states;
}

test("a server that wants another token says so also through a proxy that drops the close code", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  /** @type {EventTarget[]} */ const sockets = [];
  class Refused extends EventTarget {
    send() {}
    constructor() {
      super();
      sockets.push(this);
    }
  }
  const real = globalThis.WebSocket;
  globalThis.WebSocket = /** @type {any} */ (Refused);
  t.after(() => void (globalThis.WebSocket = real));
  let state = INITIAL;
  const client = new Client({
    address: "ws://localhost/",
    token: "of an earlier start",
    emit: (event) => void (state = reduce(state, event)),
    wants: () => true,
    urgency: () => 0,
    parameters: [],
    isServed: async () => true,
  });
  client.start();
  const data = JSON.stringify({ op: "status", level: 2, message: "the token is wrong", id: "access" });
  sockets[0].dispatchEvent(new Event("open"));
  sockets[0].dispatchEvent(Object.assign(new Event("message"), { data }));
  sockets[0].dispatchEvent(Object.assign(new Event("close"), { code: 1005 }));
  await new Promise(setImmediate);
  t.mock.timers.tick(1000);
  assert.equal(state.connection, "wrongToken");
  assert.equal(sockets.length, 1);
});

test("a server that answers by HTTP only is behind something that blocks WebSockets", async (t) => {
  assert.deepEqual(await statesOf(t, [true, true, true, true]), ["lost", "lost", "blocked", "blocked"]);
});

test("a server that is away, or that is starting, is not blocked", async (t) => {
  assert.deepEqual(await statesOf(t, [false, true, true, false, true]), ["lost", "lost", "lost", "lost", "lost"]);
});

test("the page says so until it is connected, or the server is away", () => {
  const blocked = reduce(INITIAL, { type: "disconnected", isBlocked: true });
  assert.equal(reduce(blocked, { type: "connecting", address: "" }).connection, "blocked");
  assert.equal(reduce(blocked, { type: "connected" }).connection, "connected");
  assert.equal(reduce(blocked, { type: "disconnected", isBlocked: false }).connection, "lost");
});
