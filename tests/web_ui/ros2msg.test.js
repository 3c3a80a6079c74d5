import assert from "node:assert/strict";
import { test } from "node:test";

import { parseSchema, SchemaError } from "../../web_ui/protocol/ros2msg.js";
import { CAPTURED } from "./support.js";

test("every captured schema is parsed", () => {
  for (const { schemaName, schema } of CAPTURED) assert.doesNotThrow(() => parseSchema(schemaName, schema), schemaName);
});

test("constants and comments take no space", () => {
  const { fields } = parseSchema("a/msg/B", "uint8 ULTRASOUND=0\nuint8 kind # of radiation\nstring NAME = 'x # y'\n");
  assert.deepEqual(
    fields.map(({ name }) => name),
    ["kind"],
  );
});

test("arrays distinguish a fixed length from a bound", () => {
  const { fields } = parseSchema(
    "a/B",
    "float64[36] covariance\nint16[<=8] data\nstring<=10 name\nstring<=4[] names\nuint8[] rest\n",
  );
  assert.deepEqual(
    fields.map(({ isArray, size }) => [isArray, size]),
    [
      [true, 36],
      [true, null],
      [false, null],
      [true, null],
      [true, null],
    ],
  );
});

test("a default value does not hide a field", () => {
  const { fields } = parseSchema("a/B", "bool flag true\nint32 count -1\n");
  assert.deepEqual(
    fields.map(({ name }) => name),
    ["flag", "count"],
  );
});

test("a name without package belongs to the package that uses it", () => {
  const text = "Inner inner\n================\nMSG: a/Inner\nLeaf leaf\n===============\nMSG: a/Leaf\nint8 x";
  const { fields, types } = parseSchema("a/msg/Outer", text);
  assert.equal(fields[0].type, "a/Inner");
  assert.equal(types.get("a/Inner")?.[0].type, "a/Leaf");
});

test("an undefined type is named in the error", () => {
  assert.throws(
    () => parseSchema("a/B", "c/D field"),
    (error) => error instanceof SchemaError && /a\/B\.field.*c\/D/.test(error.message),
  );
});

test("an invalid line is shown in the error", () => {
  assert.throws(() => parseSchema("a/B", "what"), /not a field: "what"/);
});
