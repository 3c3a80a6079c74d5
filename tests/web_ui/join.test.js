import assert from "node:assert/strict";
import { test } from "node:test";

import { codeOf, hasCode, placesOf } from "../../web_ui/classroom/join.js";

test("a code is read as pupils type it", () => {
  assert.equal(codeOf(" AB cd2 3 "), "abcd23");
});

test("a class says whether pupils enter with a code, and one that is away says nothing", async (t) => {
  for (const [answer, expected] of /** @type {[() => Response, boolean | null][]} */ ([
    [() => Response.json({ has_code: true }), true],
    [() => Response.json({ has_code: false }), false],
    [() => new Response("", { status: 502 }), null],
    [() => new Response("<!doctype html>"), null],
  ])) {
    t.mock.method(globalThis, "fetch", async () => answer());
    assert.equal(await hasCode(), expected);
  }
});

test("a code without names is wrong, was tried too often, or the class is away", async (t) => {
  for (const [status, text] of /** @type {[number, string][]} */ ([[401, "join.wrong"], [429, "join.wait"], [503, "connection.lost"]])) {
    t.mock.method(globalThis, "fetch", async () => new Response("reason", { status }));
    assert.equal(await placesOf("abcd"), text);
  }
});
