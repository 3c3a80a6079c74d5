// Subroutines of a workspace: each is defined once and before those that call it; a circle of calls is an error.

import { DEFINITIONS, subroutineName } from "./blocks/variables.js";
import { indented } from "./lines.js";
import { isDisabled } from "./state.js";

/** @typedef {import("./state.js").BlockState} BlockState */
/** @typedef {import("./blocks/spec.js").Line} Line */
/** @typedef {{ block: BlockState, lines: Line[], calls: Set<string> }} Definition */

export class Subroutines {
  /** @param {import("./generator.js").Generator} generator */
  constructor(generator) {
    this.generator = generator;
    /** Key of the name → definition, in the order of the workspace. @type {Map<string, Definition>} */
    this.definitions = new Map();
    /** Further subroutines, which no block defines. @type {Line[][]} */ this.others = [];
    /** The definition that is being generated. @type {Definition | null} */ this.current = null;
  }

  /** Note that a block defines a subroutine. @param {BlockState} block */
  declare(block) {
    if (!DEFINITIONS.includes(block.type) || isDisabled(block)) return;
    const key = keyOf(block);
    if (this.definitions.has(key)) {
      this.generator.report("error", "subroutineTwice", block, { name: subroutineName(block) });
    } else this.definitions.set(key, { block, lines: [], calls: new Set() });
  }

  /** Generate its statements. @param {BlockState} block */
  define(block) {
    const { generator } = this;
    const definition = this.definitions.get(keyOf(block));
    if (definition === undefined || definition.block !== block) return;
    if ((block.extraState?.params ?? []).length > 0) generator.report("error", "parameters", block);
    this.current = definition;
    const head = generator.line(block, `sub ${generator.names.get("subroutine", subroutineName(block))}`);
    definition.lines = [...generator.comments(block), head, ...indented(generator.statements(block, "STACK"))];
    this.current = null;
  }

  /** The name in the program of the subroutine that a block calls. @param {BlockState} block */
  call(block) {
    const name = subroutineName(block);
    if (!this.definitions.has(keyOf(block))) this.generator.report("error", "noSubroutine", block, { name });
    this.current?.calls.add(keyOf(block));
    return this.generator.names.get("subroutine", name);
  }

  /** @param {Line[]} lines */
  add(lines) {
    this.others.push(lines);
  }

  /** The text of each subroutine, called ones first. @returns {Line[][]} */
  parts() {
    /** @type {string[]} */ const sorted = [];
    /** @type {string[]} */ const path = [];
    /** @param {string} key */
    const visit = (key) => {
      const definition = this.definitions.get(key);
      if (definition === undefined || sorted.includes(key)) return;
      if (path.includes(key)) {
        const name = subroutineName(definition.block);
        this.generator.report("error", "recursion", definition.block, { name });
        return;
      }
      path.push(key);
      for (const called of definition.calls) visit(called);
      path.pop();
      sorted.push(key);
    };
    for (const key of this.definitions.keys()) visit(key);
    return [...sorted.map((key) => this.definitions.get(key)?.lines ?? []), ...this.others];
  }
}

/** Names that differ only in case are the same. @param {BlockState} block */
const keyOf = (block) => subroutineName(block).toLowerCase();
