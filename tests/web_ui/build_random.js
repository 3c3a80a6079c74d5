// Builds playgrounds by chance through the creator, and prints each as a line of JSON with whether the page finds no problem
// in it: `node build_random.js COUNT`. Both kinds come out: built ones, and ones with robots dropped anywhere. What a
// simulator draws of shapes is asked for by a line {"ask": shapes}, and read from standard input.

import { readSync, writeSync } from "node:fs";

import { CreatorModel } from "../../web_ui/creator/creator_model.js";
import { newPlayground } from "../../web_ui/creator/commands.js";
import { parse, write } from "../../web_ui/playground/document.js";
import { shapeKinds } from "../../web_ui/playground/kinds/index.js";
import { learnParts } from "../../web_ui/playground/parts.js";
import { itemsOffGround, problemsIn } from "../../web_ui/playground/validation.js";

const PIXEL =
  "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
/** In this order, on which the random playgrounds depend. */
const FIRST = ["rectangle", "octagon", "picture", "track", "box", "cylinder", "wall", "u_figure", "door", "activation"];
const TOOLS = [...FIRST, ...shapeKinds().flatMap(({ name }) => (FIRST.includes(name) ? [] : [name])), "robot"];
let seed = 1;

/** A number from 0 to 1, the same in every run. */
function chance() {
  seed = (seed * 48271) % 2147483647;
  return seed / 2147483647;
}

/** @param {number} reach */
const somewhere = (reach) => (chance() * 2 - 1) * reach;

/** @param {object} data */
const print = (data) => writeSync(1, `${JSON.stringify(data)}\n`);

/** The answer of the simulator at the other end. @param {string} shapes */
async function ask(shapes) {
  print({ ask: shapes });
  const [piece, pieces] = [Buffer.alloc(65536), /** @type {Buffer[]} */ ([])];
  while (pieces.at(-1)?.at(-1) !== 10) pieces.push(Buffer.from(piece.subarray(0, readSync(0, piece))));
  return Buffer.concat(pieces).toString();
}

/** Whether the page finds nothing wrong. @param {readonly import("../../web_ui/playground/parts.js").Item[]} items */
async function isFine(items) {
  await learnParts(items, ask);
  return problemsIn(items).length === 0;
}

/** Undo what the simulator would not accept, or not without a note. @param {CreatorModel} model */
async function settle(model) {
  while (!(await isFine(model.playground.items)) || itemsOffGround(model.playground.items).length > 0) model.undo();
}

async function built() {
  const model = new CreatorModel({ playground: newPlayground("By chance"), report: () => {}, changed: () => {} });
  for (let step = 0; step < 25; step++) {
    const kind = TOOLS[Math.floor(chance() * TOOLS.length)];
    model.choose(kind, kind === "picture" ? { image: PIXEL } : {});
    for (let point = 0; point < 4; point++) {
      model.placing?.turn(Math.round(somewhere(12)) * (Math.PI / 12));
      model.placing?.hover([somewhere(0.6), somewhere(0.6)], chance() < 0.5);
      await learnParts(model.ghost === null ? [] : [model.ghost.item], ask);
      model.placing?.put();
    }
    model.placing?.finish(chance() < 0.5);
    model.choose(null);
    await settle(model);
    model.selectNext(1 + Math.floor(chance() * 5));
    model.nudge(Math.round(somewhere(3)), Math.round(somewhere(3)), { fine: chance() < 0.5 });
    model.turn(Math.round(somewhere(4)));
    model.edit({ height_m: chance() * 0.2, radius_m: chance() * 0.1, mass_kg: chance() });
    await settle(model);
    if (chance() < 0.3) model.selecting.duplicate();
    if (chance() < 0.1) model.selecting.remove();
    if (chance() < 0.2) model.undo();
  }
  return write(model.playground);
}

/** With one more robot anywhere, perhaps in the way of something. @param {string} text */
function crowded(text) {
  const data = JSON.parse(text);
  data.robots.push({ name: "intruder", x_m: somewhere(0.55), y_m: somewhere(0.55), yaw_rad: somewhere(3) });
  return JSON.stringify(data);
}

for (let count = Number(process.argv[2]); count > 0; count--) {
  const text = await built();
  for (const one of [text, crowded(text), crowded(text), crowded(text)]) {
    print({ text: one, isFine: await isFine(parse(one).items) });
  }
}
