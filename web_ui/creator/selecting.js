// Selecting existing items: drag them, turn them by the ring, move their points; edit, copy, restack and remove them. A
// dragged item is shown as a ghost until it is released.

import { atHeight } from "../move/placed_bodies.js";
import { kindNamed } from "../playground/kinds/index.js";
import { valuesOf } from "../playground/parts.js";
import { findProblem, isOnGround } from "../playground/validation.js";
import { added, copyOf, othersOf, raised, removed, replaced } from "./commands.js";
import { handleAt, hasKnob, itemAt } from "./pick.js";
import { canTurn, changed, middleOf, moved, movedTo, pointsOf, turned, withPoint } from "./place.js";
import { snapped } from "./snap.js";

/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {import("../playground/geometry.js").Point} Point */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {import("./pick.js").Ray} Ray */
/** @typedef {import("./pick.js").Handle} Handle */

const TURN_STEP = Math.PI / 12;

export class Selecting {
  /** @param {import("./creator_model.js").CreatorModel} model */
  constructor(model) {
    this.model = model;
    /** @type {{ item: Item, handle: Handle, from: Point, z: number } | null} */ this.grabbed = null;
    /** @type {Item | null} the dragged item at its current position */ this.moving = null;
  }

  /** @returns {import("./creator_model.js").Ghost | null} */
  get ghost() {
    return this.moving === null ? null : { item: this.moving, problem: this.model.problemOf(this.moving, this.moving.name) };
  }

  /** Pointer down; returns whether something was grabbed. @param {Ray} ray */
  grab(ray) {
    const { model } = this;
    const ground = pointOn(ray, 0);
    if (ground === null) return false;
    const { item } = model;
    const handle = item === null ? null : handleAt(item, ray, model.pixel);
    if (item !== null && handle !== null) {
      this.grabbed = { item, handle, from: ground, z: 0 };
      return true;
    }
    const found = itemAt(model.playground.items, ray);
    if (found === null || hasKnob(found)) return false; // drags on the ground move the camera; a click selects it
    model.select(found.name);
    const z = heightOf(found) / 2;
    this.grabbed = { item: found, handle: { type: "middle" }, from: pointOn(ray, z) ?? ground, z };
    return true;
  }

  /** Click on something that cannot be dragged: select what is there, or nothing. @param {Ray} ray */
  click(ray) {
    this.model.select(itemAt(this.model.playground.items, ray)?.name ?? null);
  }

  /** @param {Ray} ray @param {boolean} free  whether the grid is ignored */
  drag(ray, free) {
    const { model, grabbed } = this;
    if (grabbed === null) return;
    const place = pointOn(ray, grabbed.z);
    if (place === null) return;
    const item = dragged(grabbed, place, model.gridFor(free));
    this.moving = item === grabbed.item ? null : item;
    model.changed();
  }

  /** Pointer up: apply the change, or restore the item if the position is invalid. */
  drop() {
    const { model, ghost, grabbed } = this;
    this.cancel();
    if (ghost === null || grabbed === null) return;
    if (ghost.problem !== null) return model.report(ghost.problem);
    const word =
      grabbed.handle.type === "ring" ? "change.turned" : grabbed.handle.type === "point" ? "change.changed" : "change.moved";
    model.do(replaced(model.playground, ghost.item.name, ghost.item), { word, values: { name: ghost.item.name } });
    model.reportPlace(ghost.item);
  }

  /**
   * Change values of the selected item; returns the problem, or null.
   *
   * @param {Record<string, any>} values
   * @returns {Phrase | null}
   */
  edit(values) {
    const { model } = this;
    const { item } = model;
    if (item === null) return null;
    const next = changed(item, values);
    const problem = model.problemOf(next, item.name);
    const others = othersOf(model.playground, item.name);
    const wasOutside = !isOnGround(others, item); // there it may be changed
    if (problem !== null && !(problem.word === "problem.outside" && wasOutside)) return problem;
    model.selected = next.name;
    model.do(replaced(model.playground, item.name, next), { word: "change.changed", values: { name: next.name } });
    return null;
  }

  /** Move the selected item. @param {number} dx @param {number} dy */
  nudge(dx, dy) {
    const { item } = this.model;
    if (item !== null) this.#replace(item, moved(item, dx, dy), "moved");
  }

  /** Turn the selected item, counter-clockwise. @param {number} angle */
  turn(angle) {
    const { item } = this.model;
    if (item !== null && canTurn(item)) this.#replace(item, turned(item, angle), "turned");
  }

  remove() {
    const { model } = this;
    const { item } = model;
    if (item === null) return;
    const change = { word: "change.removed", values: { name: item.name } };
    model.do(removed(model.playground, item.name), change);
    model.report(change);
  }

  /** Duplicate the selected item and select the copy; it is placed farther away if the position is occupied. */
  duplicate() {
    const { model } = this;
    const { item } = model;
    if (item === null) return;
    let copy = copyOf(model.playground, item);
    const { items } = model.playground;
    for (let far = 1; far < 8 && findProblem(items, copy) !== null; far++) copy = moved(copy, 0.05, -0.05);
    const problem = findProblem(items, copy);
    if (problem !== null) return model.report(problem);
    model.selected = copy.name;
    const change = { word: "change.copied", values: { name: copy.name } };
    model.do(added(model.playground, copy), change);
    model.report(change);
  }

  /** Bring the selected item forward or send it backward. @param {number} by */
  raise(by) {
    const { model } = this;
    const { item } = model;
    if (item === null) return;
    const change = { word: "change.raised", values: { name: item.name } };
    const next = raised(model.playground, item.name, by);
    if (next === model.playground) return;
    model.do(next, change);
    model.report(change);
  }

  /**
   * Replace an item if its new position is free. Consecutive steps of one kind count as one.
   *
   * @param {Item} item
   * @param {Item} next
   * @param {"moved" | "turned"} step
   */
  #replace(item, next, step) {
    const { model } = this;
    const problem = model.problemOf(next, item.name);
    if (problem !== null) return model.report(problem);
    const change = { word: `change.${step}`, values: { name: item.name } };
    model.do(replaced(model.playground, item.name, next), change, `${step} ${item.name}`);
    model.reportPlace(next);
  }

  cancel() {
    this.grabbed = null;
    this.moving = null;
    this.model.changed();
  }
}

/**
 * @param {NonNullable<Selecting["grabbed"]>} grabbed
 * @param {Point} place
 * @param {import("./snap.js").Grid | null} grid
 */
function dragged({ item, handle, from }, place, grid) {
  const [x, y] = middleOf(item);
  if (handle.type === "ring") {
    const turn = Math.atan2(place[1] - y, place[0] - x) - Math.atan2(from[1] - y, from[0] - x);
    return turned(item, grid === null ? turn : Math.round(turn / TURN_STEP) * TURN_STEP);
  }
  const [dx, dy] = [place[0] - from[0], place[1] - from[1]];
  if (handle.type === "point") {
    const [px, py] = pointsOf(item)[handle.index];
    return withPoint(item, handle.index, snapped([px + dx, py + dy], grid));
  }
  if (Math.hypot(dx, dy) < 1e-4) return item;
  if (kindNamed(item.kind)?.placement === "center") return movedTo(item, snapped([x + dx, y + dy], grid));
  const [[firstX, firstY]] = pointsOf(item); // a path keeps its first point on the grid, not its center
  const [toX, toY] = snapped([firstX + dx, firstY + dy], grid);
  return movedTo(item, [x + toX - firstX, y + toY - firstY]);
}

/** @param {Ray} ray @param {number} z @returns {Point | null} */
function pointOn(ray, z) {
  const place = atHeight(ray, z);
  return place === null ? null : [place.x, place.y];
}

/** @param {Item} item */
function heightOf(item) {
  return item.kind === "robot" ? 0.05 : (valuesOf(item).height_m ?? 0);
}
