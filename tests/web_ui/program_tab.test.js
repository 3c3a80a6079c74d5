import assert from "node:assert/strict";
import { test } from "node:test";

import { byTopic } from "../../web_ui/editor/tools/reference.js";
import { listValues, namesIn } from "../../web_ui/editor/tools/value_names.js";
import { aboutOf, exampleTitle, inOrder, isExample, titleOf } from "../../web_ui/examples/index.js";
import editorTexts from "../../web_ui/i18n/editor.texts.js";
import exampleTexts from "../../web_ui/i18n/examples.texts.js";
import { translator } from "../../web_ui/i18n/index.js";
import { instructionsOf } from "../../web_ui/program_tab/foreign_bar.js";
import { SKELETONS, skeletonText } from "../../web_ui/editor/skeletons.js";

const en = translator("en", exampleTexts);

test("instructions are shown of a program without a text of its own only", () => {
  const program = { name: "from the network", node: "", first_line: 1, source: "0 0003", file: "0 0003", events: [], constants: [], variables: [] };
  assert.equal(instructionsOf({ ...program, foreign: true }), "0 0003");
  assert.equal(instructionsOf({ ...program, foreign: false }), null);
  assert.equal(instructionsOf(null), null);
});

test("examples have names for pupils; others keep their own", () => {
  assert.equal(titleOf("thesis_basic", en), "Drive with the arrows");
  assert.equal(titleOf("go_north", en), "go north");
  assert.equal(exampleTitle("line_follower.aesl", en), "Follow the line");
  assert.equal(exampleTitle("maze.aesl", en), "maze.aesl");
  assert.equal(aboutOf({ name: "go_north", description: "drives north" }, en), "drives north");
  assert.ok(isExample("welcome.aesl", "welcome") && isExample("welcome", "welcome") && !isExample("maze.aesl", "welcome"));
});

test("what pupils use first is offered first, the menu last", () => {
  const names = ["menu", "friendly", "welcome", "line_follower", "own", "thesis_basic"];
  const sorted = inOrder(names.map((name) => ({ name, description: "" }))).map(({ name }) => name);
  assert.deepEqual(sorted, ["thesis_basic", "line_follower", "friendly", "own", "welcome", "menu"]);
});

test("a skeleton has its comments in each language, in lines that fit beside the values", () => {
  for (const language of Object.keys(editorTexts)) {
    const t = translator(language, editorTexts);
    for (const name of SKELETONS) {
      const text = skeletonText(name, t);
      assert.doesNotMatch(text, /[{}]/);
      assert.doesNotMatch(text, /skeleton\./, language);
      assert.ok(text.startsWith(`# ${t(`new.${name}`)}\n`));
      for (const line of text.split("\n")) assert.ok(line.replaceAll("\t", "  ").length <= 50, `${language}: ${line}`);
    }
  }
});

const ROBOT = ["motor.left.target", "prox.horizontal", "acc", "_id", "temperature"].map((name, address) => ({
  name,
  size: 1,
  address,
  hidden: name === "_id",
  help: "",
}));
const ALL_NAMES = ["_id", "acc", "motor.left.target", "prox.horizontal", "temperature", "speed", "going"];
const LIST = { names: ALL_NAMES, robot: ROBOT, watched: new Set(["acc"]), used: new Set(["temperature"]), wanted: "", all: false, hidden: false };

test("values are listed by what matters: watched, of the program, then those that the program uses", () => {
  assert.deepEqual(listValues(LIST), {
    watched: ["acc"],
    own: ["speed", "going"],
    robot: ["temperature", "motor.left.target", "prox.horizontal"],
    count: 6,
  });
});

test("all values are in the order of the robot's help, and hidden ones are listed on demand", () => {
  assert.deepEqual(listValues({ ...LIST, all: true }).robot, ["motor.left.target", "prox.horizontal", "temperature"]);
  assert.ok(listValues({ ...LIST, all: true, hidden: true }).robot.includes("_id"));
  assert.deepEqual(listValues({ ...LIST, all: true, wanted: "GO" }).own, ["going"]);
});

test("names in comments are not used", () => {
  const names = namesIn("var a # temperature\n#* acc\n *# motor.left.target = a");
  assert.deepEqual([...names], ["var", "a", "motor.left.target"]);
});

test("help is listed by topic, across variables, events and functions", () => {
  const target = /** @type {any} */ ({
    topics: ["motors", "lights", "sensors"],
    variables: [
      { name: "prox.horizontal", size: 7, hidden: false, help: "", topic: "sensors" },
      { name: "motor.left.target", size: 1, hidden: false, help: "", topic: "motors" },
      { name: "_id", size: 1, hidden: true, help: "", topic: "others" },
    ],
    events: [{ name: "prox", help: "", topic: "sensors" }],
    natives: [{ name: "leds.top", parameters: [{ name: "red", size: 1 }], hidden: false, help: "", topic: "lights" }],
  });
  const found = byTopic(target).map(({ topic, entries }) => [topic, ...entries.map(({ shown }) => shown)]);
  assert.deepEqual(found, [
    ["motors", "motor.left.target"],
    ["lights", "call leds.top(red)"],
    ["sensors", "prox.horizontal[7]", "onevent prox"],
  ]);
});
