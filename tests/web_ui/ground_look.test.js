import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { parse } from "../../web_ui/playground/document.js";
import { Markers } from "../../web_ui/playground/markers.js";
import { learnParts } from "../../web_ui/playground/parts.js";
import { groundColor, wallColor } from "../../web_ui/scene/colors.js";
import { groundOf } from "../../web_ui/scene/ground_of.js";
import { PlaygroundModel } from "../../web_ui/scene/playground.js";
import { recorded } from "./creator_support.js";

const FOLDER = new URL("../../playgrounds/", import.meta.url);
const SHIPPED = readdirSync(FOLDER).filter((name) => name.endsWith(".json") && !name.includes("schema"));

/** @param {string} name */
const itemsOf = (name) =>
  parse(readFileSync(new URL(name, FOLDER), "utf8").replace("line_gradient.svg", "data:image/svg+xml;base64,")).items;

/** @param {string} name */
const markersOf = (name) => new Markers(() => null).of(itemsOf(name));

/** Lightness of a gray floor as drawn. @param {number} gray */
function drawn(gray) {
  const { r, g, b } = groundColor({ r: gray, g: gray, b: gray });
  return (r + g + b) / 3;
}

test("the darker a place is for the ground sensors, the darker it is drawn", () => {
  const grays = Array.from({ length: 101 }, (_, step) => drawn(step / 100));
  grays.slice(1).forEach((gray, index) => assert.ok(gray > grays[index]));
  assert.ok(grays[0] < 0.16 && grays[100] > 0.9);
});

test("colors keep their hue", () => {
  const red = groundColor({ r: 1, g: 0, b: 0 });
  assert.ok(red.r > 0.9 && red.g < 0.2 && red.b < 0.2);
});

test("a gray wall is cardboard, a colored one has its color", () => {
  for (const gray of [0, 0.4, 1]) {
    const { r, g, b } = wallColor({ r: gray, g: gray, b: gray });
    assert.ok(r > g && g > b);
  }
  assert.deepEqual(wallColor({ r: 0, g: 0.5, b: 1 }).toArray(), [0, 0.5, 1]);
});

for (const name of SHIPPED) {
  test(`${name}: floors and paint are drawn with the outlines that the sensors see`, () => {
    const markers = markersOf(name);
    const model = new PlaygroundModel(undefined, undefined, { isStill: true });
    model.update(markers);
    for (const [key, { points, pose, scale, ns }] of markers) {
      if (ns.startsWith("solid/") || points.length === 0) continue;
      const mesh = model.meshes.get(key)?.mesh;
      assert.ok(mesh !== undefined);
      assert.deepEqual([mesh.position.x, mesh.position.y], [pose.position.x, pose.position.y]);
      const { position } = mesh.geometry.attributes;
      assert.equal(position.count, points.length);
      points.forEach(({ x, y }, at) => {
        assert.ok(Math.abs(position.getX(at) - x * scale.x) < 1e-6 && Math.abs(position.getY(at) - y * scale.y) < 1e-6);
      });
    }
  });

  test(`${name}: paint covers the floor, and later paint covers earlier`, () => {
    const model = new PlaygroundModel();
    model.update(markersOf(name));
    const ground = [...model.meshes.values()].filter(({ marker }) => !marker.ns.startsWith("solid/"));
    const byHeight = ground.sort((one, other) => one.marker.pose.position.z - other.marker.pose.position.z);
    byHeight.slice(1).forEach(({ mesh }, index) => assert.ok(mesh.renderOrder >= byHeight[index].mesh.renderOrder));
    for (const { mesh, marker } of ground) {
      assert.equal(mesh.material.depthWrite, marker.ns.startsWith("floor/"));
      assert.ok(mesh.position.z < 0.0025, "shadows lie above all of it");
    }
  });
}

test("a table has a border on all sides, the desk playground has walls", async () => {
  const table = groundOf(markersOf("table.json").values());
  assert.ok(table !== null && !table.isWalled);
  const around = table.edges.reduce((sum, [[x, y], [toX, toY]]) => sum + Math.hypot(toX - x, toY - y), 0);
  const { min, max } = table.bounds;
  assert.ok(Math.abs(around - 2 * (max.x - min.x + max.y - min.y)) < 1e-6);
  await learnParts(itemsOf("desk.json").slice(0, 1), recorded);
  const walled = [...markersOf("desk.json").values()];
  assert.equal(groundOf(walled)?.isWalled, true);
  const called = walled.map((marker) => (marker.ns.startsWith("solid/") ? { ...marker, ns: "solid/any name" } : marker));
  assert.equal(groundOf(called)?.isWalled, true, "walls are known by where they stand");
  const north = Math.max(...called.map(({ pose }) => pose.position.y));
  const gap = called.filter(({ pose }) => pose.position.y !== north);
  assert.equal(groundOf(gap)?.isWalled, false);
  assert.equal(groundOf([]), null);
});
