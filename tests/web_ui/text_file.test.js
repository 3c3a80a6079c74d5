import assert from "node:assert/strict";
import { test } from "node:test";

import { decoded, decodedOrMarked } from "../../web_ui/browser/text_file.js";

/** @param {string} encoding */
const file = (encoding) => `<?xml version="1.0" encoding="${encoding}"?>\n<network># größer</network>`;
const utf8 = new TextEncoder();

/** @param {string} text @param {boolean} [isLittle] */
function utf16(text, isLittle = true) {
  const view = new DataView(new ArrayBuffer(2 * text.length + 2));
  [0xfeff, ...[...text].map((letter) => letter.charCodeAt(0))].forEach((word, at) => view.setUint16(2 * at, word, isLittle));
  return new Uint8Array(view.buffer);
}

/** @param {string} text */
const latin = (text) => Uint8Array.from(text, (letter) => letter.charCodeAt(0));

test("a file is decoded as declared, and its declaration is rewritten", () => {
  assert.equal(decoded(latin(file("iso-8859-1"))), file("UTF-8"));
  assert.equal(decoded(utf16(file("UTF-16"))), file("UTF-8"));
  assert.equal(decoded(utf16(file("UTF-16"), false)), file("UTF-8"));
  assert.equal(decoded(utf16("# größer")), "# größer");
});

test("text in UTF-8 stays as it is", () => {
  for (const text of [file("utf-8"), file("UTF8"), "# größer 🤖\r\n", ""]) assert.equal(decoded(utf8.encode(text)), text);
  assert.equal(decoded(Uint8Array.of(0xef, 0xbb, 0xbf, 0x61)), "a");
});

test("invalid bytes are rejected", () => {
  for (const bytes of [latin("# größer"), latin(file("utf-8")), utf16("ab").subarray(0, 5)]) {
    assert.throws(() => decoded(bytes), TypeError);
  }
  assert.throws(() => decoded(utf8.encode(file("klingon"))), RangeError);
});

test("UTF-16 is detected by the first tag, and a wrong declaration of it means UTF-8", () => {
  const text = '<?xml version="1.0" encoding="UTF-16"?><network/>';
  const right = text.replace("UTF-16", "UTF-8");
  const low = Uint8Array.from([...text].flatMap((letter) => [letter.charCodeAt(0), 0]));
  const high = Uint8Array.from([...text].flatMap((letter) => [0, letter.charCodeAt(0)]));
  for (const bytes of [low, high, new TextEncoder().encode(text)]) assert.equal(decoded(bytes), right);
});

test("a command reads a file in its declared encoding, and marks what it cannot decode", () => {
  const bytes = (/** @type {string} */ text) => Uint8Array.from(text, (character) => character.charCodeAt(0));
  assert.equal(decodedOrMarked(bytes('<?xml version="1.0" encoding="iso-8859-1"?><a>é</a>')).slice(-6), ">é</a>");
  assert.equal(decodedOrMarked(bytes("<a>é</a>")), "<a>\uFFFD</a>");
});
