// What the view of VPL shows and does, without a page: pictures, controls, words, drops, edits of a document.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { newAesl } from "../../web_ui/editor/aesl.js";
import { FileStore } from "../../web_ui/editor/file_store.js";
import { Workspace } from "../../web_ui/editor/workspace.js";
import { scan } from "../../web_ui/editor/xml.js";
import { LANGUAGES } from "../../web_ui/hosts/program_host.js";
import { translator } from "../../web_ui/i18n/index.js";
import texts from "../../web_ui/i18n/vpl.texts.js";
import { makeBlock } from "../../web_ui/vpl/blocks.js";
import { check } from "../../web_ui/vpl/check.js";
import { compareText } from "../../web_ui/vpl/compare.js";
import { readVpl, withoutVpl } from "../../web_ui/vpl/file.js";
import { holdsVpl } from "../../web_ui/vpl/holds.js";
import { BLOCKS, MODES } from "../../web_ui/vpl/kinds.js";
import { blocksOf, makeProgram } from "../../web_ui/vpl/program.js";
import { controlsOf, used } from "../../web_ui/vpl/view/controls.js";
import { added, draggedOut, dropped } from "../../web_ui/vpl/view/dropping.js";
import { VplEditing } from "../../web_ui/vpl/view/editing.js";
import { pieces } from "../../web_ui/program_tab/marked_text.js";
import { picture } from "../../web_ui/vpl/view/picture.js";
import { questionNotices } from "../../web_ui/vpl/view/questions.js";
import { sampleText } from "../../web_ui/vpl/view/samples.js";
import { sentence } from "../../web_ui/vpl/view/sentences.js";
import { newStorage } from "./support.js";

/** @typedef {import("../../web_ui/vpl/blocks.js").Block} Block */
/** @typedef {import("../../web_ui/vpl/view/place.js").Spot} Spot */

const NAMES = [...BLOCKS.keys()];
const en = translator("en", texts);
const FILES = new URL("../data/web/vpl/", import.meta.url);
const read = (/** @type {string} */ name) => readFileSync(new URL(name, FILES), "utf8");
const VPL = LANGUAGES.find(({ id }) => id === "vpl");
const SAMPLES = [...(VPL?.samples ?? []), ...(VPL?.more ?? [])].map(({ name }) => name);

/**
 * Blocks that the controls reach from a new one, in at most `depth` steps.
 *
 * @param {string} name
 * @param {number} depth
 */
function reached(name, depth) {
  /** @type {Map<string, Block>} */ const found = new Map();
  let last = [makeBlock(name)];
  for (let step = 0; step <= depth; step += 1) {
    const next = [];
    for (const block of last) {
      const key = JSON.stringify(block.values);
      if (found.has(key)) continue;
      found.set(key, block);
      for (const control of controlsOf(block, "extended")) next.push(...usesOf(block, control));
    }
    last = next;
  }
  return [...found.values()];
}

/** @param {Block} block @param {import("../../web_ui/vpl/view/controls.js").Control} control */
function usesOf(block, control) {
  if (control.kind === "choice") return control.options.map(({ value }) => used(block, control, "extended", value));
  if (control.kind === "slider") {
    const { stops } = control;
    return [stops[0], stops[stops.length >> 1], stops[stops.length - 1]].map((value) => used(block, control, "extended", value));
  }
  if (control.kind === "notes") return [0, 7, 13, 19, 24, 29].map((value) => used(block, control, "extended", value));
  return [used(block, control, "extended")];
}

for (const name of NAMES) {
  test(`${name}: each state that its editor reaches has a picture, words, and labels in every language`, () => {
    for (const block of reached(name, 2)) {
      const svg = picture(block);
      assert.doesNotMatch(svg, /NaN|undefined|Infinity/, JSON.stringify(block));
      assert.ok([...scan(svg)].length > 2, "it is XML");
      for (const language of Object.keys(texts)) {
        const t = translator(language, texts);
        assert.doesNotMatch(sentence(block, t), /undefined|\{|\b(part|value|block)\./, language);
        for (const control of controlsOf(block, "extended")) {
          if (!("words" in control)) continue;
          const { part } = control.words.values ?? {};
          const keys = [control.words.key, ...(part === undefined ? [] : [String(part)])];
          if (control.kind === "choice") keys.push(...control.options.map(({ words }) => words.key));
          if (control.kind === "slider") keys.push(control.shown.key);
          for (const key of keys) assert.ok(key in texts[language], `${language}: ${key}`);
        }
      }
    }
  });
}

test("each value of a block can be set by its editor", () => {
  for (const { name, parameters } of BLOCKS.values()) {
    const blocks = reached(name, 2);
    parameters.forEach((_, index) => {
      assert.ok(new Set(blocks.map(({ values }) => values[index])).size > 1, `${name}: value ${index}`);
    });
  }
});

test("pictures differ where the state differs", () => {
  for (const name of NAMES) {
    // A new timer has 1 ms, which no eye can tell from 0.
    const all = reached(name, 1).filter((block) => name !== "timer" || block.values[0] !== 1);
    assert.equal(new Set(all.map(picture)).size, all.length - (["prox", "proxground"].includes(name) ? thresholdsOnly(all) : 0), name);
  }
});

/**
 * Blocks whose difference is in their thresholds only, which sliders and words show.
 *
 * @param {readonly Block[]} blocks
 */
function thresholdsOnly(blocks) {
  const sensors = blocks.map(({ values }) => JSON.stringify(values.slice(0, -2)));
  return blocks.length - new Set(sensors).size;
}

test("basic mode has the parts of the original only", () => {
  assert.equal(controlsOf(makeBlock("button"), "basic").length, 5);
  assert.equal(controlsOf(makeBlock("prox"), "basic").length, 7);
  assert.equal(controlsOf(makeBlock("prox"), "advanced").length, 9);
  assert.deepEqual(controlsOf(makeBlock("acc"), "basic"), []);
  const control = controlsOf(makeBlock("prox"), "basic")[0];
  const states = [1, 2, 3].map((times) => {
    let block = makeBlock("prox");
    for (let time = 0; time < times; time += 1) block = used(block, control, "basic");
    return block.values[0];
  });
  assert.deepEqual(states, [1, 2, 0]);
});

test("sliders keep a value beside their grid until they are moved", () => {
  const block = makeBlock("timer", [1021]);
  const [slider] = controlsOf(block, "advanced");
  assert.ok(slider.kind === "slider" && slider.stops.includes(1021));
  assert.equal(used(block, slider, "advanced", 1021), block);
  assert.equal(used(block, slider, "advanced", 1250).values[0], 1250);
});

test("a block is said in a sentence", () => {
  assert.equal(sentence(makeBlock("move", [250, -250]), en), "Motors: left 250, right -250");
  assert.equal(sentence(makeBlock("prox", [1, 0, 2]), en), "Near or far: far left: near, middle: far");
  assert.equal(sentence(makeBlock("clap"), en), "Clap");
});

test("words of the text have their looks, and nothing is lost", () => {
  const line = "  when button.left == 1 do # why";
  assert.equal(pieces(line).map(({ text }) => text).join(""), line); // prettier-ignore
  assert.deepEqual(
    pieces(line).filter(({ look }) => look !== ""),
    [
      { text: "when", look: "key" },
      { text: "1", look: "number" },
      { text: "do", look: "key" },
      { text: "# why", look: "comment" },
    ],
  );
  assert.deepEqual(pieces("onevent prox")[2], { text: "prox", look: "event" });
});

// -- samples -----------------------------------------------------------------------------------------------------------

test("samples are programs without errors, whose text is that of their blocks", () => {
  assert.equal(SAMPLES.length, 10);
  for (const name of SAMPLES) {
    const text = sampleText(name);
    assert.ok(holdsVpl(text), name);
    const file = readVpl(text);
    assert.deepEqual([file.warnings, check(file.program)], [[], null], name);
    if (name !== "empty") assert.equal(compareText(file).origin, "current", name);
    assert.ok(!holdsVpl(newAesl(file.code)));
    const left = withoutVpl(text);
    assert.ok(!left.includes("toolsPlugins") && left.includes(`size="1"`) === (name !== "empty"), name);
  }
});

test("samples use every block", () => {
  const blocks = SAMPLES.flatMap((name) => readVpl(sampleText(name)).program.rows.flatMap(blocksOf));
  const missing = NAMES.filter((name) => !blocks.some((block) => block.name === name));
  assert.deepEqual(missing, ["posture", "groundmean", "play", "playstop"], "blocks that VPL of Aseba lacks");
});

test("a picture leaves its file, whatever its format; other data of the node stays", () => {
  for (const name of ["current.aesl", "format0.aesl", "settings.aesl", "avoid.aesl"]) {
    const text = read(name);
    const left = withoutVpl(text);
    assert.ok(holdsVpl(text) && !holdsVpl(left), name);
    assert.equal(left.trim().endsWith("</network>"), true);
  }
  const text = sampleText("avoid").replace("<toolsPlugins>", "<toolsPlugins><other/>");
  assert.ok(withoutVpl(text).includes("<other/>"));
});

// -- drops -------------------------------------------------------------------------------------------------------------

/** @param {number} row @param {Spot["slot"]} slot @param {number} [index] @returns {Spot} */
const spot = (row, slot, index = 0) => ({ row, slot, index });
/** @param {import("../../web_ui/vpl/program.js").Program} program */
const shapes = ({ rows }) =>
  rows.map(({ event, conditions, actions }) =>
    [event?.name ?? "-", ...conditions.map(({ name }) => `&${name}`), ...actions.map(({ name }) => name)].join(" "),
  );

test("clicks in the palettes build a program, and replace nothing", () => {
  let program = makeProgram("basic");
  /** @type {number | null} */ let selected = 0;
  for (const name of ["button", "move", "colortop", "prox", "clap", "move"]) {
    const result = added(program, name, selected, null);
    assert.equal(result.reason, null);
    [program, selected] = [result.program, result.row];
  }
  assert.deepEqual(shapes(program), ["button move colortop", "prox", "clap move", "-"]);
  assert.equal(added(program, "move", 0, null).reason?.key, "edit.twice");
  assert.equal(added(program, "move", null, null).row, 1, "without a selected row: the first one that lacks an action");
});

test("a drop puts, moves, copies and removes", () => {
  let { program } = dropped(makeProgram("basic"), "button", spot(0, "row", 99), false);
  program = dropped(program, "move", spot(0, "actions"), false).program;
  program = dropped(program, "colortop", spot(0, "actions"), false).program;
  assert.deepEqual(shapes(program), ["button colortop move", "-"]);
  assert.deepEqual(shapes(dropped(program, spot(0, "actions", 0), spot(0, "actions", 1), false).program), ["button move colortop", "-"]);
  assert.deepEqual(shapes(dropped(program, spot(0, "actions", 0), spot(1, "event"), false).program), ["button move", "- colortop", "-"]);
  assert.deepEqual(shapes(dropped(program, spot(0, "event"), spot(1, "row", 99), true).program), [
    "button colortop move",
    "button",
    "-",
  ]);
  assert.deepEqual(shapes(draggedOut(program, spot(0, "event"))), ["- colortop move", "-"]);
  assert.equal(dropped(program, "move", spot(0, "row", 99), false).reason?.key, "edit.twice");
  assert.deepEqual(shapes(dropped(program, "prox", spot(0, "actions"), false).program), ["prox colortop move", "-"]);
  const copied = dropped(program, spot(0, "row"), spot(1, "row"), true).program;
  assert.deepEqual(shapes(copied), ["button colortop move", "button colortop move", "-"]);
  assert.equal(draggedOut(program, "move"), program);
});

test("in extended mode an event becomes a condition where the conditions are", () => {
  const program = dropped(makeProgram("extended"), "button", spot(0, "event"), false).program;
  const both = dropped(program, "prox", spot(0, "conditions"), false).program;
  assert.deepEqual(shapes(both), ["button &prox", "-"]);
  assert.deepEqual(shapes(added(program, "counter", 0, null).program), ["button &counter", "-"]);
  assert.deepEqual(shapes(added(program, "prox", 0, "conditions").program), ["button &prox", "-"]);
  assert.equal(dropped(program, "clap", spot(0, "conditions"), false).reason?.key, "edit.slot");
});

// -- a document --------------------------------------------------------------------------------------------------------

/** A document with this text, opened in the view. @param {string} text */
function opened(text) {
  const fileStore = new FileStore(newStorage());
  const workspace = new Workspace({ fileStore, now: () => 0, changed: () => {} });
  assert.equal(workspace.open("a.aesl", text), null);
  const kept = new Map();
  const editing = new VplEditing({ workspace, kept });
  editing.open();
  return { workspace, editing, kept };
}

/** @param {VplEditing} editing @param {string} name */
const add = (editing, name) => editing.edit(added(editing.program, name, 0, null).program);

test("edits become the text of the document; undone, it is byte for byte the old one", () => {
  const before = sampleText("buttons");
  const { workspace, editing } = opened(before);
  editing.edit(dropped(editing.program, "clap", spot(5, "event"), false).program);
  assert.deepEqual([editing.refusal?.key, editing.isBlocked], ["check.add.action", true]);
  assert.equal(workspace.code, readVpl(before).code, "the last text without error stays");
  editing.edit(dropped(editing.program, "move", spot(5, "actions"), false).program);
  assert.equal(editing.isBlocked, false);
  assert.match(workspace.code, /onevent mic/);
  assert.equal(readVpl(workspace.current.text).program.rows.length, 7);
  editing.undo();
  editing.undo();
  assert.equal(workspace.current.text, before);
  assert.deepEqual([editing.canUndo, editing.canRedo], [false, true]);
});

test("a file as it was opened shows which lines belong to a row", () => {
  const { editing, workspace } = opened(sampleText("buttons"));
  assert.equal(editing.rowOf(workspace.code.split("\n").findIndex((line) => line.includes("pair_run 1")) + 1), 1);
});

test("a slider is one step of the history", () => {
  const { editing } = opened(sampleText("empty"));
  add(editing, "move");
  for (const speed of [50, 100, 150]) {
    const block = makeBlock("move", [speed, 0]);
    editing.edit(makeProgram("basic", [{ event: null, state: null, conditions: [], actions: [block] }]), "0 actions");
  }
  editing.endSeries();
  editing.undo();
  assert.deepEqual(editing.program.rows[0].actions[0].values, [0, 0]);
});

test("a new program: its text follows", () => {
  const { workspace, editing } = opened(sampleText("empty"));
  add(editing, "button");
  add(editing, "move");
  assert.match(workspace.code, /onevent buttons/);
  assert.equal(editing.rowOf(workspace.code.split("\n").findIndex((line) => line.includes("emit")) + 1), 0);
  assert.equal(workspace.fileStore.draft("*")?.text, workspace.current.text);
});

test("an older text counts until the user has decided, and the edit waits", () => {
  const before = read("format0.aesl");
  const { workspace, editing } = opened(before);
  assert.equal(editing.question?.message.key, "text.older");
  assert.ok((editing.question?.changes.length ?? 0) > 0);
  assert.equal(editing.shown.text, readVpl(before).code);
  const { program } = editing;
  editing.edit(makeProgram(program.mode, program.rows.slice(1)));
  assert.deepEqual([editing.question?.isAsked, editing.program === program, workspace.current.text], [true, true, before]);
  editing.decide(false);
  assert.deepEqual([editing.question?.isAsked, workspace.current.text], [false, before]);
  editing.edit(makeProgram(program.mode, program.rows.slice(1)));
  editing.decide(true);
  assert.deepEqual([editing.question, editing.program.rows.length], [null, program.rows.length - 1]);
  assert.match(workspace.code, /when .* do/);
});

test("a file that cannot be read as VPL stays as it is", () => {
  const text = newAesl("a = 1\n").replace("</node>", "<!-- <vplroot> --></node>");
  const { workspace, editing } = opened(text);
  assert.deepEqual([editing.error?.key, editing.isBlocked], ["file.none", false]);
  add(editing, "button");
  assert.equal(workspace.current.text, text);
});

test("notices say what to decide", () => {
  const { editing } = opened(read("format0.aesl"));
  const noop = () => {};
  const options = { t: en, editing, decide: noop, read: noop, answer: noop, turn: noop };
  const shown = questionNotices({ ...options, wanted: null });
  assert.match(shown.question?.text ?? "", /older VPL/);
  assert.deepEqual([shown.error, shown.loss], [null, null]);
  const states = opened(sampleText("states")).editing;
  const { loss } = questionNotices({ ...options, editing: states, wanted: "basic" });
  assert.ok((loss?.items?.length ?? 0) >= 2 && loss?.text.includes("Basic"));
});

test("the history outlives the view as long as the text is the same", () => {
  const { workspace, editing, kept } = opened(sampleText("empty"));
  add(editing, "button");
  const again = new VplEditing({ workspace, kept });
  again.open();
  assert.ok(again.canUndo);
  workspace.replaceText(sampleText("avoid"));
  again.open();
  assert.deepEqual([again.canUndo, again.program.rows.length], [false, 5]);
});

test("every mode keeps or names what it has", () => {
  const { editing } = opened(sampleText("states"));
  assert.ok(editing.lostIn("basic").length > 0 && editing.lostIn("extended").length === 0);
  for (const mode of [...MODES].reverse()) editing.setMode(mode);
  assert.equal(editing.mode, "basic");
});
