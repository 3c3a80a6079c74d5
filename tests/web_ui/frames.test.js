import assert from "node:assert/strict";
import { test } from "node:test";

import { FrameError, messageFrame, parseFrame, serviceRequestFrame } from "../../web_ui/protocol/frames.js";
import { bytes, serverFrame } from "./support.js";

test("message data contains subscription, time and payload", () => {
  const frame = parseFrame(
    serverFrame(
      1,
      [
        [4, 7],
        [8, 12_340_000_000n],
      ],
      bytes("00010000ff"),
    ),
  );
  assert.equal(frame.op, "message");
  if (frame.op !== "message") return;
  assert.deepEqual(
    [frame.subscriptionId, frame.timeNs, frame.payload.byteLength, frame.payload.getUint8(4)],
    [7, 12_340_000_000n, 5, 255],
  );
});

test("time is in nanoseconds", () => {
  assert.deepEqual(parseFrame(serverFrame(2, [[8, 5_000_000_001n]])), { op: "time", timeNs: 5_000_000_001n });
});

test("a service response names its encoding", () => {
  const frame = parseFrame(
    serverFrame(
      3,
      [
        [4, 1],
        [4, 2],
        [4, 3],
      ],
      bytes("636472" + "0001"),
    ),
  );
  assert.deepEqual(
    frame.op === "serviceResponse" && [frame.serviceId, frame.callId, frame.encoding, frame.payload.byteLength],
    [1, 2, "cdr", 2],
  );
});

test("frames with unused opcodes are ignored", () => {
  assert.deepEqual(parseFrame(serverFrame(9, [])), { op: "other", code: 9 });
});

for (const [name, data] of /** @type {[string, ArrayBuffer][]} */ ([
  ["empty", new ArrayBuffer(0)],
  ["message without time", serverFrame(1, [[4, 7]])],
  [
    "response whose encoding is longer than the frame",
    serverFrame(3, [
      [4, 1],
      [4, 2],
      [4, 999],
    ]),
  ],
])) {
  test(`a frame that is too short is rejected: ${name}`, () => {
    assert.throws(() => parseFrame(data), FrameError);
  });
}

test("sent frames have the layout of the specification", () => {
  assert.equal(Buffer.from(messageFrame(258, bytes("aabb"))).toString("hex"), "0102010000aabb");
  assert.equal(
    Buffer.from(serviceRequestFrame(1, 2, "cdr", bytes("cc"))).toString("hex"),
    "02" + "01000000" + "02000000" + "03000000" + "636472" + "cc",
  );
});
