import assert from "node:assert/strict";
import { test } from "node:test";

import { meetOtherTabs, openPages } from "../../web_ui/browser/other_tabs.js";
import { newAesl } from "../../web_ui/editor/aesl.js";
import { marks } from "../../web_ui/editor/marks.js";
import { LOAD_SERVICE, readLoaded, readVerdict } from "../../web_ui/input/check_service.js";
import { EditorSession, eventKey } from "../../web_ui/editor/editor_session.js";
import { blank, isUnsaved } from "../../web_ui/editor/documents.js";
import { explain, signature, suggestions } from "../../web_ui/editor/help.js";
import { History } from "../../web_ui/editor/history.js";
import { RuntimeClient } from "../../web_ui/input/runtime_client.js";
import { csv, parseNumbers } from "../../web_ui/editor/numbers.js";
import { roundStep } from "../../web_ui/editor/plot.js";
import { INITIAL, MAX_LOGGED_EVENTS, reduce, splitEditorTopic } from "../../web_ui/editor/state.js";
import { FileStore, MAX_FILES } from "../../web_ui/editor/file_store.js";
import { ALL, Workspace } from "../../web_ui/editor/workspace.js";
import { firstLines } from "../../web_ui/program_tab/miniature.js";
import { newStorage } from "./support.js";

function workspace(storage = newStorage()) {
  let shown = 0;
  const session = new Workspace({ fileStore: new FileStore(storage), now: () => 7, changed: () => (shown += 1) });
  return { session, storage, shown: () => shown };
}

/** @param {string} file @returns {any} */
const program = (file) => ({ name: "robot.aesl", file, node: "", source: file });

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

test("the running program is shown until the user has changed something", () => {
  const { session } = workspace();
  session.setRobotProgram(ALL, program("a = 1"));
  assert.equal(session.code, "a = 1");
  session.edit("a = 2");
  session.setRobotProgram(ALL, program("a = 3"));
  assert.equal(session.code, "a = 2");
  session.follow();
  session.setRobotProgram(ALL, program("a = 4"));
  assert.equal(session.code, "a = 4");
  session.edit("a = 5");
  session.follow(); // the same example again, which discards the changes
  session.setRobotProgram(ALL, program("a = 4"));
  assert.equal(session.code, "a = 4");
});

test("a new program and an opened file stay when a robot reports its program", () => {
  const { session } = workspace();
  session.setRobotProgram(ALL, program("a = 1"));
  session.begin("Mine");
  session.setRobotProgram(ALL, program("a = 1"));
  assert.equal(session.code, "");
  session.open("mine.aesl", "b = 1");
  session.setRobotProgram(ALL, program("a = 1"));
  assert.equal(session.code, "b = 1");
});

test("a program of another program on the network leaves the text, which is not in the robot any more", () => {
  const { session } = workspace();
  session.edit("a = 1");
  const { text } = session.current;
  session.loaded(ALL, text);
  assert.ok(session.isInRobot);
  session.setRobotProgram(ALL, { ...program("    0  0003  code at 3"), foreign: true });
  assert.equal(session.code, "a = 1");
  assert.ok(!session.isInRobot);
  session.setRobotProgram(ALL, program(text)); // the same bytecode again: the runtime recognizes it
  assert.ok(session.isInRobot);
});

test("the robot's report after loading changes nothing", () => {
  const { session, shown } = workspace();
  session.edit("a = 1");
  session.loaded(ALL, session.current.text);
  const before = shown();
  session.setRobotProgram(ALL, program(session.current.text));
  assert.equal(shown(), before);
});

test("X", () => {
  const { session } = workspace();
  session.edit("a = 1");
  assert.deepEqual(session.open("bad.aesl", "<network>\n<node></network>"), {
    name: "bad.aesl",
    line: 2,
    column: 7,
    what: "found </network>, expected </node>",
  });
  assert.equal(session.code, "a = 1");
});

test("unsaved text replaced by another file is added to the recent files", () => {
  const { session } = workspace();
  session.edit("a = 1");
  session.rename("mine");
  session.open("other.txt", "b = 2");
  assert.equal(session.current.name, "other.aesl");
  assert.deepEqual(
    session.fileStore.recent().map(({ name }) => name),
    ["other.aesl", "mine.aesl"],
  );
});

test("unsaved texts of the same name are kept separately, and a saved one does not replace them", () => {
  const { session } = workspace();
  for (const code of ["a = 1", "a = 2"]) {
    session.rename("program");
    session.edit(code);
    session.begin("Mine");
  }
  session.open("program.aesl", "a = 3");
  session.open("program.aesl", "a = 4");
  const codes = session.fileStore.recent().map(({ text }) => /a = \d/.exec(text)?.[0]);
  assert.deepEqual(codes, ["a = 4", "a = 2", "a = 1"]);
});

test("a draft that is overwritten is added to the recent files", () => {
  for (const over of [
    (/** @type {Workspace} */ session) => session.edit("b = 1"),
    (/** @type {Workspace} */ session) => session.define("constant", "B", 1),
    (/** @type {Workspace} */ session) => session.rename("b"),
    (/** @type {Workspace} */ session) => session.saved(),
  ]) {
    const { session, storage } = workspace();
    session.edit("a = 1");
    const next = workspace(storage).session;
    assert.notEqual(next.current && next.draft, null);
    over(next);
    assert.equal(next.draft, null);
    assert.ok(next.fileStore.recent().some(({ text }) => text === session.current.text), String(over));
  }
});

test("an unsaved text restored from the recent files is unsaved again", () => {
  const { session } = workspace();
  session.edit("a = 1");
  session.begin("Mine");
  const [kept] = session.fileStore.recent();
  session.restore(kept);
  assert.equal(session.code, "a = 1");
  assert.ok(isUnsaved(session.current));
});

test("a restored draft exists only once", () => {
  const { session, storage } = workspace();
  session.edit("a = 1");
  const next = workspace(storage).session;
  assert.equal(next.code, "");
  next.restoreDraft();
  next.edit("a = 2");
  assert.deepEqual(next.fileStore.recent(), []);
});

test("a program that begins has a title as its name, with a number where another one has it", () => {
  const { session } = workspace();
  const names = ["My program", "My program", "Avoid: things?"].map((title) => {
    session.begin(title);
    session.edit(`a = ${title.length}`);
    return session.current.name;
  });
  assert.deepEqual(names, ["My program.aesl", "My program 2.aesl", "Avoid_ things_.aesl"]);
  session.begin("my PROGRAM");
  assert.equal(session.current.name, "my PROGRAM 3.aesl");
  session.begin("my PROGRAM"); // the one before was left empty
  assert.equal(session.current.name, "my PROGRAM 3.aesl");
});

test("a discarded draft can be brought back until something else is written", () => {
  const { session, storage } = workspace();
  session.edit("a = 1");
  const next = workspace(storage).session;
  assert.equal(next.code, "");
  next.forgetDraft();
  assert.equal(next.draft, null);
  assert.equal(workspace(storage).session.draft, null);
  next.undoForget();
  next.restoreDraft();
  assert.equal(next.code, "a = 1");
  const last = workspace(storage).session;
  assert.equal(last.code, "");
  last.forgetDraft();
  last.edit("b = 1");
  last.undoForget();
  assert.equal(last.code, "b = 1");
  assert.deepEqual(last.fileStore.recent(), []);
});

test("two tabs of a browser lose nothing: what the other one wrote is among the last programs", () => {
  const { session: one, storage } = workspace();
  const { session: other } = workspace(storage);
  const codesIn = (/** @type {Workspace} */ session) => session.fileStore.recent().map(({ text }) => /a = \d/.exec(text)?.[0]);
  one.edit("a = 1");
  other.edit("a = 2");
  other.edit("a = 3");
  assert.deepEqual(codesIn(other), ["a = 1"]);
  one.edit("a = 4");
  assert.deepEqual(codesIn(one), ["a = 3", "a = 1"]);
  one.edit("a = 5");
  other.saved();
  assert.deepEqual(codesIn(other), ["a = 5", "a = 3"]); // of each tab the last text
});

test("two tabs that are edited by turns do not push older programs out of the last ones", () => {
  const { session: one, storage } = workspace();
  const { session: other } = workspace(storage);
  one.fileStore.addRecent({ name: "older.aesl", text: "older", time: 1, unsaved: true });
  for (let turn = 0; turn < MAX_FILES; turn++) {
    one.edit(`a = ${turn}`);
    other.edit(`b = ${turn}`);
  }
  const kept = [...one.fileStore.recent(), one.fileStore.draft(ALL)].map((file) => file?.text ?? "");
  for (const text of ["older", "a = 9", "b = 9"]) assert.ok(kept.some((each) => each.includes(text)), text);
  assert.equal(kept.length, 4); // and the text of the other tab before the last turn
});

test("two open editors of a browser know of each other", () => {
  /** @type {any[]} */ const channels = [];
  const open = () => {
    const channel = {
      /** @type {any} */ onmessage: null,
      postMessage: (/** @type {any} */ data) => channels.forEach((one) => one !== channel && one.onmessage({ data })),
    };
    channels.push(channel);
    return channel;
  };
  const met = [0, 0];
  meetOtherTabs(() => met[0]++, open);
  assert.deepEqual(met, [0, 0]);
  meetOtherTabs(() => met[1]++, open);
  assert.deepEqual(met, [1, 1]);
});

/** Locks of a browser, as `navigator.locks` of its pages, with an end of each page. */
function newLocks() {
  /** @type {{ page: symbol, name: string }[]} */ const held = [];
  /** @type {{ name: string, grant: () => void }[]} */ let waiting = [];
  const settle = () => {
    const free = waiting.filter(({ name }) => !held.some((one) => one.name === name));
    waiting = waiting.filter((one) => !free.includes(one));
    for (const { grant } of free) grant();
  };
  return () => {
    const page = Symbol("page");
    const request = (/** @type {string} */ name, /** @type {any} */ options) =>
      new Promise((/** @type {(value?: any) => void} */ resolve) => {
        if (options.mode === "shared") waiting.push({ name, grant: resolve });
        else held.push({ page, name });
        settle();
      });
    const close = () => {
      held.splice(0, held.length, ...held.filter((one) => one.page !== page));
      settle();
    };
    return { locks: /** @type {any} */ ({ request }), close };
  };
}

/** The next page of a browser. @param {any} storage @param {ReturnType<typeof newLocks>} openPage */
function pageWithLocks(storage, openPage) {
  const { locks, close } = openPage();
  let offers = 0;
  const session = new Workspace({
    fileStore: new FileStore(storage, openPages(locks)),
    now: () => 7,
    changed: () => {},
    offered: () => (offers += 1),
  });
  assert.equal(session.at(ALL).text, blank().text);
  return { session, close, offers: () => offers };
}

/** Until all promises that are due have been settled. */
const turn = () => new Promise((resolve) => setImmediate(resolve));

test("a draft is offered once the tab that writes it is closed, and no sooner", async () => {
  const storage = newStorage();
  const openPage = newLocks();
  const first = pageWithLocks(storage, openPage);
  first.session.edit("a = 1");
  const [second, third] = [pageWithLocks(storage, openPage), pageWithLocks(storage, openPage)];
  await turn();
  assert.deepEqual([second.session.draft, second.offers()], [null, 0]);
  first.session.edit("a = 2");
  first.close();
  await turn();
  for (const { session, offers } of [second, third]) {
    assert.match(session.draft?.text ?? "", /a = 2/);
    assert.equal(offers(), 1);
  }
  await turn();
});

test("a restored draft is offered in no other tab, be it open or new, until this one is closed", async () => {
  const storage = newStorage();
  const openPage = newLocks();
  const first = pageWithLocks(storage, openPage);
  first.session.edit("a = 1");
  first.close();
  const [second, third] = [pageWithLocks(storage, openPage), pageWithLocks(storage, openPage)];
  await turn();
  second.session.restoreDraft();
  third.session.storageChanged("editor.recent");
  assert.match(third.session.draft?.text ?? "", /a = 1/);
  third.session.storageChanged("editor.draft.*");
  const fourth = pageWithLocks(storage, openPage);
  await turn();
  assert.deepEqual([third.session.draft, fourth.session.draft], [null, null]);
  second.close();
  await turn();
  for (const { session } of [third, fourth]) assert.match(session.draft?.text ?? "", /a = 1/);
});

test("a draft that its tab has saved or removed before it is closed is not offered", async () => {
  const storage = newStorage();
  const openPage = newLocks();
  const first = pageWithLocks(storage, openPage);
  first.session.edit("a = 1");
  const second = pageWithLocks(storage, openPage);
  first.session.saved();
  first.close();
  await turn();
  assert.equal(second.session.draft, null);
});

test("where the browser refuses locks, the drafts of all other tabs are offered", async () => {
  const storage = newStorage();
  const refuse = () => ({ locks: /** @type {any} */ ({ request: () => Promise.reject(new Error("no locks")) }), close() {} });
  pageWithLocks(storage, refuse).session.edit("a = 1");
  const second = pageWithLocks(storage, refuse);
  await turn();
  assert.match(second.session.draft?.text ?? "", /a = 1/);
});

test("a miniature has the first lines that say something, of any file", () => {
  assert.deepEqual(firstLines(newAesl("\n\tvar a\n\nonevent prox\n")), ["  var a", "onevent prox"]);
  assert.equal(firstLines(newAesl("a = 1\n".repeat(50))).length, 12);
  assert.deepEqual(firstLines("<network"), []);
});

test("an unsaved text is offered at the next visit, a saved one is not", () => {
  const { session, storage } = workspace();
  session.edit("a = 1");
  const next = workspace(storage).session;
  assert.equal(next.code, "");
  assert.equal(next.draft?.name, "program.aesl");
  next.restoreDraft();
  assert.equal(next.code, "a = 1");
  next.saved();
  assert.equal(workspace(storage).session.current.text, blank().text);
  const last = workspace(storage).session;
  assert.equal(last.at(ALL) && last.draft, null);
});

test("the number of recent files is limited, and invalid storage content is ignored", () => {
  const storage = newStorage();
  const fileStore = new FileStore(storage);
  for (let index = 0; index < MAX_FILES + 5; index++) fileStore.addRecent({ name: `${index}`, text: "", time: index });
  assert.equal(fileStore.recent().length, MAX_FILES);
  storage.setItem("editor.recent", "{");
  assert.deepEqual(fileStore.recent(), []);
});

test("the newest recent files that fit into the storage are kept", () => {
  const storage = newStorage();
  const { setItem } = storage;
  storage.setItem = (key, value) => {
    if (value.length > 250) throw new Error("full");
    setItem(key, value);
  };
  const fileStore = new FileStore(storage);
  for (const name of ["a", "b", "c"]) fileStore.addRecent({ name, text: name.repeat(60), time: 1 });
  assert.deepEqual(
    fileStore.recent().map(({ name }) => name),
    ["c", "b"],
  );
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
