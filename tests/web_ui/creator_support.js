// Helpers of the creator's tests.

import { CreatorModel } from "../../web_ui/creator/creator_model.js";
import { newPlayground } from "../../web_ui/creator/commands.js";
import { CreatorSession } from "../../web_ui/creator/creator_session.js";
import { Drafts } from "../../web_ui/playground_tab/drafts.js";
import { parse } from "../../web_ui/playground/document.js";
import { newStorage } from "./support.js";

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
  const one = new CreatorSession({ drafts, title: "Mine", report: ({ word }) => void reported.push(word), changed: () => {} });
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
