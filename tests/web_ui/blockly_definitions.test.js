import assert from "node:assert/strict";
import { test } from "node:test";

import { BLOCKS } from "../../web_ui/blockly/blocks/index.js";
import { definitions } from "../../web_ui/blockly/definitions.js";
import { generate } from "../../web_ui/blockly/generator.js";
import { LOOKS, NAMES, lookOf, offeredLooks } from "../../web_ui/blockly/looks.js";
import { injectOptions } from "../../web_ui/blockly/options.js";
import { allBlocks } from "../../web_ui/blockly/state.js";
import { theme } from "../../web_ui/blockly/themes.js";
import {
  CATEGORIES,
  newBlock,
  offered,
  subroutineFlyout,
  subroutineNames,
  toolbox,
  variableFlyout,
} from "../../web_ui/blockly/toolbox.js";
import texts from "../../web_ui/i18n/blockly.texts.js";
import coreTexts from "../../web_ui/i18n/blockly_core.texts.js";
import { LANGUAGES, translator } from "../../web_ui/i18n/index.js";
import { Blockly, ENGLISH } from "./blockly_dom.js";
import { PROGRAMS, golden, stateOf, workspace } from "./blockly_support.js";

const t = translator("en", texts);
const ColorField = class extends Blockly.FieldTextInput {};
ColorField.fromJson = (/** @type {Record<string, string>} */ options) =>
  Reflect.construct(ColorField, [Object.values(options).find((value) => value.startsWith("#"))]);
Blockly.fieldRegistry.register("field_colour", ColorField);

/** @param {string} language */
function define(language) {
  const all = definitions(translator(language, texts));
  for (const { type } of all) delete Blockly.Blocks[type];
  Blockly.common.defineBlocks(Blockly.common.createBlockDefinitionsFromJsonArray(all));
}

/**
 * The state that Blockly has after it has loaded one.
 *
 * @param {import("../../web_ui/blockly/state.js").WorkspaceState} state
 */
function throughBlockly(state) {
  const workspace = new Blockly.Workspace();
  Blockly.serialization.workspaces.load(state, workspace);
  return Blockly.serialization.workspaces.save(workspace);
}

for (const language of Object.keys(LANGUAGES)) {
  test(`Blockly accepts every block in ${language}`, () => {
    define(language);
    const workspace = new Blockly.Workspace();
    for (const type of BLOCKS.keys()) {
      const block = workspace.newBlock(type);
      assert.equal(/[{}]|block\.|option\./.test(block.toString()), false, block.toString());
    }
  });
}

test("texts that Blockly lacks in a language are those of its English ones", () => {
  for (const [key, text] of Object.entries(coreTexts.en)) assert.equal(ENGLISH[key], text, key);
  for (const [language, table] of Object.entries(coreTexts)) {
    for (const [key, text] of Object.entries(table)) {
      assert.deepEqual(text.match(/%\d/g)?.sort(), ENGLISH[key].match(/%\d/g)?.sort(), `${language} ${key}`);
    }
  }
});

test("blocks have the fields and inputs of their descriptions", () => {
  define("en");
  const workspace = new Blockly.Workspace();
  for (const spec of BLOCKS.values()) {
    const block = workspace.newBlock(spec.type);
    for (const { kind, name, options } of spec.args) {
      if (spec.type === "controls_if" && name === "ELSE") continue;
      const found = ["value", "body"].includes(kind) ? block.getInput(name) : block.getField(name);
      assert.notEqual(found, null, `${spec.type} ${name}`);
      if (kind === "choice") {
        const values = found.getOptions(false).map((/** @type {string[]} */ [, value]) => value);
        for (const [, value] of options ?? []) assert.equal(values.includes(value), true, `${spec.type} ${value}`);
      }
    }
    assert.equal(block.outputConnection !== null, ["Number", "Boolean"].includes(spec.shape), spec.type);
    assert.equal(block.previousConnection !== null, spec.shape === "statement", spec.type);
  }
});

for (const name of PROGRAMS) {
  test(`${name} is the same program in Blockly`, () => {
    define("en");
    assert.equal(generate(throughBlockly(stateOf(golden(`${name}.xml`)))).code, golden(`${name}.aseba`));
  });
}

test("ids of blocks stay, so that the running block can be shown", () => {
  define("en");
  const state = stateOf(golden("avoid_obstacles.xml"));
  const ids = (/** @type {any} */ each) => [...allBlocks(each)].map(({ id }) => id).sort();
  assert.deepEqual(ids(throughBlockly(state)), ids(state));
});

test("both toolboxes offer blocks that exist, and each Thymio block is in one", () => {
  const types = LOOKS.flatMap((look) => offered(look)).filter((name) => !name.startsWith("category:"));
  for (const type of types) assert.equal(BLOCKS.has(type), true, type);
  const understood = ["thymio_variable_get", "thymio_variable_set", "logic_compare", "math_arithmetic"];
  const older = ["thymio_subroutine_define", "thymio_proxHorizontal", "thymio_proxGroundDelta"];
  const ofOthers = ["thymio_math_cos", "thymio_math_atan2", "thymio_sound_wave"]; // programs of VPL, shown as blocks
  const missing = [...BLOCKS.keys()].filter((type) => !types.includes(type));
  assert.deepEqual(missing.sort(), [...understood, ...older, ...ofOthers].sort());
});

test("blocks of a toolbox have shadows with numbers", () => {
  assert.deepEqual(newBlock("thymio_motors_start"), {
    type: "thymio_motors_start",
    fields: { COMMAND: "FORWARD" },
    inputs: { SPEED: { shadow: { type: "math_number", fields: { NUM: 300 } } } },
  });
  define("en");
  for (const look of LOOKS) {
    const blocks = CATEGORIES[look].flatMap(({ types }) => types.map((type) => newBlock(type)));
    assert.equal(throughBlockly({ blocks: { blocks } }).blocks.blocks.length, blocks.length);
  }
});

test("the flyout of variables has a getter for each, that of subroutines a call for each", () => {
  const variables = [
    { name: "b", id: "2" },
    { name: "a", id: "1" },
  ];
  const [button, ...items] = /** @type {any[]} */ (variableFlyout(variables, "blockly", t));
  assert.equal(button.kind, "button");
  const getters = items.filter(({ type }) => type === "variables_get");
  assert.deepEqual(
    getters.map(({ fields }) => fields.VAR.id),
    ["1", "2"],
  );
  const names = subroutineNames(allBlocks(stateOf(golden("subroutines.xml"))));
  assert.deepEqual(names, ["go home", "turn", "beep"]);
  const calls = /** @type {any[]} */ (subroutineFlyout(names)).filter(({ extraState }) => extraState !== undefined);
  assert.deepEqual(
    calls.map(({ extraState }) => extraState.name),
    names,
  );
});

test("a teacher's file hides blocks and categories", () => {
  const hidden = new Set(["thymio_led", "category:math", "variables_get"]);
  const shown = JSON.stringify(toolbox("blockly", t, hidden));
  assert.doesNotMatch(shown, /"thymio_led"|"math"/);
  assert.match(shown, /"thymio_led_rgb"/);
  assert.doesNotMatch(JSON.stringify(variableFlyout([{ name: "a", id: "1" }], "blockly", t, hidden)), /variables_get/);
});

test("a category without blocks is left out", () => {
  const hidden = new Set(["controls_repeat", "controls_whileUntil", "thymio_for"]);
  assert.doesNotMatch(JSON.stringify(toolbox("blockly", t, hidden)), /"loops"/);
});

test("a teacher's file limits the looks, unless it names none", () => {
  assert.deepEqual(offeredLooks({ modes: null }), LOOKS);
  assert.deepEqual(offeredLooks({ modes: ["basic"] }), LOOKS);
  assert.deepEqual(offeredLooks({ modes: ["scratch"] }), ["scratch"]);
  for (const name of ["thymio_led", "category:loops", "category:motion", "control_wait", "scratch"]) {
    assert.ok(NAMES.includes(name), name);
  }
});

test("a program has the look to which its blocks belong", () => {
  assert.equal(lookOf(stateOf(golden("follow_line.xml"))), "blockly");
  assert.equal(lookOf(stateOf(golden("scratch_square.xml"))), "scratch");
  assert.equal(lookOf(workspace({ type: "variables_set" })), null);
  assert.equal(lookOf(workspace()), null);
});

test("an editor takes nothing from other hosts, and blocks snap to the grid", () => {
  const options = injectOptions("scratch", { t, media: "media/" });
  assert.deepEqual(
    [options.media, options.sounds, options.renderer, options.grid.snap],
    ["media/", false, "zelos", true],
  );
  assert.equal(options.toolbox.contents.length, CATEGORIES.scratch.length);
});

test("every style of a block has a color in both looks", () => {
  for (const look of LOOKS) {
    const { blockStyles, categoryStyles } = theme(look);
    for (const { style, type } of BLOCKS.values()) assert.equal(style in blockStyles, true, type);
    for (const { style } of CATEGORIES[look]) assert.equal(style in categoryStyles, true, style);
  }
});

test("problems and tooltips have texts", () => {
  const keys = Object.keys(texts.en);
  for (const spec of BLOCKS.values()) {
    if (!spec.builtIn) assert.equal(keys.includes(`block.${spec.type}`), true, spec.type);
  }
  const own = [...BLOCKS.values()].filter(({ builtIn }) => !builtIn);
  const thymio = own.filter(({ style }) => ["event_blocks", "actuator_blocks", "led_blocks"].includes(style));
  for (const { type } of thymio) assert.equal(keys.includes(`tooltip.${type}`), true, type);
});
