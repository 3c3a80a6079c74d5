// Names in a program by what they stand for, read from its syntax tree: where each is defined and used.

/** @typedef {import("@lezer/common").Tree} Tree */
/** @typedef {import("@lezer/common").SyntaxNode} SyntaxNode */
/** @typedef {(from: number, to: number) => string} Slice   returns a range of the text */
/**
 * A name at one place. Variables and constants share their names, so they are one kind.
 *
 * @typedef {object} Place
 * @property {string} name
 * @property {"value" | "subroutine" | "event" | "native"} kind
 * @property {number} from
 * @property {number} to
 * @property {boolean} isDefinition   a `var`, `const` or `sub`, or the handler of an event
 */

const KINDS = /** @type {Readonly<Record<string, Place["kind"]>>} */ ({
  VariableName: "value",
  VariableDefinitionName: "value",
  ConstantDefinitionName: "value",
  SubroutineName: "subroutine",
  EventName: "event",
  FunctionName: "native",
});

const DEFINING = new Set([
  "VariableDefinitionName VariableDefinition",
  "ConstantDefinitionName ConstantDefinition",
  "SubroutineName Subroutine",
  "EventName Handler",
]);

/** What may be written as a name. */
export const NAME = /^[\p{L}_][\p{L}\p{N}_.]*$/u;

/** @param {SyntaxNode} node  of an identifier @param {Slice} slice @returns {Place} */
function placeOf(node, slice) {
  const { from, to, parent } = node;
  const role = parent?.name ?? "";
  return {
    name: slice(from, to),
    kind: KINDS[role] ?? "value", // else: a limit of a loop, a constant
    from,
    to,
    isDefinition: DEFINING.has(`${role} ${parent?.parent?.name}`),
  };
}

/**
 * All names of the program, in the order of the text.
 *
 * @param {Tree} tree
 * @param {Slice} slice
 * @returns {Place[]}
 */
export function names(tree, slice) {
  /** @type {Place[]} */ const found = [];
  tree.iterate({
    enter({ name, node }) {
      if (name === "Identifier" && node.to > node.from) found.push(placeOf(node, slice));
    },
  });
  return found;
}

/**
 * The name at a position, which may also be just behind it; null if there is none.
 *
 * @param {readonly Place[]} places
 * @param {number} position
 */
export function nameAt(places, position) {
  return places.find(({ from, to }) => from <= position && position <= to) ?? null;
}

/** All places of the same name, itself included. @param {readonly Place[]} places @param {Place} place */
export function samePlaces(places, { name, kind }) {
  return places.filter((each) => each.name === name && each.kind === kind);
}

/** Where a name is defined in the text; null if that is elsewhere. @param {readonly Place[]} places @param {Place} place */
export function definitionOf(places, place) {
  return samePlaces(places, place).find(({ isDefinition }) => isDefinition) ?? null;
}

/**
 * Why a name cannot become another one: the key of a text with its values, or null if it can.
 *
 * @param {readonly Place[]} places
 * @param {Place} place
 * @param {string} wanted
 * @param {(name: string) => boolean} isTaken   by the robot, the file or the language
 * @returns {{ key: string, values: Record<string, string> } | null}
 */
export function whyNotRename(places, place, wanted, isTaken) {
  if (!NAME.test(wanted)) return { key: "rename.invalid", values: { name: wanted } };
  const isUsed = places.some(({ name, kind }) => name === wanted && kind === place.kind);
  if (isUsed || isTaken(wanted)) return { key: "rename.taken", values: { name: wanted } };
  return null;
}
