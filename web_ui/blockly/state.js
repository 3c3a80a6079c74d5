// A workspace as plain data, in the form in which Blockly itself serializes it. Everything except the view works on it.

/**
 * @typedef {object} Socket  what is plugged into an input or below a block: the block counts, else its shadow
 * @property {BlockState} [block]
 * @property {BlockState} [shadow]
 */
/**
 * @typedef {object} BlockState
 * @property {string} type
 * @property {string} [id]
 * @property {number} [x]  blocks at the top level only
 * @property {number} [y]
 * @property {Record<string, any>} [fields]
 * @property {Record<string, Socket>} [inputs]
 * @property {Socket} [next]
 * @property {any} [extraState]
 * @property {{ comment?: { text: string, pinned?: boolean, height?: number, width?: number } }} [icons]
 * @property {string[]} [disabledReasons]
 * @property {boolean} [enabled]
 * @property {boolean} [collapsed]
 * @property {boolean} [inline]
 * @property {boolean} [deletable]
 * @property {boolean} [movable]
 * @property {boolean} [editable]
 * @property {string} [data]
 */
/** @typedef {{ id: string, name: string, type?: string }} Variable */
/** @typedef {{ text?: string, x?: number, y?: number, width?: number, height?: number, id?: string }} CommentState */
/**
 * @typedef {object} WorkspaceState
 * @property {{ languageVersion?: number, blocks: BlockState[] }} [blocks]
 * @property {Variable[]} [variables]
 * @property {CommentState[]} [workspaceComments]
 */

/** @returns {WorkspaceState} */
export function emptyState() {
  return { blocks: { languageVersion: 0, blocks: [] }, variables: [] };
}

/** Whether the state has neither blocks nor comments. @param {WorkspaceState} state */
export function isEmpty(state) {
  return (state.blocks?.blocks ?? []).length === 0 && (state.workspaceComments ?? []).length === 0;
}

/**
 * The block that counts in an input: the plugged one, else the shadow.
 *
 * @param {BlockState} block
 * @param {string} input
 */
export function plugged(block, input) {
  const socket = block.inputs?.[input];
  return socket?.block ?? socket?.shadow;
}

/** The block below. @param {BlockState} block */
export function following(block) {
  return block.next?.block ?? block.next?.shadow;
}

/** @param {BlockState} block */
export function isDisabled(block) {
  return block.enabled === false || (block.disabledReasons ?? []).length > 0;
}

/** Blockly reads a workspace along lines that fall by 3 degrees from left to right. */
const SLOPE = Math.sin((3 * Math.PI) / 180);

/**
 * Blocks of the top level in the order in which they are read: from top to bottom, then from left to right.
 *
 * @param {WorkspaceState} state
 * @returns {BlockState[]}
 */
export function topBlocks(state) {
  /** @param {BlockState} block */
  const place = ({ x = 0, y = 0 }) => y + SLOPE * x;
  return [...(state.blocks?.blocks ?? [])].sort((a, b) => place(a) - place(b));
}

/**
 * A block and all blocks in it and below it that count, in the order of a file.
 *
 * @param {BlockState | undefined} block
 * @returns {Generator<BlockState>}
 */
export function* blocksFrom(block) {
  for (let each = block; each !== undefined; each = following(each)) {
    yield each;
    for (const input of Object.keys(each.inputs ?? {})) yield* blocksFrom(plugged(each, input));
  }
}

/** All blocks that count. @param {WorkspaceState} state @returns {Generator<BlockState>} */
export function* allBlocks(state) {
  for (const top of topBlocks(state)) yield* blocksFrom(top);
}

/**
 * The name of the variable in a field: Blockly refers to it by id, old states and blocks in a toolbox by name.
 *
 * @param {WorkspaceState} state
 * @param {any} field
 * @returns {string}
 */
export function variableName(state, field) {
  if (typeof field === "string") return field;
  const found = (state.variables ?? []).find(({ id }) => id === field?.id);
  return found?.name ?? field?.name ?? "";
}

/**
 * Whether two workspaces are the same program with the same layout: ids do not matter, nor do variables that no block
 * uses.
 *
 * @param {WorkspaceState} a
 * @param {WorkspaceState} b
 */
export function sameWorkspace(a, b) {
  return JSON.stringify(comparable(a)) === JSON.stringify(comparable(b));
}

/** @param {WorkspaceState} state */
function comparable(state) {
  return {
    blocks: topBlocks(state).map((block) => ({ ...comparableBlock(state, block), at: position(block) })),
    comments: (state.workspaceComments ?? []).map((comment) => [comment.text ?? "", ...position(comment)]),
  };
}

/** @param {{ x?: number, y?: number }} place */
function position({ x = 0, y = 0 }) {
  return [Math.round(x), Math.round(y)];
}

/** @param {WorkspaceState} state @param {BlockState} block @returns {any} */
function comparableBlock(state, block) {
  const { type, data, collapsed, inline, extraState, icons, deletable, movable, editable } = block;
  /** @param {Socket | undefined} socket */
  const socketOf = (socket) => [socket?.block, socket?.shadow].map((each) => each && comparableBlock(state, each));
  /** @template T @param {Record<string, T> | undefined} record */
  const sorted = (record) => Object.entries(record ?? {}).sort(([left], [right]) => (left < right ? -1 : 1));
  return {
    type,
    fields: sorted(block.fields).map(([name, value]) => [name, fieldValue(state, value)]),
    inputs: sorted(block.inputs).map(([name, socket]) => [name, socketOf(socket)]),
    next: socketOf(block.next),
    extra: extraState === undefined ? null : JSON.stringify(extraState),
    comment: icons?.comment?.text ?? "",
    flags: [isDisabled(block), collapsed === true, inline ?? null, deletable !== false, movable !== false],
    more: [editable !== false, data ?? ""],
  };
}

/** @param {WorkspaceState} state @param {any} value */
function fieldValue(state, value) {
  return value !== null && typeof value === "object" ? variableName(state, value).toLowerCase() : String(value);
}
