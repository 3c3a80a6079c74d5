// The names that a program defines, read from its syntax tree, which exists even if the program does not compile.

/** @typedef {import("@lezer/common").Tree} Tree */
/** @typedef {{ name: string, from: number, kind: "variable" | "constant" | "subroutine" | "event" }} Definition */

const KINDS = /** @type {Record<string, Definition["kind"]>} */ ({
  VariableDefinitionName: "variable",
  ConstantDefinitionName: "constant",
});

/**
 * @param {Tree} tree
 * @param {(from: number, to: number) => string} slice  returns a range of the text
 * @returns {Definition[]} in the order of the text; an event is one that has a handler
 */
export function outline(tree, slice) {
  /** @type {Definition[]} */ const found = [];
  tree.iterate({
    enter({ node, name, from, to }) {
      const parent = node.parent?.name;
      const kind =
        KINDS[name] ??
        (name === "SubroutineName" && parent === "Subroutine" ? "subroutine" : undefined) ??
        (name === "EventName" && parent === "Handler" ? "event" : undefined);
      if (kind !== undefined && to > from) found.push({ name: slice(from, to), from, kind });
    },
  });
  return found;
}
