// Where the page looks for the bridge.

import assert from "node:assert/strict";
import { test } from "node:test";

import { addressBeside } from "../../web_ui/protocol/bridge_address.js";

for (const [page, port, expected] of [
  ["http://localhost:8080/", undefined, "ws://localhost:8080/"],
  ["http://localhost:8080/index.html?embed=stage#token=secret", undefined, "ws://localhost:8080/"],
  ["https://school.example/p/ada/", undefined, "wss://school.example/p/ada/"],
  ["https://hub.example/user/ada/proxy/8080/?x=1", undefined, "wss://hub.example/user/ada/proxy/8080/"],
  ["http://[::1]:8080/", undefined, "ws://[::1]:8080/"],
  ["http://localhost:8080/some/path/", 8765, "ws://localhost:8765/"],
]) {
  test(`the bridge of ${page} ${port === undefined ? "" : `with port ${port} `}is ${expected}`, () => {
    assert.equal(addressBeside(String(page), /** @type {number | undefined} */ (port)), expected);
  });
}
