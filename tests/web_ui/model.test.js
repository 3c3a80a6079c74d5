import assert from "node:assert/strict";
import { test } from "node:test";

import { RobotInstances } from "../../web_ui/scene/robot_instances.js";
import { PlaygroundModel } from "../../web_ui/scene/playground.js";
import { RobotModel } from "../../web_ui/scene/robot.js";
import { applyMarkers } from "../../web_ui/state/markers.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";
import { captured } from "./support.js";

const TRIANGLES = 1900;
/** However many robots: shadow, light on the ground, body, line around it, wheels, halos, beams, their ends, ground patches. */
const MOST_DRAW_CALLS = 9;

/** @param {number} count @param {Partial<import("../../web_ui/state/robot.js").Robot>} [state] */
function standing(count, state = {}) {
  return Array.from({ length: count }, (_, x) => ({
    look: { robot: { ...NEW_ROBOT, ...state }, hovered: null, sensing: true, flash: 0 },
    frame: frameAt(x),
  }));
}

/** @param {number} x */
function frameAt(x) {
  const { group } = new RobotModel("");
  group.position.set(x, 0, 0);
  group.updateMatrix();
  return group.matrix;
}

/** @param {RobotInstances} instances */
function drawn(instances) {
  return /** @type {import("three").InstancedMesh[]} */ (instances.group.children.filter(({ visible }) => visible));
}

/** @param {RobotInstances} instances */
function triangles(instances) {
  const sizes = drawn(instances).map(({ geometry: { index, attributes }, count }) => {
    return ((index?.count ?? attributes.position.count) / 3) * count;
  });
  return sizes.reduce((sum, size) => sum + size, 0);
}

test(`a robot has fewer than ${TRIANGLES} triangles`, () => {
  const instances = new RobotInstances({ fine: true });
  instances.update(standing(1));
  assert.ok(triangles(instances) < TRIANGLES, `${triangles(instances)}`);
});

test("twenty robots take as many draw calls as one", () => {
  const instances = new RobotInstances({ fine: true });
  for (const count of [1, 20, 3]) {
    instances.update(standing(count));
    assert.ok(drawn(instances).length > 3);
    assert.ok(drawn(instances).length <= MOST_DRAW_CALLS);
    assert.ok(triangles(instances) < count * TRIANGLES);
  }
});

test("a distant robot has a fifth of the triangles of a near one", () => {
  const [fine, coarse] = [true, false].map((detail) => {
    const instances = new RobotInstances({ fine: detail });
    instances.update(standing(1));
    return triangles(instances);
  });
  assert.ok(coarse < fine / 5, `${coarse} of ${fine}`);
});

test("invisible parts are not drawn: a distant robot is its body, its shadow, and the light it throws", () => {
  const instances = new RobotInstances({ fine: false });
  const look = { sensing: false, hovered: null, flash: 0 };
  /** @param {Partial<import("../../web_ui/state/robot.js").Robot>} state */
  const many = (state) => standing(20, state).map(({ frame }) => ({ frame, look: { ...look, robot: { ...NEW_ROBOT, ...state } } }));
  instances.update(many({}));
  assert.equal(sum(copies(instances)), 20 * 3, "the shadow has two parts");
  instances.update(many({ leds: { top: [0, 0.5, 0] } }));
  assert.equal(sum(copies(instances)), 20 * 4);
  instances.update(many({}));
  assert.equal(sum(copies(instances)), 20 * 3);
});

test("every robot has the colors of its own lights and buttons", () => {
  const instances = new RobotInstances({ fine: true });
  const [dark, lit] = standing(2);
  const leds = { circle: [0, 1], top: [0, 0, 0.5], bottom_left: [1, 0, 0] };
  const buttons = { ...NEW_ROBOT.buttons, forward: true };
  instances.update([dark, { ...lit, look: { ...lit.look, robot: { ...NEW_ROBOT, leds, buttons } } }]);
  /** @param {number} slot @param {string} name */
  const levelOf = (slot, name) => lampsOf(instances).lampOf(slot, name).level;
  for (const name of ["led.circle.1", "bottom_left", "forward", ""]) {
    assert.equal(levelOf(0, name), 0);
    assert.ok(levelOf(1, name) > 0.25, name);
  }
  assert.equal(levelOf(1, "led.circle.0"), 0);
  const { r, b } = lampsOf(instances).lampOf(1, "led.circle.1");
  assert.ok(r > b, "yellow, as all of the circle");
  const { r: red, b: blue } = lampsOf(instances).lampOf(1, "");
  assert.ok(red === 0 && blue === 1, "the color at full brightness");
});

test("a flash tints the whole body, also where its light is off", () => {
  const instances = new RobotInstances({ fine: true });
  const [robot] = standing(1);
  instances.update([{ ...robot, look: { ...robot.look, flash: 1 } }]);
  assert.equal(lampsOf(instances).lampOf(0, "").level, 1);
  instances.update([robot]);
  assert.equal(lampsOf(instances).lampOf(0, "").level, 0);
});

test("the shadow stays on the ground and grows pale when the robot is lifted", () => {
  const instances = new RobotInstances({ fine: true });
  const [robot] = standing(1);
  instances.update([robot]);
  const [shadow] = drawn(instances);
  const before = shadow.instanceColor?.array[0] ?? 0;
  const frame = robot.frame.clone().setPosition(0, 0, 0.06);
  instances.update([{ ...robot, frame }]);
  assert.ok(placeOf(shadow, 0)[14] < 0.003);
  assert.ok((shadow.instanceColor?.array[0] ?? 1) < before);
});

test("an unchanged robot is not updated, a moved one is drawn at its pose", () => {
  const instances = new RobotInstances({ fine: true });
  const robots = standing(2);
  instances.update(robots);
  const versions = () => drawn(instances).map(({ instanceMatrix }) => instanceMatrix.version);
  const before = versions();
  instances.update(robots);
  assert.deepEqual(versions(), before);
  instances.update([robots[0], { ...robots[1], frame: frameAt(7) }]);
  const body = drawn(instances).find(({ geometry }) => geometry.attributes.aLamp !== undefined);
  assert.ok(body !== undefined);
  assert.equal(placeOf(body, 1)[12], 7);
  assert.ok(versions().every((version, index) => version > before[index]));
});

test("a robot that reuses a slot has nothing of the previous robot", () => {
  const instances = new RobotInstances({ fine: true });
  const lit = { circle: [1, 0, 0, 0, 0, 0, 0, 0] };
  instances.update(standing(2, { leds: lit, proximity: { center: 0.05 } }));
  instances.update(standing(1));
  instances.update(standing(2));
  const fresh = new RobotInstances({ fine: true });
  fresh.update(standing(2));
  /** @param {RobotInstances} one */
  const all = (one) =>
    drawn(one).map(({ instanceMatrix, instanceColor, count }) => [
      ...instanceMatrix.array.slice(0, count * 16),
      ...(instanceColor?.array.slice(0, count * 3) ?? []),
    ]);
  assert.deepEqual(all(instances), all(fresh));
});

test("beams and patches are shown only where they are wanted", () => {
  const instances = new RobotInstances({ fine: true });
  const seeing = { proximity: { center: 0.05, left: Infinity }, raw: { ground: [0, 0, 0, 0, 500, 500] } };
  const [robot] = standing(1, seeing);
  const sensed = () => copies(instances).slice(-3);
  instances.update([robot]);
  assert.deepEqual(sensed(), [2, 1, 4], "beams, the end of one, rims and fills");
  instances.update([{ ...robot, look: { ...robot.look, sensing: false } }]);
  assert.deepEqual(sensed(), [0, 0, 0]);
});

/** @param {RobotInstances} instances */
function lampsOf(instances) {
  const found = instances.pieces.map(({ lamps }) => lamps).find((lamps) => lamps !== undefined);
  assert.ok(found !== undefined);
  return found;
}

/** How many copies of each shape are drawn. @param {RobotInstances} instances */
function copies(instances) {
  const meshes = /** @type {import("three").InstancedMesh[]} */ (instances.group.children);
  return meshes.map(({ visible, count }) => (visible ? count : 0));
}

/** @param {number[]} values */
function sum(values) {
  return values.reduce((total, value) => total + value, 0);
}

/** The matrix of a copy, column by column. @param {import("three").InstancedMesh} mesh @param {number} index */
function placeOf(mesh, index) {
  return mesh.instanceMatrix.array.slice(16 * index, 16 * index + 16);
}

test("a robot and its parts are drawn at the reported pose", () => {
  const model = new RobotModel("");
  const pose = { x: 1, y: 2, z: 0, yaw: Math.PI / 2, roll: 0, pitch: 0 };
  const latest = { pose, stampNs: 0, arrivedMs: 0 };
  assert.equal(model.update({ ...NEW_ROBOT, latest }, 0), false);
  const place = model.partPosition("button.center");
  assert.ok(place !== null && Math.abs(place.x - 1) < 1e-9 && Math.abs(place.y - 2.048) < 1e-9);
  assert.equal(model.partPosition("no such part"), null);
});

test("a robot that leans on its nose has its front below", () => {
  const model = new RobotModel("");
  const pose = { x: 0, y: 0, z: 0, yaw: Math.PI / 2, roll: 0, pitch: 0.8 };
  model.update({ ...NEW_ROBOT, latest: { pose, stampNs: 0, arrivedMs: 0 } }, 0);
  const front = model.partPosition("button.forward");
  const back = model.partPosition("button.backward");
  assert.ok(front !== null && back !== null && front.z < back.z && front.y > back.y);
});

test("a robot without a pose is not drawn", () => {
  const model = new RobotModel("");
  model.update(NEW_ROBOT, 0);
  assert.equal(model.group.visible, false);
});

test("a trail grows without rebuilding its finished strokes", () => {
  const strip = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  /** @param {number} id @param {number} points */
  const stroke = (id, points) => ({
    ...strip,
    ns: "pen",
    id,
    type: 4,
    points: Array.from({ length: points }, (_, x) => ({ x, y: 0, z: 0 })),
  });
  const model = new PlaygroundModel();
  const everything = { ...strip, action: 3 };
  model.update(applyMarkers(new Map(), [everything, stroke(0, 4), stroke(1, 2)]));
  const [finished, growing] = [model.meshes.get("pen/0")?.mesh, model.meshes.get("pen/1")?.mesh];
  assert.ok(finished !== undefined && growing !== undefined);
  model.update(applyMarkers(new Map(), [everything, stroke(0, 4), stroke(1, 3)]));
  assert.equal(model.meshes.get("pen/0")?.mesh, finished);
  assert.notEqual(model.meshes.get("pen/1")?.mesh, growing);
});

test("only changed markers are rebuilt", () => {
  const wall = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  const first = applyMarkers(new Map(), [wall, { ...wall, id: 8, type: 3 }]);
  const model = new PlaygroundModel();
  assert.equal(model.update(first), true);
  const kept = model.meshes.get("solid/wall/7")?.mesh;
  assert.equal(model.update(first), false);
  model.update(applyMarkers(first, [{ ...wall, id: 8, type: 2 }]));
  assert.equal(model.meshes.get("solid/wall/7")?.mesh, kept);
  model.update(applyMarkers(first, [{ ...wall, action: 3 }]));
  assert.equal(model.group.children.length, 0);
});

test("a solid that has only moved keeps its mesh", () => {
  const wall = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  const first = applyMarkers(new Map(), [wall]);
  const model = new PlaygroundModel();
  model.update(first);
  const kept = model.meshes.get("solid/wall/7")?.mesh;
  const pose = { ...wall.pose, position: { x: 3, y: 4, z: 5 } };
  model.update(applyMarkers(first, [{ ...wall, action: 3 }, { ...wall, pose }]));
  assert.equal(model.meshes.get("solid/wall/7")?.mesh, kept);
  assert.deepEqual(kept?.position.toArray(), [3, 4, 5]);
  model.update(applyMarkers(first, [{ ...wall, scale: { x: 9, y: 9, z: 9 } }]));
  assert.notEqual(model.meshes.get("solid/wall/7")?.mesh, kept);
});

test("every kind of marker is drawn in meters", () => {
  const wall = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  const points = [
    { x: 0, y: 0, z: 0 },
    { x: 1, y: 0, z: 0 },
    { x: 1, y: 1, z: 0 },
  ];
  const sizes = [1, 2, 3, 4, 11].map((type) => {
    const model = new PlaygroundModel();
    model.update(applyMarkers(new Map(), [{ ...wall, type, points, scale: { x: 0.1, y: 0.1, z: 0.2 } }]));
    const height = Math.max(...model.corners().map(({ z }) => z)) - Math.min(...model.corners().map(({ z }) => z));
    return height.toFixed(3);
  });
  assert.deepEqual(sizes, ["0.200", "0.200", "0.200", "0.000", "0.000"]);
});

test("an image is a flat sheet of the marker's size, shown as soon as it is decoded", async () => {
  const wall = captured("visualization_msgs/msg/MarkerArray").value.markers[1];
  const bitmap = /** @type {any} */ ({ width: 2, height: 1 });
  /** @type {Blob[]} */ const decoded = [];
  await new Promise((/** @type {(value?: unknown) => void} */ arrived) => {
    const model = new PlaygroundModel(arrived, async (png) => {
      decoded.push(png);
      return bitmap;
    });
    const texture = { data: [137, 80, 78, 71] };
    model.update(
      applyMarkers(new Map(), [{ ...wall, type: 11, points: [], texture, scale: { x: 0.4, y: 0.2, z: 1 } }]),
    );
    const [{ mesh }] = [...model.meshes.values()];
    mesh.geometry.computeBoundingBox();
    const { min, max } = /** @type {any} */ (mesh.geometry.boundingBox);
    assert.deepEqual(
      [max.x - min.x, max.y - min.y, max.z - min.z].map((size) => size.toFixed(3)),
      ["0.400", "0.200", "0.000"],
    );
    assert.equal(mesh.material.visible, false);
  });
  assert.deepEqual([...new Uint8Array(await decoded[0].arrayBuffer())], [137, 80, 78, 71]);
});
