// Names in a program: definitions, uses, renaming; the call that is being written.

import assert from "node:assert/strict";
import { test } from "node:test";

import { isTaken } from "../../web_ui/editor/help.js";
import { definitionOf, nameAt, names, samePlaces, whyNotRename } from "../../web_ui/editor/names.js";
import { parser } from "../../web_ui/editor/parser.js";
import { callAt } from "../../web_ui/editor/signature.js";

const TEXT = `var speed = 3
const fast = 7
var list[fast]
onevent speed
  speed = speed + fast
  for speed in 1 : fast do
    callsub speed
    list[speed] = -fast
  end
  emit speed [speed]
  call math.copy(list, speed)
sub speed
  when speed > 0 do motor.left.target = speed end
`;

const places = names(parser.parse(TEXT), (from, to) => TEXT.slice(from, to));

/** @param {string} line @param {string} name  the first of the line */
function at(line, name) {
  const place = nameAt(places, TEXT.indexOf(line) + line.indexOf(name));
  assert.ok(place, line);
  return place;
}

/** What the text becomes if all places of a name are replaced. @param {import("../../web_ui/editor/names.js").Place} place */
function renamed(place) {
  return samePlaces(places, place).reduceRight((text, { from, to }) => `${text.slice(0, from)}NEW${text.slice(to)}`, TEXT);
}

test("variables, subroutines and events of one name are renamed apart", () => {
  assert.equal(
    renamed(at("var speed", "speed")),
    TEXT.replace("var speed", "var NEW")
      .replace("speed = speed +", "NEW = NEW +")
      .replace("for speed", "for NEW")
      .replace("list[speed]", "list[NEW]")
      .replace("[speed]", "[NEW]")
      .replace("list, speed", "list, NEW")
      .replace("when speed > 0 do motor.left.target = speed", "when NEW > 0 do motor.left.target = NEW"),
  );
  assert.equal(renamed(at("sub speed", "speed")), TEXT.replace("callsub speed", "callsub NEW").replace("sub speed\n  when", "sub NEW\n  when"));
});

test("a constant is found as size, limit and negative limit", () => {
  assert.equal(renamed(at("const fast", "fast")), TEXT.replaceAll("fast", "NEW"));
});

test("a use leads to its definition, whatever stands between", () => {
  assert.equal(definitionOf(places, at("list[speed]", "speed"))?.from, TEXT.indexOf("speed"));
  assert.equal(definitionOf(places, at("callsub speed", "speed"))?.from, TEXT.indexOf("sub speed\n  when") + 4);
  assert.equal(definitionOf(places, at("emit speed", "speed"))?.from, TEXT.indexOf("onevent speed") + 8);
  assert.equal(definitionOf(places, at("call math.copy", "math.copy")), null);
  assert.equal(definitionOf(places, at("motor.left", "motor.left")), null);
});

test("a name is also found just behind it, and nothing between two names", () => {
  assert.equal(nameAt(places, 9)?.name, "speed");
  assert.equal(nameAt(places, 10), null);
});

test("a program that is not finished has names, too", () => {
  const text = "var a\nif a > ";
  const found = names(parser.parse(text), (from, to) => text.slice(from, to));
  assert.deepEqual(found.map(({ name, isDefinition }) => [name, isDefinition]), [["a", true], ["a", false]]);
});

test("a new name must be one, and free", () => {
  const place = at("var speed", "speed");
  const free = () => false;
  assert.equal(whyNotRename(places, place, "tempo.2", free), null);
  for (const bad of ["", "2fast", "a b", "a-b", "a="]) assert.equal(whyNotRename(places, place, bad, free)?.key, "rename.invalid");
  assert.equal(whyNotRename(places, place, "fast", free)?.key, "rename.taken");
  assert.equal(whyNotRename(places, place, "motor.left.target", () => true)?.key, "rename.taken");
});

test("names of the robot, the file and the language are taken, each for its kind", () => {
  const named = { help: "", hidden: false };
  const vocabulary = {
    target: {
      variables: [{ ...named, name: "acc", size: 3, address: 0 }],
      events: [{ name: "prox", help: "" }],
      natives: [],
      keywords: ["if"],
      limits: {},
    },
    events: [{ name: "ping", value: 1 }],
    constants: [{ name: "limit", value: 3 }],
    variables: [{ name: "mine", size: 1 }],
  };
  for (const name of ["acc", "limit", "if"]) assert.ok(isTaken(name, "value", vocabulary), name);
  for (const name of ["mine", "ping", "prox"]) assert.ok(!isTaken(name, "value", vocabulary), name);
  for (const name of ["ping", "prox"]) assert.ok(isTaken(name, "event", vocabulary), name);
  assert.ok(!isTaken("acc", "subroutine", vocabulary));
});

for (const [before, name, argument] of /** @type {[string, string, number][]} */ ([
  ["call math.copy(", "math.copy", 0],
  ["  call  leds.top ( 1, 2", "leds.top", 1],
  ["call f([1, 2], (3 + 4) * 2, ", "f", 2],
  ["call a(1) call b(x[2], ", "b", 1],
])) {
  test(`"${before}" is in argument ${argument} of ${name}`, () => {
    const call = callAt(before);
    assert.deepEqual([call?.name, call?.argument], [name, argument]);
  });
}

for (const before of ["", "call f", "call f(1)", "x = (1, ", "# call f(", "call f( # 1,", "callsub f("]) {
  test(`"${before}" is in no call`, () => assert.equal(callAt(before), null));
}
