// Placing new items: the item follows pointer or keys, is placed repeatedly, and Escape ends it.

import { kindNamed } from "../playground/kinds/index.js";
import { distance } from "../playground/geometry.js";
import { added, freeName, groundOf } from "./commands.js";
import { canTurn, changed, middleOf, movedTo, turned } from "./place.js";
import { centimeters, rounded, snapped } from "./snap.js";

/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {import("../playground/geometry.js").Point} Point */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */

/** Points nearer than this count as the same; without a grid the tolerance is in pixels. */
const SAME_M = 0.0005;
const SAME_PX = 8;
const ASIDE_M = 0.15;

export class Placing {
  /**
   * @param {import("./creator_model.js").CreatorModel} model
   * @param {string} kind
   * @param {Record<string, any>} values
   */
  constructor(model, kind, values) {
    this.model = model;
    this.kind = kind;
    const { sample = {}, placement = "center" } = kindNamed(kind) ?? {};
    /** Whether the item needs several points. */
    this.isPath = placement !== "center";
    const { playground } = model;
    const ground = groundOf(playground);
    /** @type {Point} current position */
    this.place = snapped(ground === null ? [0, 0] : middleOf(ground), model.gridFor(false));
    /** Tolerance for the same point, in meters. */
    this.same = SAME_M;
    /** @type {Point[]} points of the path so far */ this.points = [];
    /** @type {Point[]} removed points, for redo */ this.undonePoints = [];
    /** @type {Item} values of the next item; its position is ignored */
    this.pattern = Object.freeze({
      kind,
      ...sample,
      ...this.#own(kind),
      ...values,
      name: this.#name(),
    });
    if (!this.isPath) this.#makeRoom();
  }

  /** Avoid starting on top of a robot. */
  #makeRoom() {
    const [x, y] = this.place;
    const places = [0, 1, 2, 3].flatMap((far) =>
      [1, -1].map((side) => snapped([x + side * far * ASIDE_M, y], this.model.gridFor(false))),
    );
    const free = places.find((place) => {
      this.place = place;
      return this.ghost?.problem === null;
    });
    this.place = free ?? places[0];
  }

  /** The key of the points of a path of any length; undefined for other items. */
  get pathKey() {
    const kind = kindNamed(this.kind);
    return kind?.placement === "path" ? kind.path : undefined;
  }

  /**
   * The item at its current position; null for a path without a first point.
   *
   * @returns {import("./creator_model.js").Ghost | null}
   */
  get ghost() {
    const item = this.isPath ? this.#pathTo(this.place) : movedTo(this.#whole(), this.place);
    return item === null ? null : { item, problem: this.model.problemOf(item, item.name) };
  }

  /** Move to a pointer position. @param {Point} place @param {boolean} free  of the grid */
  hover(place, free) {
    this.place = snapped(place, this.model.gridFor(free));
    this.same = free ? SAME_PX * this.model.pixel : SAME_M;
  }

  /** Place the item, or one point of it. */
  put() {
    const { model } = this;
    if (this.isPath) return this.#putPoint();
    const { ghost } = this;
    if (ghost === null) return;
    if (ghost.problem !== null) return model.report(ghost.problem);
    this.#add(ghost.item);
  }

  /** Complete the path. @param {boolean} [closed] */
  finish(closed = false) {
    if (this.pathKey === undefined) return;
    if (this.points.length < 2) return this.model.report({ word: "problem.twoPoints" });
    const item = changed(this.pattern, { [this.pathKey]: this.points, ...(closed ? { closed: true } : {}) });
    const problem = this.model.problemOf(item, item.name);
    if (problem !== null) return this.model.report(problem);
    this.points = [];
    this.#add(item);
  }

  /** Remove the last point; returns whether there was one. */
  undoPoint() {
    const point = this.points.pop();
    if (point === undefined) return false;
    this.undonePoints.push(point);
    this.model.report({ word: "status.pointBack", values: { count: this.points.length } });
    this.model.changed();
    return true;
  }

  /** @returns {boolean} */
  redoPoint() {
    const point = this.undonePoints.pop();
    if (point === undefined) return false;
    this.points.push(point);
    this.model.changed();
    return true;
  }

  /** @param {number} dx @param {number} dy */
  nudge(dx, dy) {
    this.same = SAME_M;
    this.place = snapped([this.place[0] + dx, this.place[1] + dy], null);
    const { ghost, model } = this;
    if (ghost !== null && !this.isPath) model.reportPlace(ghost.item, ghost.problem);
    else {
      const [x, y] = this.place.map(centimeters);
      model.report(ghost?.problem ?? { word: "status.place", values: { kind: this.kind, x, y } });
    }
    model.changed();
  }

  /** @param {number} angle */
  turn(angle) {
    if (this.isPath || !canTurn(this.pattern)) return;
    this.pattern = turned(this.#whole(), angle);
    this.model.reportPlace(movedTo(this.pattern, this.place), this.ghost?.problem);
    this.model.changed();
  }

  /**
   * Change values of the items to come; returns the problem, or null.
   *
   * @param {Record<string, any>} values
   * @returns {Phrase | null}
   */
  edit(values) {
    const { model } = this;
    const next = changed(this.pattern, values);
    if (this.isPath) this.pattern = next;
    else {
      const item =
        "x_m" in values || "y_m" in values
          ? movedTo({ ...this.#whole(), ...next }, middleOf({ ...this.#whole(), ...values }))
          : movedTo({ ...this.#whole(), ...next }, this.place);
      const problem = model.problemOf(item, item.name);
      if (problem?.word === "problem.value") return problem;
      this.pattern = next;
      this.place = middleOf(item);
    }
    model.changed();
    return null;
  }

  /** Update the name after the playground has changed. */
  refresh() {
    this.pattern = changed(this.pattern, { name: this.#name() });
  }

  #putPoint() {
    const { model, points, place } = this;
    const last = points.at(-1);
    if (last !== undefined && distance(last, place) < this.same) return this.finish();
    if (this.#canClose && points.length > 2 && distance(points[0], place) < this.same) return this.finish(true);
    const item = this.#pathTo(place);
    const problem = item === null ? null : model.problemOf(item, item.name);
    if (problem !== null) return model.report(problem);
    if (this.pathKey === undefined && item !== null) {
      this.points = [place]; // the next wall starts where this one ends
      return this.#add(item);
    }
    points.push(place);
    this.undonePoints = [];
    model.report({ word: "status.point", values: { count: points.length } });
    model.changed();
  }

  /** Whether a click on the first point closes the path. */
  get #canClose() {
    return this.pathKey !== undefined && kindNamed(this.kind)?.fields.closed?.type === "flag";
  }

  /**
   * The path with an additional last point; null while there are too few points.
   *
   * @param {Point} place
   * @returns {Item | null}
   */
  #pathTo(place) {
    const last = this.points.at(-1);
    if (last === undefined) return null;
    const all = distance(last, place) < SAME_M ? this.points : [...this.points, place];
    if (all.length < 2) return null;
    if (this.pathKey !== undefined) return changed(this.pattern, { [this.pathKey]: all });
    return changed(this.pattern, { start_x_m: last[0], start_y_m: last[1], end_x_m: place[0], end_y_m: place[1] });
  }

  /** @param {Item} item */
  #add(item) {
    const { model } = this;
    const change = { word: "change.added", values: { name: item.name } };
    model.do(added(model.playground, item), change);
    this.undonePoints = [];
    this.refresh();
    model.report(change);
  }

  /** The pattern with coordinates, which some functions need. */
  #whole() {
    const points = kindNamed(this.kind)?.points ?? [];
    const [first] = points;
    const zero = first === undefined ? {} : { [first[0]]: 0, [first[1]]: 0 };
    return /** @type {Item} */ ({ ...zero, ...this.pattern });
  }

  #name() {
    return freeName(this.model.playground, this.kind === "robot" ? "thymio" : this.kind);
  }

  /**
   * Defaults from the playground: the width of an image, the last door for a plate.
   *
   * @param {string} kind
   * @returns {Record<string, any>}
   */
  #own(kind) {
    const { playground } = this.model;
    const ground = groundOf(playground);
    if (kind === "picture" && ground !== null) {
      const size = ground.size_x_m ?? rounded((ground.side_m ?? 0) * (1 + Math.SQRT2));
      return size > 0 ? { size_x_m: size } : {};
    }
    const door = [...playground.items].reverse().find((item) => item.kind === "door");
    return kind === "activation" && door !== undefined ? { door: door.name } : {};
  }
}
