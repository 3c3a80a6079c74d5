import assert from "node:assert/strict";
import { test } from "node:test";

import { newAesl } from "../../web_ui/editor/aesl.js";
import { marks } from "../../web_ui/editor/marks.js";
import { LOAD_SERVICE, readLoaded, readVerdict } from "../../web_ui/input/check_service.js";
import { EditorSession, eventKey } from "../../web_ui/editor/editor_session.js";
import { explain, signature, suggestions } from "../../web_ui/editor/help.js";
import { History } from "../../web_ui/editor/history.js";
import { RuntimeClient } from "../../web_ui/input/runtime_client.js";
import { csv, parseNumbers } from "../../web_ui/editor/numbers.js";
import { roundStep } from "../../web_ui/editor/plot.js";
import { INITIAL, MAX_LOGGED_EVENTS, reduce, splitEditorTopic } from "../../web_ui/editor/state.js";
import { firstLines } from "../../web_ui/program_tab/miniature.js";
import { newStorage } from "./support.js";

/** @param {string} topic @param {any} value @returns {any} */
const message = (topic, value, timeNs = 5n) => ({ type: "message", topic, value, timeNs });

/** @param {[string, number[]][]} named */
const labeled = (named) => ({
  layout: { dim: named.map(([label, values]) => ({ label, size: values.length, stride: values.length })) },
  data: named.flatMap(([, values]) => values),
});

test("the editor's topics are those of robots with and without a name", () => {
  assert.deepEqual(splitEditorTopic("/_aseba/target"), { robot: "", name: "target" });
  assert.deepEqual(splitEditorTopic("/anna/_aseba/events"), { robot: "anna", name: "events" });
  assert.equal(splitEditorTopic("/aseba/events/ping"), null);
});

test("variables are split by their labels", () => {
  const state = reduce(
    INITIAL,
    message(
      "/_aseba/variables",
      labeled([
        ["a", [1]],
        ["b", [2, -3]],
      ]),
    ),
  );
  assert.deepEqual(
    [...state.variables[""].values],
    [
      ["a", [1]],
      ["b", [2, -3]],
    ],
  );
});

test("the log keeps the newest events, each with its robot, and can be emptied", () => {
  let state = INITIAL;
  for (let index = 0; index < MAX_LOGGED_EVENTS + 3; index++) {
    state = reduce(state, message("/anna/_aseba/events", labeled([["ping", [index]]])));
  }
  assert.equal(state.log.length, MAX_LOGGED_EVENTS);
  const last = state.log.at(-1);
  assert.deepEqual([last?.robot, last?.name, last?.values], ["anna", "ping", [MAX_LOGGED_EVENTS + 2]]);
  assert.deepEqual(reduce(state, { type: "forgetLog" }).log, []);
});

test("watched variables of the selected robot are plotted", () => {
  const session = new EditorSession(newStorage(), () => 0);
  session.toggleWatch("b");
  session.toggleWatch(eventKey("ping"));
  session.receive(
    message(
      "/anna/_aseba/variables",
      labeled([
        ["a", [1]],
        ["b", [2, 3]],
      ]),
    ),
    "anna",
  );
  session.receive(message("/anna/_aseba/events", labeled([["ping", [9]]])), "anna");
  session.receive(message("/paul/_aseba/events", labeled([["ping", [8]]])), "anna");
  assert.deepEqual([...session.history.series.keys()], ["b[0]", "b[1]", "ping(0)"]);
  assert.deepEqual(session.history.series.get("ping(0)")?.values, [9]);
  session.toggleWatch("b");
  assert.deepEqual([...session.history.series.keys()], ["ping(0)"]);
});

test("series become a table with one row per time", () => {
  const history = new History();
  history.add("a", 1, 10);
  history.add("a", 2, 11);
  history.add("b,c", 2, 20);
  assert.equal(csv(history.rows()), 'seconds,a,"b,c"\r\n1,10,\r\n2,11,20\r\n');
  history.add("a", 0, 5);
  assert.deepEqual(history.series.get("a")?.values, [5]);
});

test("numbers must be whole, in range, and of the required count", () => {
  assert.deepEqual(parseNumbers(" 1, -32768 3 ", 3).values, [1, -32768, 3]);
  assert.equal(parseNumbers("1 2", 3).problem?.key, "number.count");
  for (const bad of ["32768", "1.5", "a", "--1"]) assert.equal(parseNumbers(bad, 1).problem?.key, "number.range", bad);
});

test("grid lines are at round numbers", () =>
  assert.deepEqual([roundStep(100, 4), roundStep(7, 4), roundStep(60, 5)], [50, 2, 20]));

test("a diagnostic is at its characters, whatever their width", () => {
  const text = "a = 1\n# 😀😀 b\n😀 c";
  const remark = { line: 3, column: 3, length: 1, message: "no" };
  assert.deepEqual(marks(text, { errors: [remark], warnings: [] }), [
    { from: text.length - 1, to: text.length, severity: "error", message: "no" },
  ]);
  const [placeless] = marks(text, { errors: [{ line: null, column: null, message: "big" }], warnings: [] });
  assert.equal(placeless.from, 0);
});

test("diagnostics outside the text are moved into it", () => {
  for (const [line, column] of [
    [99, 1],
    [1, 99],
    [0, 0],
  ]) {
    const [{ from, to }] = marks("ab", { errors: [], warnings: [{ line, column, length: 50, message: "" }] });
    assert.ok(from >= 0 && from <= 2 && to >= from && to <= 2, `${line}:${column}`);
  }
});

test("a verdict is parsed from the reason of the answer", () => {
  const use = { variables: [1, 2], bytecode: [3, 4], stack: [5, 6] };
  const reason = JSON.stringify({ errors: [], warnings: [], nodes: [{ use, variables: [{ name: "a" }] }] });
  assert.deepEqual(readVerdict({ result: { successful: true, reason } }).use, use);
});

const VOCABULARY = /** @type {import("../../web_ui/editor/help.js").Vocabulary} */ ({
  target: {
    variables: [
      { name: "prox.horizontal", size: 7, address: 0, hidden: false, help: "distance" },
      { name: "_id", size: 1, address: 1, hidden: true, help: "" },
    ],
    events: [{ name: "prox", help: "ten times a second" }],
    natives: [
      {
        name: "math.max",
        parameters: [
          { name: "dest", size: -1 },
          { name: "a", size: 1 },
          { name: "b", size: 2 },
        ],
        hidden: false,
        help: "m",
      },
    ],
    keywords: ["if", "while"],
    limits: {},
  },
  events: [{ name: "ping", value: 2 }],
  constants: [{ name: "SPEED", value: 200 }],
  variables: [{ name: "count", size: 3 }],
  definitions: [
    { name: "count", from: 0, kind: "variable" },
    { name: "turn", from: 9, kind: "subroutine" },
  ],
});

for (const [before, names] of /** @type {[string, string[]][]} */ ([
  ["onevent p", ["ping", "prox"]],
  ["emit ", ["ping"]],
  ["call ", ["math.max"]],
  ["callsub ", ["turn"]],
  ["var ", []],
  ["# pro", []],
  ["a = 12", []],
  ["a = pro", ["count", "SPEED", "prox.horizontal", "if", "while"]],
])) {
  test(`'${before}' is completed`, () => {
    assert.deepEqual(
      suggestions(before, VOCABULARY).items.map(({ name }) => name),
      names,
    );
  });
}

test("a name is explained where it stands", () => {
  assert.equal(explain("a = prox.horizontal[1]", 8, VOCABULARY)?.item.help, "distance");
  assert.equal(explain("onevent prox", 9, VOCABULARY)?.item.kind, "event");
  assert.equal(explain("b = SPEED", 5, VOCABULARY)?.item.detail, "= 200");
  assert.equal(explain("b = count", 5, VOCABULARY)?.item.detail, "[3]");
  assert.equal(explain("nothing", 2, VOCABULARY), null);
});

test("a signature shows the sizes of the parameters", () => {
  assert.equal(signature(/** @type {any} */ (VOCABULARY.target?.natives[0])), "math.max(dest[], a, b[2])");
});

test("a miniature has the first lines that say something, of any file", () => {
  assert.deepEqual(firstLines(newAesl("\n\tvar a\n\nonevent prox\n")), ["  var a", "onevent prox"]);
  assert.equal(firstLines(newAesl("a = 1\n".repeat(50))).length, 12);
  assert.deepEqual(firstLines("<network"), []);
});

test("a setting that cannot be stored still takes effect", () => {
  const storage = newStorage();
  storage.setItem("editor.fontSize", "20");
  storage.setItem = () => {
    throw new Error("full");
  };
  const session = new EditorSession(storage, () => 0);
  session.resize(1);
  session.toggleWatch("a");
  assert.deepEqual([session.fontSize, [...session.watched]], [24, ["a"]]);
  assert.equal(storage.getItem("editor.fontSize"), null);
});

test("a program is loaded by one request, for one robot or for all, in the language of the page", async () => {
  /** @type {any[]} */ const asked = [];
  const value = { result: { successful: true, reason: "" } };
  const client = { call: async (/** @type {any[]} */ ...given) => (asked.push(given), { ok: true, message: "", value }) };
  const runtime = new RuntimeClient(/** @type {any} */ (client));
  const loaded = { ok: true, message: "", fault: null, notes: [] };
  assert.deepEqual(await runtime.load(null, "a.aesl", "x", "de"), loaded);
  await runtime.load("anna", "b.aesl", "y", "fr");
  await runtime.loadBuiltIn("anna", "explorer", "it");
  assert.deepEqual(
    asked.map(([service, { parameters }]) => [
      service,
      ...parameters.map((/** @type {any} */ { name, value }) => `${name}=${value.string_value}`),
    ]),
    [
      [LOAD_SERVICE, "source=x", "name=a.aesl", "language=de"],
      [LOAD_SERVICE, "source=y", "name=b.aesl", "language=fr", "robot=anna"],
      [LOAD_SERVICE, "behaviour=explorer", "language=it", "robot=anna"],
    ],
  );
});

test("a rejected variable is reported with its reason", async () => {
  const value = { results: [{ successful: false, reason: "too large" }] };
  const runtime = new RuntimeClient(/** @type {any} */ ({ call: async () => ({ ok: true, message: "", value }) }));
  assert.deepEqual(await runtime.setVariable("", "a", [1]), { ok: false, message: "too large" });
});

const REFUSED = {
  line: 2,
  column: 4,
  message: "expected 'do'",
  hint: { kind: "hint-block-word", message: "'do' belongs here", edit: { line: 1, column: 4, end_line: 1, end_column: 4, text: " do" } },
};

test("a hint is converted to a sentence and a change of the text", () => {
  const [mark] = marks("😀ab\n123456", { errors: [REFUSED], warnings: [] });
  assert.equal(mark.hint, "'do' belongs here");
  assert.deepEqual(mark.repair, { from: 4, to: 4, insert: " do" });
  const reason = JSON.stringify({ errors: [REFUSED], notes: [{ message: "guessed" }] });
  const { message, notes } = readLoaded({ result: { successful: false, reason } });
  assert.equal(message, "expected 'do' ('do' belongs here)");
  assert.deepEqual(notes, ["guessed"]);
});
