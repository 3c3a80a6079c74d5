import assert from "node:assert/strict";
import { test } from "node:test";

import { DragController } from "../../web_ui/move/drag_controller.js";
import { startOf } from "../../web_ui/move/start.js";
import { blocker, hit, movables, obstacles, overlap, reach } from "../../web_ui/move/placed_bodies.js";
import { INITIAL } from "../../web_ui/state/index.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";

/** @typedef {import("../../web_ui/state/index.js").State} State */

/** @param {number} x @param {number} y */
function robotAt(x, y) {
  const pose = { x, y, z: 0, yaw: 0, roll: 0, pitch: 0 };
  return { ...NEW_ROBOT, latest: { pose, stampNs: 0, arrivedMs: 0 } };
}

/** @param {string} name @param {number} x @param {number} type @param {number} size */
function solid(name, x, type, size) {
  const pose = { position: { x, y: 0, z: size / 2 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  return /** @type {any} */ ({ ns: `solid/${name}`, id: 1, type, pose, scale: { x: size, y: size, z: size }, points: [] });
}

/** The floor of a square ground. @param {number} size */
function floorOf(size) {
  const [a, b, c, d] = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => ({ x: (x * size) / 2, y: (y * size) / 2, z: 0 })); // prettier-ignore
  const pose = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  return /** @type {any} */ ({ ns: "floor/ground", id: 0, type: 11, pose, scale: { x: 1, y: 1, z: 1 }, points: [a, b, c, a, c, d] });
}

/** A robot at the origin, a can 30 cm before it, a wall at 1 m. @param {number} [size]  of the ground */
function world(size = 4) {
  const simulator = /** @type {any} */ ({ worldNames: { "": "thymio" }, movables: ["can"] });
  return /** @type {State} */ ({
    ...INITIAL,
    simulator,
    robots: { "": robotAt(0, 0) },
    markers: new Map([["f", floorOf(size)], ["w", solid("wall", 1, 1, 0.1)]]),
    objects: new Map([["c", solid("can", 0.3, 3, 0.06)], ["d", solid("door", -1, 1, 0.1)]]),
  });
}

/** Straight down. @param {number} x @param {number} y */
const down = (x, y) => ({ origin: { x, y, z: 1 }, direction: { x: 0, y: 0, z: -1 } });

/** A dragController over this world, with what it asked and reported. */
function prepared({ accepted = true } = {}) {
  /** @type {any[]} */ const asked = [];
  /** @type {any[]} */ const reported = [];
  const state = world();
  const dragController = new DragController({
    state: () => state,
    place: async (...given) => {
      asked.push(given);
      return accepted;
    },
    changed: () => {},
    report: (...given) => reported.push(given),
  });
  return { dragController, asked, reported };
}

test("robots and movable objects can be moved, walls and doors cannot", () => {
  assert.deepEqual(movables(world()).map(({ name }) => name), ["thymio", "can"]);
  assert.deepEqual(obstacles(world(), "can").map(({ name }) => name), ["thymio", "wall", "door"]);
});

test("squares that only touch do not overlap", () => {
  const square = (/** @type {number} */ x) => /** @type {[number, number][]} */ ([[x, 0], [x + 1, 0], [x + 1, 1], [x, 1]]); // prettier-ignore
  assert.equal(overlap(square(0), square(0.9)), true);
  assert.equal(overlap(square(0), square(1)), false);
});

test("a robot fits beside a wall, but not in it", () => {
  const [robot] = movables(world());
  const others = obstacles(world(), robot.name);
  assert.equal(blocker(robot, { x: 0.6, y: 0, yaw: 0 }, others), null);
  assert.equal(blocker(robot, { x: 0.9, y: 0, yaw: 0 }, others)?.name, "wall");
  assert.equal(blocker(robot, { x: 0.2, y: 0, yaw: 0 }, others)?.name, "can");
});

test("a prism's footprint is its top", () => {
  const corners = [
    [0, 0],
    [1, 0],
    [0, 1],
  ].map(([x, y]) => ({ x, y, z: 0.1 }));
  const prism = { ...solid("prism", 0, 11, 0.2), points: [...corners, { x: 9, y: 9, z: -0.1 }, ...corners.slice(1)] };
  const [body] = obstacles({ ...world(), robots: {}, objects: new Map(), markers: new Map([["p", prism]]) }, "");
  assert.equal(body.outline.length, 1);
  assert.equal(reach(body), 1);
});

test("a pointer grabs the first body on its line of sight", () => {
  const bodies = movables(world());
  assert.equal(hit(down(0.02, 0), bodies)?.body.name, "thymio");
  assert.equal(hit(down(0.3, 0.01), bodies)?.body.name, "can");
  assert.equal(hit(down(0.6, 0), bodies), null);
  const slanting = { origin: { x: 0.3 - 1, y: 0, z: 1.05 }, direction: { x: 1, y: 0, z: -1 } };
  assert.equal(hit(slanting, bodies)?.body.name, "can"); // through its top edge, not where it stands
  assert.equal(hit({ ...slanting, direction: { x: 1, y: 0, z: 0 } }, bodies), null);
});

test("a dragged body keeps its offset to the pointer, and the simulator is asked when it is dropped", async () => {
  const { dragController, asked } = prepared();
  assert.equal(dragController.grab(down(0.05, 0.01), false), false);
  assert.equal(dragController.grab(down(0.05, 0.01), true), true);
  dragController.drag(down(0.55, -0.19));
  const pose = dragController.dragged?.pose;
  assert.ok(pose && Math.abs(pose.x - 0.5) < 1e-9 && Math.abs(pose.y + 0.2) < 1e-9);
  await dragController.drop();
  assert.equal(asked[0][0], "thymio");
  assert.equal(dragController.dragged, null);
});

test("a ghost reports the obstacle at its position", () => {
  const { dragController } = prepared();
  dragController.grab(down(0.3, 0), true);
  dragController.drag(down(1, 0));
  assert.equal(dragController.dragged?.blocker, "wall");
  dragController.drag(down(0.6, 0));
  assert.equal(dragController.dragged?.blocker, null);
});

test("the ring turns the selected body in move mode", () => {
  const { dragController } = prepared();
  dragController.setMode(true);
  assert.equal(dragController.dragged?.body.name, "thymio");
  const radius = reach(/** @type {any} */ (dragController.dragged).body) + 0.025;
  assert.equal(dragController.grab(down(radius, 0), true), true);
  dragController.drag(down(0, radius));
  assert.ok(dragController.dragged !== null && Math.abs(dragController.dragged.pose.yaw - Math.PI / 2) < 1e-9 && dragController.dragged.pose.x === 0);
});

test("keys move, turn, select the next body and drop it", async () => {
  const { dragController, asked, reported } = prepared();
  dragController.setMode(true);
  dragController.next();
  dragController.nudge(1, 2, 1);
  assert.deepEqual(reported.at(-1), ["move.at", { x: "31", y: "2", yaw: 15 }]);
  dragController.nudge(70, -2);
  assert.deepEqual(reported.at(-1), ["move.blocked", { x: "101", y: "0", yaw: 15, by: "wall" }]);
  await dragController.drop();
  assert.equal(asked[0][0], "can");
  assert.equal(dragController.dragged?.pose.x, 0.3); // still in hand, where it stands
  dragController.setMode(false);
  assert.equal(dragController.dragged, null);
});

test("nothing is selected in an empty world", async () => {
  const dragController = new DragController({ state: () => INITIAL, place: async () => true, changed: () => {}, report: () => {} });
  dragController.setMode(true);
  dragController.next();
  dragController.nudge(1, 0);
  await dragController.drop();
  assert.equal(dragController.dragged, null);
});

/** A playground of ours with one robot. @param {Record<string, any>} robot */
const started = (robot) => JSON.stringify({ format: 1, title: "Floor", shapes: [], robots: [{ name: "thymio", ...robot }] });

test("a fallen robot is returned to its start", () => {
  const found = startOf(world(), started({ x_m: -0.5, y_m: 0.5, yaw_rad: 1 }), "thymio");
  assert.deepEqual(found, { x: -0.5, y: 0.5, yaw: 1 });
});

test("if the start is occupied, a fallen robot is placed next to it, on the ground", () => {
  const start = { x_m: 0.25, y_m: 0 }; // its front would be in the can
  assert.deepEqual(startOf(world(), started(start), "thymio"), { x: 0.4, y: 0, yaw: 0 });
  const onSmallFloor = startOf(world(0.6), started(start), "thymio");
  assert.deepEqual([onSmallFloor.x.toFixed(3), onSmallFloor.y.toFixed(3)], ["0.250", "0.150"]);
});

test("a robot without a start is placed at the start of another, or next to it", () => {
  const found = startOf(world(), started({ x_m: 0, y_m: 0 }), "anna");
  assert.ok(Math.hypot(found.x, found.y) > 0.1);
});
