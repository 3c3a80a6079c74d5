import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { deflateSync } from "node:zlib";

import { LARGEST, LinkError, LONGEST_QR, packed, sharedPart, unpacked } from "../../web_ui/sharing/link.js";

/** @typedef {import("../../web_ui/sharing/link.js").Item} Item */

const encoder = new TextEncoder();
/** @type {Item} */
const PROGRAM = { kind: "program", name: "Tänzer </b>.aesl", content: encoder.encode("onevent prox\r\n  motor.left.target = 5 # ñ\n") };

/** The key with which a part is refused. @param {string} part */
async function refusal(part) {
  const error = await unpacked(part).then(
    () => null,
    (reason) => reason,
  );
  assert.ok(error instanceof LinkError, `${part.slice(0, 40)}: ${error}`);
  return error.key;
}

/** A part with any bytes below the zlib stream. @param {string | Uint8Array} content */
function partOf(content) {
  const data = deflateSync(content).toString("base64url");
  return `1.${data.length.toString(36)}.${data}`;
}

test("a link holds kind, name and every byte of the content", async () => {
  for (const item of [PROGRAM, { ...PROGRAM, content: Uint8Array.from({ length: 256 }, (_, byte) => byte) }]) {
    const part = await packed(/** @type {Item} */ (item));
    assert.match(part, /^1\.[0-9a-z]+\.[\w-]+$/);
    assert.deepEqual(await unpacked(part), item);
  }
});

test("programs of all languages in the course fit a QR code", async () => {
  const course = new URL("../../docs/course/", import.meta.url);
  const files = readdirSync(course, { recursive: true }).map(String).filter((name) => name.endsWith(".aesl"));
  assert.ok(files.length > 8);
  for (const file of files) {
    const content = new Uint8Array(readFileSync(new URL(file, course)));
    const part = await packed({ kind: "program", name: file, content });
    assert.ok(part.length < 1.1 * LONGEST_QR, `${file}: ${part.length}`);
    assert.deepEqual((await unpacked(part)).content, content);
  }
});

test("a link is found in an address with a token, and in a text around it", () => {
  assert.equal(sharedPart("http://a/p/ada/#token=x&share=1.2.ab"), "1.2.ab");
  assert.equal(sharedPart("Look: http://a/#share=1.2.ab&token=x"), "1.2.ab");
  for (const text of ["", "http://a/?share=1.2.ab", "http://a/#token=share"]) assert.equal(sharedPart(text), null);
});

test("lines that a mail program has broken, and words after the link, are no mistake", async () => {
  const part = await packed(PROGRAM);
  assert.deepEqual(await unpacked(`${part.slice(0, 30)}\r\n ${part.slice(30)}`), PROGRAM);
  assert.deepEqual(await unpacked(`${part}.)`), PROGRAM);
});

test("a link that was cut anywhere is refused as cut", async () => {
  const part = await packed(PROGRAM);
  const data = part.lastIndexOf(".") + 1;
  for (let end = 2; end < part.length; end++) {
    const key = await refusal(part.slice(0, end));
    assert.equal(key, "bad.cut", `${end} of ${part.length}, data from ${data}`);
  }
});

test("a changed character never yields another content", async () => {
  const part = await packed(PROGRAM);
  for (let at = part.lastIndexOf(".") + 1; at < part.length - 1; at++) {
    const other = part[at] === "A" ? "B" : "A";
    assert.match(await refusal(part.slice(0, at) + other + part.slice(at + 1)), /^bad\./);
  }
});

test("what no page writes is refused with its reason", async () => {
  const cases = /** @type {[string, string][]} */ ([
    ["", "bad.damaged"],
    ["x.1.a", "bad.damaged"],
    ["1.%.a", "bad.damaged"],
    ["1.4.a%25b", "bad.damaged"],
    ["1.3.abc", "bad.damaged"],
    ["2.3.abc", "bad.version"],
    [partOf(""), "bad.damaged"],
    [partOf("{}\n"), "bad.damaged"],
    [partOf("null\nx"), "bad.damaged"],
    [partOf('{"kind":"program","name":"a"}'), "bad.damaged"],
    [partOf('{"kind":["program"],"name":"a"}\n'), "bad.damaged"],
    [partOf('{"kind":"__proto__","name":"a"}\n'), "bad.kind"],
  ]);
  for (const [part, key] of cases) assert.equal(await refusal(part), key, part);
});

test("a small link that would become a large content is refused", async () => {
  assert.equal(await refusal(partOf(new Uint8Array(40 * LARGEST))), "bad.tooLarge");
});
