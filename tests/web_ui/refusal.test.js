import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { Labels } from "../../web_ui/playground/labels.js";
import creatorTexts from "../../web_ui/i18n/creator.texts.js";
import { LANGUAGES, translator } from "../../web_ui/i18n/index.js";
import { BUILT_IN } from "../../web_ui/playground/declarations.js";
import { parse } from "../../web_ui/playground/document.js";
import { Fault } from "../../web_ui/playground/rules.js";
import { isForeign, partsOf, reasonOfFault, reasonOfMessage, refusalOf, sentenceOf } from "../../web_ui/playground_tab/reasons.js";
import { locate } from "../../web_ui/state/index.js";

/** @type {{ name: string, playground: any, key: string | null, word: string | null }[]} */
const CASES = JSON.parse(readFileSync(new URL("../data/web/playground_cases.json", import.meta.url), "utf8"));
const WRONG = CASES.filter(({ key }) => key !== null);

/** What the simulator's readers answer to files of another kind. */
const FOREIGN = [
  "a.json: line 1, column 1: found 'hello', expected JSON (Expecting value)",
  "a.json: line 1, column 14: found the end of the text, expected JSON (Expecting property name enclosed in double quotes)",
  "a.json: found [], expected an object",
  "a.json: format: found None, expected 1",
  "a.json: found an invalid byte at offset 0, expected UTF-8 text",
  "a.json: line 1: found <html>, expected <aseba-playground>",
  "a.json: found a damaged zip archive, expected a complete zip archive",
  "a.json: line 1: found no element found, expected XML",
];

/** What they answer to playgrounds with an error, and the English sentence of the page. */
const ANSWERS = {
  "shapes[0].x_m: found 'far', expected a number of m from -100 to 100": "Thing 1: Position x must be from -10000 to 10000 cm.",
  "shapes[2].mass_kg: found 0, expected a number of kg from 0.001 to 1000": "Thing 3: Mass must be from 1 to 1000000 g.",
  "shapes[2].yaw_rad: found 9, expected a number of rad from -6.28319 to 6.28319": "Thing 3: Rotation must be from -360 to 360°.",
  "shapes[0].friction: found 3, expected a number of parts of the weight from 0 to 2": "Thing 1: Friction must be from 0 to 2.",
  "shapes[0].walls.height_m: found nothing, expected a number of m from 0.001 to 100": "Thing 1: Something is missing: Walls – Height.",
  "shapes[0]: found 3, expected an object": "Thing 1: One of its values cannot be read.",
  "shapes: found 3, expected a list": "Things cannot be read.",
  "title: found nothing, expected one line of text, at most 2000 characters": "Something is missing: Title.",
  "robots[1]: found 'other' inside 'thymio', expected a free position": "Robot 2: Something is in the way here.",
  "line 2: <world> w: found 'wide', expected a number": "Line 2: One of its values must be a number.",
  "line 7: <wall> (shapes[3].size_x_m): found 0, expected a number of m from 0.001 to 100": "Thing 4: Length must be from 0.1 to 10000 cm.",
  "planes[0].hasWalls: found 3, expected true or false": "One of its values can only be on or off.",
  "shapes[1].image: found an image that cannot be read, expected a complete PNG or JPEG file": "Thing 2: The picture cannot be read. Try another one.",
  "shapes[0].kind: found 'trampoline', expected one of box, wall": "Thing 1: This page does not know this thing.",
  "shapes[0].size: found an unknown key, expected 'size_x_m' (one of x_m)": "Thing 1: It has a value that this page does not know.",
  "found more than 24000000 bytes, expected a smaller file": "This file is too large.",
  "shapes: found 1001 items, expected at most 1000": "There are too many: at most 1000 are possible.",
  "shapes[0].points_m: found a single place, expected two different points": "Thing 1: It needs two different points.",
  "shapes[0]: found something else, expected a valid thing": "Thing 1: There is a mistake in it.",
  'found 2 playgrounds in the archive ("a.json", "b.json"), expected the name of one, as FILE#a.json':
    "It holds several playgrounds. Open it again and choose one.",
  "The simulator is gone": "There is a mistake in it.",
};

const CODES = Object.keys(LANGUAGES);
const KEYS = [
  ...new Set([
    ...Object.keys(BUILT_IN.robot),
    ...Object.values(BUILT_IN.shapes).flatMap(({ fields }) => Object.keys(fields)),
    "shapes",
    "robots",
    "found",
    "expected",
  ]),
].filter((key) => key.includes("_") || ["shapes", "robots", "found", "expected"].includes(key));

/** @param {string} language */
const labels = (language) => new Labels(language, translator(language, creatorTexts));

/** A sentence that a pupil reads: no key of a file, no format, nothing of Python or JavaScript. @param {string} text */
function assertPlain(text) {
  assert.ok(text.length > 5, text);
  assert.doesNotMatch(text, /None|null|undefined|NaN|JSON|XML|UTF|PNG|SVG|\{|\}|\[|\]|_|"|'|#/, text);
  for (const key of KEYS) assert.ok(!text.split(/[^\w]+/).includes(key), `${key} in ${text}`);
}

/** @param {string} text @returns {Fault} */
function faultOf(text) {
  try {
    parse(text);
  } catch (error) {
    if (error instanceof Fault) return error;
    throw error;
  }
  throw new Error("it was accepted");
}

for (const { name, playground, key } of WRONG) {
  test(`${name}: the page says it in plain words in every language, and the details have the key`, () => {
    const text = JSON.stringify({ format: 1, ...playground });
    const reason = reasonOfFault(faultOf(text), text);
    const sentences = CODES.map((language) => sentenceOf(labels(language), reason));
    for (const sentence of sentences) assertPlain(sentence);
    assert.equal(new Set(sentences).size, CODES.length, "each language has a sentence of its own");
    assert.ok(reason.technical.startsWith(`${key}: found`), reason.technical);
  });
}

test("the sentence names the item and the field", () => {
  const [case_] = CASES.filter(({ name }) => name === "a number out of range");
  const text = JSON.stringify({ format: 1, ...case_.playground });
  const reason = reasonOfFault(faultOf(text), text);
  assert.equal(sentenceOf(labels("en"), reason), "Box “crate”: Length must be from 0.1 to 10000 cm.");
  assert.equal(sentenceOf(labels("de"), reason), "Kiste „crate“: Länge muss von 0.1 bis 10000 cm sein.");
});

for (const message of FOREIGN) {
  test(`'${message}' is shown in plain words, in every language`, () => {
    const fault = locate(`/simulator.playground: ${message}`, "a.json");
    assert.ok(isForeign(refusalOf(fault.text)) || fault.line !== null);
    for (const language of CODES) {
      assert.equal(sentenceOf(labels(language), reasonOfMessage(fault)), labels(language).t("fault.json"));
    }
  });
}

for (const [message, sentence] of Object.entries(ANSWERS)) {
  test(`'${message}' is translated`, () => {
    const reason = reasonOfMessage(locate(message));
    assert.equal(sentenceOf(labels("en"), reason), sentence);
    assert.equal(reason.technical, message);
    for (const language of CODES) assertPlain(sentenceOf(labels(language), reason));
  });
}

test("rules between fields that only the simulator checks name the thing", () => {
  const shape = { kind: "track", name: "lane", points_m: [[0, 0], [1, 0]], width_m: 0.1, color: "#000000", corner_radius_m: 0.01 }; // prettier-ignore
  const text = JSON.stringify({ format: 1, title: "t", shapes: [shape] });
  const fault = locate("shapes[0].corner_radius_m: found 0.01, expected 0 or at least half of the width (0.05)");
  const [radius, room] = [fault, locate("shapes[0].corner_radius_m: found 2, expected room for the arcs on the piece from (0, 0) to (1, 0)")];
  assert.equal(sentenceOf(labels("en"), reasonOfMessage(radius, text)), "Line “lane”: Roundness of the bends must be 0 or at least half of the width.");
  assert.equal(sentenceOf(labels("en"), reasonOfMessage(room, text)), "Line “lane”: Roundness of the bends: the bends have no room.");
});

test("with the text of the file the page says more than the simulator's message", () => {
  const [case_] = CASES.filter(({ name }) => name === "text for a number");
  const text = JSON.stringify({ format: 1, ...case_.playground });
  const fault = locate("shapes[0].x_m: found '1', expected a number of m from -100 to 100");
  assert.equal(sentenceOf(labels("en"), reasonOfMessage(fault, text)), "Box “crate”: Position x must be from -10000 to 10000 cm.");
});

test("an empty file, a damaged one and one of another program are distinguished", () => {
  /** @param {string} text */
  const said = (text) => reasonOfFault(faultOf(text), text).phrase.word;
  assert.equal(said(" \n"), "fault.empty");
  assert.equal(said("hello"), "fault.json");
  assert.equal(said('{"format": 1, "title": "Cut o'), "fault.broken");
  assert.equal(said('{"playground": "Lone pillar", "planes": []}'), "fault.foreign");
  assert.equal(said('{"format": 2, "title": "Later"}'), "fault.json");
  const cut = locate("line 1, column 22: found the end of the text, expected JSON (Unterminated string)");
  assert.equal(reasonOfMessage(cut, '{"format": 1, "title": "Cut o').phrase.word, "fault.broken");
  assert.equal(reasonOfMessage(cut, "").phrase.word, "fault.empty");
});

test("the playgrounds of an archive with several can be chosen", () => {
  const found = 'found 2 playgrounds in the archive ("maps/a, b.playground", "Zoë \\"2\\".json")';
  const expected = "expected the name of one, as FILE#maps/a, b.playground";
  const names = ["maps/a, b.playground", 'Zoë "2".json'];
  assert.deepEqual(partsOf(`four.zip: ${found}, ${expected}`), names);
  assert.deepEqual(partsOf(`${found}, none of them 'c', ${expected}`), names);
  for (const other of [...FOREIGN, "The simulator is gone"]) assert.deepEqual(partsOf(other), []);
});
