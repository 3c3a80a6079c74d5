import assert from "node:assert/strict";
import { test } from "node:test";

import { storageOrMap } from "../../web_ui/browser/local_storage.js";
import { Session } from "../../web_ui/protocol/session.js";
import { INITIAL, reduce } from "../../web_ui/state/index.js";
import { resolveToken, tokenIn, tokenProtocols, withoutToken } from "../../web_ui/browser/access_token.js";

const ADDRESS = "http://10.1.2.3:8080/";

/** A tab's localStore that keeps everything for itself. */
function storage() {
  return storageOrMap(() => {
    throw new Error("forbidden");
  });
}

for (const [rest, token, clean] of /** @type {[string, string | null, string][]} */ ([
  ["", null, ""],
  ["#token=abcd", "abcd", ""],
  ["?token=abcd", "abcd", ""],
  ["?x=1&token=abcd#y=2", "abcd", "?x=1#y=2"],
  ["?token=query#token=hash", "hash", ""],
  ["#y=2&token=abcd", "abcd", "#y=2"],
  ["#token=", "", ""],
])) {
  test(`the token of …/${rest} is ${token}`, () => {
    assert.equal(tokenIn(ADDRESS + rest), token);
    assert.equal(withoutToken(ADDRESS + rest), ADDRESS + clean);
  });
}

test("a sub-protocol has the token in letters that sub-protocols may have", () => {
  assert.deepEqual(tokenProtocols(""), []);
  assert.deepEqual(tokenProtocols("aB3.c_d-"), ["token.aB3.c_d-"]);
  assert.match(tokenProtocols("~ (a,b)=\ud800;é")[0], /^token\.[A-Za-z0-9.+%_-]+$/);
});

test("the token is removed from the address and is available after a reload", () => {
  const tab = storage();
  /** @type {string[]} */ const shown = [];
  assert.equal(resolveToken(tab, `${ADDRESS}#token=abcd`, (address) => shown.push(address)), "abcd");
  assert.deepEqual(shown, [ADDRESS]);
  assert.equal(resolveToken(tab, ADDRESS, () => assert.fail("nothing to take away")), "abcd");
  assert.equal(resolveToken(storage(), ADDRESS, () => assert.fail("nothing to take away")), "");
});

test("a token that cannot be stored stays in the address", () => {
  const full = {
    ...storage(),
    setItem() {
      throw new Error("no room");
    },
  };
  assert.equal(resolveToken(full, `${ADDRESS}#token=abcd`, () => assert.fail("it would be lost")), "abcd");
});

test("a rejected connection reports whether a token was given", () => {
  const lost = reduce(INITIAL, { type: "disconnected" });
  assert.equal(reduce(lost, { type: "refused", withToken: false }).connection, "noToken");
  assert.equal(reduce(lost, { type: "refused", withToken: true }).connection, "wrongToken");
});

test("the server's message about the token is replaced by the page's text", () => {
  const status = { level: 2, message: "a token is needed", id: "access" };
  assert.deepEqual(reduce(INITIAL, { type: "status", status }).notices, []);
});

test("a read-only session publishes nothing, and the state says so", () => {
  /** @type {any[]} */ const sent = [];
  /** @type {any[]} */ const events = [];
  const session = new Session({ send: (data) => sent.push(data), emit: (event) => events.push(event), wants: () => true });
  session.receive(JSON.stringify({ op: "serverInfo", name: "bridge", metadata: { access: "read_only" } }));
  session.publish("/press/center", "std_msgs/msg/Bool", { data: true });
  assert.deepEqual(sent, []);
  assert.equal(reduce(INITIAL, events[0]).readOnly, true);
  session.receive(JSON.stringify({ op: "serverInfo", name: "bridge" }));
  session.publish("/press/center", "std_msgs/msg/Bool", { data: true });
  assert.equal(sent.length, 2);
  assert.equal(reduce(INITIAL, events[1]).readOnly, false);
});
