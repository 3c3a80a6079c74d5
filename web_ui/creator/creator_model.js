// The state of the creator: the playground with its history, the selection, the item being placed, and all operations.
// No DOM and no 3D scene: pointer and keys call it; it reports what to draw and what to announce.

import { isOnGround, findProblem } from "../playground/validation.js";
import * as commands from "./commands.js";
import { History } from "./history.js";
import { middleOf } from "./place.js";
import { Placing } from "./placing.js";
import { Selecting } from "./selecting.js";
import { centimeters } from "./snap.js";

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {import("../playground/geometry.js").Point} Point */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {import("./pick.js").Ray} Ray */
/** @typedef {{ item: Item, problem: Phrase | null }} Ghost */

const TURN = Math.PI / 12;
const FINE_TURN = Math.PI / 180;
const FINE_M = 0.001;

export class CreatorModel {
  /**
   * @param {object} options
   * @param {Playground} options.playground
   * @param {(phrase: Phrase) => void} options.report   announces a message, also to screen readers
   * @param {() => void} options.changed
   */
  constructor({ playground, report, changed: onChange }) {
    this.history = new History(playground);
    this.report = report;
    this.onChange = onChange;
    /** @type {string | null} name of the selected item */ this.selected = null;
    /** @type {import("./snap.js").Grid} */ this.grid = { size: 0.05, on: "lines", isOff: false };
    /** Whether pointer and wheel move the camera. */
    this.cameraOn = true;
    /** Size of one pixel on the ground, in meters. */
    this.pixel = 0.001;
    /** @type {Point | null} position of the pointer on the ground */ this.pointer = null;
    this.selecting = new Selecting(this);
    /** @type {Placing | null} placing of new items; null while selecting */ this.placing = null;
  }

  get playground() {
    return this.history.present;
  }

  /** @returns {Item | null} */
  get item() {
    return commands.itemNamed(this.playground, this.selected);
  }

  /** The item being placed or dragged, at its current position. @returns {Ghost | null} */
  get ghost() {
    return this.placing?.ghost ?? this.selecting.ghost;
  }

  /** The grid in effect; null while it is ignored. @param {boolean} free @returns {import("./snap.js").Grid | null} */
  gridFor(free) {
    return free || this.grid.isOff ? null : this.grid;
  }

  /**
   * Start placing items of a kind; null ends placing.
   *
   * @param {string | null} kind
   * @param {Record<string, any>} [values]
   */
  choose(kind, values = {}) {
    this.selecting.cancel();
    if (kind === null) this.placing = null;
    else {
      if (kind === "activation" && !this.playground.items.some((item) => item.kind === "door")) {
        return this.report({ word: "problem.noDoor" });
      }
      this.selected = null;
      this.placing = new Placing(this, kind, values);
      this.report({ word: this.placing.isPath ? "status.path" : "status.placing", values: { kind } });
    }
    this.changed();
  }

  /** @param {string | null} name */
  select(name) {
    if (name === this.selected && this.placing === null) return;
    this.selecting.cancel();
    this.placing = null;
    this.selected = name;
    if (this.item !== null) this.reportPlace(this.item);
    this.changed();
  }

  /** Select the next item in file order. @param {number} by */
  selectNext(by) {
    const { items } = this.playground;
    if (items.length === 0) return;
    const now = items.findIndex(({ name }) => name === this.selected);
    const next = now < 0 ? (by > 0 ? 0 : items.length - 1) : (now + by + items.length) % items.length;
    this.select(items[next].name);
  }

  /**
   * Why an item cannot replace the named one; null if it can. Items outside the ground are accepted when a file is
   * opened, but cannot be placed there.
   *
   * @param {Item} item
   * @param {string} name
   * @returns {Phrase | null}
   */
  problemOf(item, name) {
    const others = commands.othersOf(this.playground, name);
    if (item.name !== name && others.some((other) => other.name === item.name)) {
      return { word: "problem.name", values: { name: item.name } };
    }
    return findProblem(others, item) ?? (isOnGround(others, item) ? null : { word: "problem.outside" });
  }

  /**
   * Replace the playground and record the step in the history.
   *
   * @param {Playground} next
   * @param {Phrase} change
   * @param {string} [series]
   */
  do(next, change, series) {
    this.history.do(next, change, series);
    if (this.item === null) this.selected = null;
    this.changed();
  }

  /**
   * Change values of the item being placed, else of the selected item; returns the problem, or null.
   *
   * @param {Record<string, any>} values
   * @returns {Phrase | null}
   */
  edit(values) {
    return (this.placing ?? this.selecting).edit(values);
  }

  /**
   * Move by keys, in grid steps.
   *
   * @param {number} x
   * @param {number} y
   * @param {{ far?: boolean, fine?: boolean }} [how]
   */
  nudge(x, y, { far = false, fine = false } = {}) {
    const step = fine ? FINE_M : this.grid.size * (far ? 5 : 1);
    (this.placing ?? this.selecting).nudge(x * step, y * step);
  }

  /** Turn the item being placed or selected, counter-clockwise. @param {number} steps @param {boolean} [fine] */
  turn(steps, fine = false) {
    (this.placing ?? this.selecting).turn(steps * (fine ? FINE_TURN : TURN));
  }

  /** @param {Item} item @param {Phrase | null} [problem] */
  reportPlace(item, problem = null) {
    const [x, y] = middleOf(item);
    const degrees = Math.round(((item.yaw_rad ?? 0) * 180) / Math.PI);
    this.report(
      problem ?? { word: "status.at", values: { kind: item.kind, x: centimeters(x), y: centimeters(y), degrees } },
    );
  }

  /**
   * Replace the whole playground: title, ground, or another file. Returns null: it is always accepted.
   *
   * @param {Playground} next
   * @param {Phrase} change
   */
  replacePlayground(next, change) {
    this.selecting.cancel();
    this.do(next, change);
    return null;
  }

  undo() {
    if (this.placing?.undoPoint()) return;
    this.selecting.cancel();
    this.#reportStep("status.undone", this.history.undo());
  }

  redo() {
    if (this.placing?.redoPoint()) return;
    this.selecting.cancel();
    this.#reportStep("status.redone", this.history.redo());
  }

  /** @param {string} word @param {Phrase | null} change */
  #reportStep(word, change) {
    if (change === null) return this.report({ word: "status.nothing" });
    if (this.item === null) this.selected = null;
    this.placing?.refresh();
    this.report({ word, values: { change: change.word, ...change.values } });
    this.changed();
  }

  /** Escape: cancel placing or dragging, else clear the selection; returns whether anything changed. */
  cancel() {
    if (this.selecting.ghost !== null) this.selecting.cancel();
    else if (this.placing !== null) {
      this.placing = null;
      this.report({ word: "status.cancelled" });
    } else if (this.selected !== null) this.selected = null;
    else return false;
    this.changed();
    return true;
  }

  toggleCamera() {
    this.cameraOn = !this.cameraOn;
    this.report({ word: this.cameraOn ? "status.cameraOn" : "status.cameraOff" });
    this.changed();
  }

  /** @param {Partial<import("./snap.js").Grid>} grid */
  setGrid(grid) {
    this.grid = { ...this.grid, ...grid };
    this.changed();
  }

  changed() {
    this.onChange();
  }
}
