import assert from "node:assert/strict";
import { test } from "node:test";

import { readHandouts } from "../../web_ui/state/handouts.js";

const GIVEN = { id: "a", kind: "program", name: "bus.aesl", due: "", solution_of: "", opened: false, stars: 0 };

test("what was handed out last comes first, and the same text is the same list", () => {
  const text = JSON.stringify([GIVEN, { ...GIVEN, id: "b", kind: "mission", stars: 2 }]);
  assert.deepEqual(readHandouts(text).map(({ id }) => id), ["b", "a"]);
  assert.equal(readHandouts(text), readHandouts(text));
});

test("what another node sets as hand-outs does no harm", () => {
  const wrong = [null, 3, {}, { ...GIVEN, kind: "toString" }, { ...GIVEN, stars: 9 }, { ...GIVEN, name: ["a"] }];
  for (const value of [undefined, 7, "", "{", "{}", "3", JSON.stringify(wrong)]) assert.deepEqual(readHandouts(value), []);
});
