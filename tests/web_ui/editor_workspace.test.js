import assert from "node:assert/strict";
import { test } from "node:test";

import { meetOtherTabs, openPages } from "../../web_ui/browser/other_tabs.js";
import { blank, isUnsaved } from "../../web_ui/editor/documents.js";
import { FileStore, MAX_FILES } from "../../web_ui/editor/file_store.js";
import { ALL, Workspace } from "../../web_ui/editor/workspace.js";
import { newStorage } from "./support.js";

function workspace(storage = newStorage()) {
  let shown = 0;
  const session = new Workspace({ fileStore: new FileStore(storage), now: () => 7, changed: () => (shown += 1) });
  return { session, storage, shown: () => shown };
}

/** @param {string} file @returns {any} */
const program = (file) => ({ name: "robot.aesl", file, node: "", source: file });

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

test("a program of a mission is the user's, also if the robot has the same one from an earlier visit", () => {
  const { session } = workspace();
  const text = '<!DOCTYPE aesl-source>\n<network>\n<node nodeId="1" name="thymio-II"></node>\n</network>\n';
  session.setRobotProgram(ALL, { ...program(text), name: "Off you go.aesl", source: "" });
  session.show("Off you go", text);
  assert.deepEqual([session.current.name, session.current.own], ["Off you go.aesl", true]);
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

test("a program from elsewhere takes no name and no place of what the user has", () => {
  const { session } = workspace();
  session.open("mine.aesl", "a = 1");
  session.edit("a = 2");
  assert.equal(session.openBeside("mine.aesl", "b = 1", false), null);
  assert.deepEqual([session.current.name, session.code], ["mine 2.aesl", "b = 1"]);
  const kept = session.fileStore.recent().map(({ name, text }) => [name, text.includes("a = 2")]);
  assert.deepEqual(kept, [["mine.aesl", true], ["mine.aesl", false]]);
});

test("a program that only the robot has is kept when another one is opened beside it, a built-in one is not", () => {
  for (const isBuiltIn of [false, true]) {
    const { session } = workspace();
    session.setRobotProgram(ALL, program("a = 1"));
    session.openBeside("gift.aesl", "b = 1", isBuiltIn);
    const kept = session.fileStore.recent().map(({ name, unsaved }) => [name, unsaved]);
    assert.deepEqual(kept, isBuiltIn ? [] : [["robot.aesl", true]]);
  }
});

test("a program from elsewhere that is no program changes nothing", () => {
  const { session } = workspace();
  session.edit("a = 1");
  const refusal = session.openBeside("gift.aesl", '<!DOCTYPE aesl-source>\n<network><node name="a">', false);
  assert.equal(refusal?.name, "gift.aesl");
  assert.equal(session.code, "a = 1");
  assert.deepEqual(session.fileStore.recent(), []);
});

test("the robot's report after loading changes nothing", () => {
  const { session, shown } = workspace();
  session.edit("a = 1");
  session.loaded(ALL, session.current.text);
  const before = shown();
  session.setRobotProgram(ALL, program(session.current.text));
  assert.equal(shown(), before);
});

test("a file that is not XML leaves the text and names the place", () => {
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
