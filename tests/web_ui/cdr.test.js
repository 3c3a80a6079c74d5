import assert from "node:assert/strict";
import { test } from "node:test";

import { CdrError, decode, encode } from "../../web_ui/protocol/cdr.js";
import { parseSchema } from "../../web_ui/protocol/ros2msg.js";
import { bytes, captured, CAPTURED, view } from "./support.js";

for (const { schemaName, schema, hex, value } of CAPTURED) {
  const definition = parseSchema(schemaName, schema);
  const plain = definition.fields.length === 0 ? {} : value;

  test(`${schemaName} is read as rclpy wrote it`, () => {
    assert.deepEqual(decode(definition, view(bytes(hex))), plain);
  });

  test(`${schemaName} is written as rclpy writes it`, () => {
    // rclpy leaves whatever was in memory between aligned values and behind the last; ours are zero there.
    const expected = bytes(hex);
    const written = encode(definition, plain);
    assert.ok(written.every((byte, index) => byte === 0 || byte === expected[index]));
    assert.ok(expected.length - written.length < 8);
    assert.deepEqual(decode(definition, view(written)), plain);
  });
}

test("infinite ranges survive", () => {
  const definition = parseSchema("a/B", "float32 range\nfloat32 other");
  assert.deepEqual(decode(definition, view(encode(definition, { range: Infinity, other: -Infinity }))), {
    range: Infinity,
    other: -Infinity,
  });
});

test("big-endian messages are read too", () => {
  const definition = parseSchema("a/B", "uint16 x\nuint32 y");
  assert.deepEqual(decode(definition, view(bytes("00000000" + "0102" + "0000" + "00000003"))), { x: 0x0102, y: 3 });
});

test("numbers of 64 bits are exact", () => {
  const definition = parseSchema("a/B", "int8 pad\nint64 x\nuint64 y");
  const value = { pad: -1, x: -(2n ** 62n) - 1n, y: 2n ** 64n - 1n };
  assert.deepEqual(decode(definition, view(encode(definition, value))), value);
});

test("missing fields are written as zero or empty", () => {
  const definition = parseSchema("a/B", "string text\nint16[] list\nfloat64 x");
  assert.deepEqual(decode(definition, view(encode(definition, {}))), { text: "", list: [], x: 0 });
});

test("a text longer than the first buffer is written whole", () => {
  const definition = parseSchema("a/B", "string text\nuint32 end");
  const value = { text: "é".repeat(5000), end: 7 };
  assert.deepEqual(decode(definition, view(encode(definition, value))), value);
});

test("a message truncated anywhere is rejected", () => {
  const { schemaName, schema, hex } = captured("nav_msgs/msg/Odometry");
  const definition = parseSchema(schemaName, schema);
  const whole = bytes(hex);
  const needed = encode(definition, decode(definition, view(whole))).length;
  for (let length = 0; length < needed; length++) {
    assert.throws(() => decode(definition, view(whole.slice(0, length))), CdrError, `${length} bytes`);
  }
});

test("a length beyond the message is rejected before allocation", () => {
  const definition = parseSchema("a/B", "float64[] list");
  assert.throws(() => decode(definition, view(bytes("00010000" + "ffffffff"))), CdrError);
});

test("another representation is rejected", () => {
  const definition = parseSchema("a/B", "bool x");
  assert.throws(() => decode(definition, view(bytes("0007000001"))), /representation/);
});
