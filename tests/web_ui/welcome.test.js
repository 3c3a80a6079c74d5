// The first visit: who sees the three starts, what they offer, and what the ROS sheet shows.

import assert from "node:assert/strict";
import { test } from "node:test";

import { canOffer, canStart, isFirstVisit } from "../../web_ui/hosts/welcome_host.js";
import { INITIAL } from "../../web_ui/state/index.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";
import { offeredExamples } from "../../web_ui/welcome/offered_examples.js";
import { listensTo, publishesOf, speedCommand } from "../../web_ui/welcome/ros_topics.js";

/** @param {string | null} kept */
const storage = (kept) => ({ getItem: () => kept });

test("the starts are shown until something was chosen in this browser", () => {
  assert.equal(isFirstVisit({ wanted: null, storage: storage(null), entry: null }), true);
  assert.equal(isFirstVisit({ wanted: null, storage: storage("chosen"), entry: null }), false);
  assert.equal(isFirstVisit({ wanted: null, storage: storage(null), entry: { welcome: "chosen" } }), false);
});

test("the address overrides what the browser remembers", () => {
  assert.equal(isFirstVisit({ wanted: false, storage: storage(null), entry: null }), false);
  assert.equal(isFirstVisit({ wanted: true, storage: storage("chosen"), entry: { welcome: "chosen" } }), true);
});

test("they need a robot, a connection that may write, and the running world in the view", () => {
  const state = { ...INITIAL, connection: /** @type {const} */ ("connected"), identified: true, robots: { "": NEW_ROBOT } };
  assert.equal(canStart(state, false), true);
  assert.equal(canStart(state, true), false);
  assert.equal(canStart({ ...state, connection: "lost" }, false), false);
  assert.equal(canStart({ ...state, identified: false }, false), false); // whether it may write is not known yet
  assert.equal(canStart({ ...state, readOnly: true }, false), false);
  assert.equal(canStart({ ...state, robots: {} }, false), false);
  assert.equal(canStart({ ...state, mission: /** @type {any} */ ({ name: "forward" }) }, false), false); // its card is there
});

test("the tour is not offered over an open tab or a mission", () => {
  const state = { ...INITIAL, connection: /** @type {const} */ ("connected"), identified: true };
  assert.equal(canOffer(state, null), true);
  assert.equal(canOffer(state, "program"), false);
  assert.equal(canOffer({ ...state, mission: /** @type {any} */ ({ name: "forward" }) }, null), false);
  assert.equal(canOffer({ ...state, connection: "lost" }, null), false);
});

test("examples that move by themselves come first; the menu and what only waits are none", () => {
  const behaviors = ["attentive", "explorer", "friendly", "line_follower", "menu", "welcome", "own"].map((name) => ({ name }));
  assert.deepEqual(offeredExamples(behaviors), ["line_follower", "explorer", "friendly", "attentive", "own"]);
  assert.deepEqual(offeredExamples([{ name: "own" }]), ["own"]);
});

test("the command drives for two seconds, with the topic of the chosen robot", () => {
  const type = 'geometry_msgs/msg/Twist "{linear: {x: 0.1}}"';
  assert.equal(speedCommand(""), `ros2 topic pub --rate 10 --times 20 /cmd_vel ${type}`);
  assert.equal(speedCommand("anna"), `ros2 topic pub --rate 10 --times 20 /anna/cmd_vel ${type}`);
  assert.equal(listensTo("anna")[0].topic, "/anna/cmd_vel");
});

test("a first node sees the robot's own public topics, those of a folder as one", () => {
  const topics = ["/odom", "/ground/right", "/ground/left", "/ground/left/reflectance", "/_raw/ground", "/tf", "/clock", "/anna/odom"];
  assert.deepEqual(publishesOf(topics, ""), ["/ground/{left, right}", "/odom"]);
  assert.deepEqual(publishesOf(topics, "anna"), ["/anna/odom"]);
});
