// Builds playgrounds by chance through the creator, and prints each as JSON with whether the page would open it:
// `node build_random.js COUNT`. Both kinds come out: built ones, and ones with robots dropped anywhere.

import { CreatorModel } from "../../web_ui/creator/creator_model.js";
import { newPlayground } from "../../web_ui/creator/commands.js";
import { parse, write } from "../../web_ui/playground/document.js";
import { shapeKinds } from "../../web_ui/playground/kinds/index.js";

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

function built() {
  const model = new CreatorModel({ playground: newPlayground("By chance"), report: () => {}, changed: () => {} });
  for (let step = 0; step < 25; step++) {
    const kind = TOOLS[Math.floor(chance() * TOOLS.length)];
    model.choose(kind, kind === "picture" ? { image: PIXEL } : {});
    for (let point = 0; point < 4; point++) {
      model.placing?.turn(Math.round(somewhere(12)) * (Math.PI / 12));
      model.placing?.hover([somewhere(0.6), somewhere(0.6)], chance() < 0.5);
      model.placing?.put();
    }
    model.placing?.finish(chance() < 0.5);
    model.choose(null);
    model.selectNext(1 + Math.floor(chance() * 5));
    model.nudge(Math.round(somewhere(3)), Math.round(somewhere(3)), { fine: chance() < 0.5 });
    model.turn(Math.round(somewhere(4)));
    model.edit({ height_m: chance() * 0.2, radius_m: chance() * 0.1, mass_kg: chance() });
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

/** @param {string} text */
function opens(text) {
  try {
    parse(text);
    return true;
  } catch {
    return false;
  }
}

const cases = Array.from({ length: Number(process.argv[2]) }, () => {
  const text = built();
  return [
    { text, opens: opens(text) },
    ...[1, 2, 3].map(() => crowded(text)).map((other) => ({ text: other, opens: opens(other) })),
  ];
}).flat();
process.stdout.write(JSON.stringify(cases));
