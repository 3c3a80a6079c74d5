// The lidar on the page: its topic, its head, the dots where its beams ended, and its rows in the sensor panel.

import assert from "node:assert/strict";
import { test } from "node:test";

import { asText, groupsOf } from "../../web_ui/robot_tab/sensor_rows.js";
import { LIDAR_PLACE } from "../../web_ui/scene/parts.js";
import { RobotModel } from "../../web_ui/scene/robot.js";
import { RobotInstances } from "../../web_ui/scene/robot_instances.js";
import { scanEnds } from "../../web_ui/scene/scan.js";
import { INITIAL, reduce } from "../../web_ui/state/index.js";
import { isWatched } from "../../web_ui/state/names.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";

const TURN = 2 * Math.PI;
const SCAN = { ranges: [1, 0.5, Infinity, 0.25], angleMin: 0, step: TURN / 4 };

/** @param {import("../../web_ui/state/robot.js").Robot} robot @param {boolean} [sensing] */
function look(robot, sensing = true) {
  return { robot, hovered: null, sensing, flash: 0 };
}

/** @param {number} x @param {number} yaw */
function frameAt(x, yaw) {
  const { group } = new RobotModel("");
  group.position.set(x, 0, 0);
  group.rotation.z = yaw;
  group.updateMatrix();
  return group.matrix;
}

/** @param {RobotInstances} instances */
function dotsOf({ group }) {
  const points = /** @type {import("three").Points} */ (group.children.find((part) => "isPoints" in part));
  if (!points.visible) return [];
  const { array } = points.geometry.getAttribute("position");
  const { count } = points.geometry.drawRange;
  return Array.from({ length: count }, (_, at) => [...array.slice(3 * at, 3 * at + 3)].map((value) => +value.toFixed(4)));
}

test("a robot has a lidar while its topic is there", () => {
  const topics = ["/a/_ground_truth/odom", "/a/scan", "/b/_ground_truth/odom"];
  let state = reduce(INITIAL, { type: "channels", topics });
  assert.deepEqual([state.robots.a.hasLidar, state.robots.b.hasLidar], [true, false]);
  assert.ok(isWatched(state, "/a/scan"));
  const value = { ranges: SCAN.ranges, angle_min: 0, angle_increment: SCAN.step };
  state = reduce(state, { type: "message", topic: "/a/scan", value, timeNs: 0n, nowMs: 0 });
  assert.deepEqual(state.robots.a.scan, SCAN);
  state = reduce(state, { type: "channels", topics: topics.filter((topic) => topic !== "/a/scan") });
  assert.deepEqual([state.robots.a.hasLidar, state.robots.a.scan], [false, null]);
});

test("a beam ends where it met something", () => {
  const rounded = scanEnds(SCAN).map((value) => +value.toFixed(6));
  assert.deepEqual(rounded, [LIDAR_PLACE.x + 1, 0, LIDAR_PLACE.x, 0.5, LIDAR_PLACE.x, -0.25]);
});

test("the dots of all robots are where the robots are, and go with the beams", () => {
  for (const fine of [true, false]) {
    const instances = new RobotInstances({ fine });
    const frame = frameAt(2, Math.PI / 2);
    const robot = { ...NEW_ROBOT, hasLidar: true, scan: { ...SCAN, ranges: [1, Infinity, Infinity, Infinity] } };
    const here = frameAt(0, 0);
    instances.update([{ look: look(NEW_ROBOT), frame: here }]);
    assert.deepEqual(dotsOf(instances), []);
    instances.update([{ look: look(robot), frame: here }, { look: look(robot), frame }]);
    assert.deepEqual(dotsOf(instances), [[1.02, 0, 0.05], [2, 1.02, 0.05]]); // prettier-ignore
    instances.update([{ look: look({ ...robot, scan: SCAN }), frame }]);
    assert.equal(dotsOf(instances).length, 3);
    instances.update([{ look: look(robot, false), frame }]);
    assert.deepEqual(dotsOf(instances), []);
    instances.dispose();
  }
});

test("the sensor panel has the nearest distance in each direction, only of a robot with a lidar", () => {
  const key = (/** @type {string} */ name) => name;
  const robot = { ...NEW_ROBOT, hasLidar: true, scan: SCAN };
  const rows = asText(groupsOf({ robotText: key, stageText: key }, "en", [], robot), robot).split("\n").filter((line) => line.startsWith("sensors.lidar"));
  assert.deepEqual(
    rows.map((line) => line.split("\t").slice(1, 3)),
    [
      ["lidar.nearest", "25.0 cm"],
      ["lidar.front", "100.0 cm"],
      ["lidar.left", "50.0 cm"],
      ["lidar.back", "sensors.nothing"],
      ["lidar.right", "25.0 cm"],
    ],
  );
  assert.ok(!asText(groupsOf({ robotText: key, stageText: key }, "en", []), NEW_ROBOT).includes("lidar"));
  assert.ok(!asText(groupsOf({ robotText: key, stageText: key }, "en", [], robot), { ...robot, scan: null }).includes("NaN"));
});
