// Helpers of the creator's tests.

import { readFileSync } from "node:fs";

import { CreatorModel } from "../../web_ui/creator/creator_model.js";
import { newPlayground } from "../../web_ui/creator/commands.js";
import { CreatorSession } from "../../web_ui/creator/creator_session.js";
import { Drafts } from "../../web_ui/playground_tab/drafts.js";
import { parse } from "../../web_ui/playground/document.js";
import { learnParts } from "../../web_ui/playground/parts.js";
import { newStorage } from "./support.js";

/** Shapes and what the simulator has answered to them (tests/test_plugin_page.py). @type {{ shape: any, drawing: any }[]} */
const RECORDS = JSON.parse(readFileSync(new URL("../data/web/drawings.json", import.meta.url), "utf8"));
const DRAWINGS = new Map(RECORDS.map(({ shape, drawing }) => [JSON.stringify(shape), drawing]));

/** The simulator's service: the drawings of recorded shapes. @param {string} shapes */
export async function recorded(shapes) {
  const requests = JSON.parse(shapes).map((/** @type {any} */ shape) => JSON.stringify(shape));
  const missing = requests.filter((/** @type {string} */ request) => !DRAWINGS.has(request));
  if (missing.length > 0) throw new Error(`tests/data/web/drawings.json has no ${missing.join("\n")}`);
  return JSON.stringify(requests.map((/** @type {string} */ request) => DRAWINGS.get(request)));
}

await learnParts(newPlayground("Mine").items, recorded);

/** Straight down. @param {number} x @param {number} y */
export const down = (x, y) => ({ origin: { x, y, z: 1 }, direction: { x: 0, y: 0, z: -1 } });

/** A model on a new playground, with what it reported. */
export function prepared() {
  /** @type {import("../../web_ui/playground/rules.js").Phrase[]} */ const reported = [];
  const model = new CreatorModel({
    playground: newPlayground("Mine"),
    report: (phrase) => reported.push(phrase),
    changed: () => {},
  });
  /** @param {number} x @param {number} y @param {boolean} [free] */
  const click = (x, y, free = false) => {
    model.placing?.hover([x, y], free);
    model.placing?.put();
  };
  const names = () => model.playground.items.map(({ name }) => name);
  /** @param {string} name */
  const item = (name) => model.playground.items.find((one) => one.name === name);
  return { model, reported, click, names, item };
}

export function session(storage = newStorage()) {
  /** @type {string[]} */ const reported = [];
  const drafts = new Drafts(storage);
  const one = new CreatorSession({ drafts, title: "Mine", report: ({ word }) => void reported.push(word), changed: () => {}, learn: (items) => learnParts(items, recorded) });
  const again = () => {
    const next = session(storage);
    const [draft] = next.drafts.list();
    if (draft === undefined) return next;
    const playground = { ...parse(next.drafts.read(draft.id) ?? ""), draft: draft.id };
    next.one.replacePlayground(playground, { word: "change.opened" }, draft.inFile);
    return next;
  };
  return { one, drafts, reported, storage, again };
}

/** @param {CreatorSession} one @param {string} title */
export function titled(one, title) {
  one.model.replacePlayground({ ...one.model.playground, title }, { word: "change.titled" });
}
