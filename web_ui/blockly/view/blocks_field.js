// Blockly in the page: one workspace, its program as plain data, and marks at blocks.

import { Blockly, defineBlocks, loadState, offerBlocks, openWorkspace, saveState } from "../library.js";
import { useDialogs } from "./dialogs.js";

/** @typedef {import("../../i18n/index.js").Translate} Translate */
/** @typedef {import("../state.js").WorkspaceState} WorkspaceState */
/** @typedef {import("../toolbox.js").Look} Look */
/** @typedef {{ id: string | null, text: string }} BlockMark   what is wrong with a block */
/** @typedef {{ undo: readonly any[], redo: readonly any[] }} History   events as plain data */

/** Where the pictures of Blockly are (vite.config.js). */
const MEDIA = "./blockly/";
/** Below this width the toolbox is under the blocks, if there is this height. */
const NARROW_PX = 480;
const HIGH_PX = 240;
/** Distance of a program from the corner, in pixels of the page. */
const MARGIN_PX = 20;

/** Attributes that describe an element to screen readers. */
const DESCRIBING = ["aria-roledescription", "aria-label"];

/** @type {History} */
const NO_HISTORY = { undo: [], redo: [] };

export class BlocksField {
  /** @type {import("blockly/core").WorkspaceSvg | null} */ #workspace = null;
  /** @type {ReadonlySet<string>} ids of blocks with a mark */ #marked = new Set();
  /** The block of the running statement. */ #highlighted = "";
  /** @type {Look | null} */ look = null;

  /**
   * @param {object} options
   * @param {HTMLElement} options.place     on the page, and not hidden when `open` is called
   * @param {Translate} options.t           of blockly.json
   * @param {string} options.language
   * @param {() => void} options.changed    blocks were changed, by the user or by undo and redo
   * @param {(id: string | null) => void} options.selected
   */
  constructor({ place, t, language, changed, selected }) {
    this.place = place;
    this.t = t;
    this.changed = changed;
    this.selected = selected;
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(place);
    this.roles = new MutationObserver(tidyNewBlocks);
    this.roles.observe(place, { subtree: true, attributeFilter: ["role", ...DESCRIBING] });
    useDialogs(Blockly, t);
    /** Blocks exist in the language of the page. */
    this.ready = defineBlocks(language, t);
  }

  /** Whether there is room for a workspace: it cannot be shown in a hidden tab. */
  get isVisible() {
    return this.place.clientWidth > 0;
  }

  /** Show an empty workspace; call when `ready`. @param {Look} look @param {ReadonlySet<string>} hidden */
  open(look, hidden) {
    this.#close();
    this.look = look;
    const { clientWidth, clientHeight } = this.place;
    const isNarrow = clientWidth < NARROW_PX && clientHeight >= HIGH_PX;
    this.#workspace = openWorkspace(this.place, look, { t: this.t, media: MEDIA, hidden, isNarrow });
    this.#workspace.addChangeListener((event) => this.#listen(event));
  }

  /** @param {ReadonlySet<string>} hidden */
  offer(hidden) {
    if (this.#workspace !== null && this.look !== null) offerBlocks(this.#workspace, this.look, this.t, hidden);
  }

  /**
   * Show another program.
   *
   * @param {WorkspaceState} state
   * @param {History} [history]   of the same program in an earlier workspace
   */
  load(state, { undo, redo } = NO_HISTORY) {
    const workspace = this.#workspace;
    if (workspace === null) return;
    this.#marked = new Set();
    this.#highlighted = "";
    Blockly.Events.disable();
    try {
      loadState(workspace, state);
    } finally {
      Blockly.Events.enable();
    }
    workspace.clearUndo();
    workspace.getUndoStack().push(...undo.map((event) => Blockly.Events.fromJson(event, workspace)));
    workspace.getRedoStack().push(...redo.map((event) => Blockly.Events.fromJson(event, workspace)));
    const { left, top } = workspace.getBlocksBoundingBox();
    const { scale } = workspace;
    workspace.scroll(MARGIN_PX - left * scale, MARGIN_PX - top * scale);
  }

  /** What can be undone and redone: it can be given to another workspace. @returns {History} */
  get history() {
    if (this.#workspace === null) return NO_HISTORY;
    const [undo, redo] = [this.#workspace.getUndoStack(), this.#workspace.getRedoStack()];
    return { undo: undo.map((event) => event.toJson()), redo: redo.map((event) => event.toJson()) };
  }

  /** The program that is shown. @returns {WorkspaceState} */
  get state() {
    return this.#workspace === null ? {} : saveState(this.#workspace);
  }

  /** Whether a block is being dragged: the program is not complete. */
  get isDragging() {
    return this.#workspace?.isDragging() ?? false;
  }

  get canUndo() {
    return (this.#workspace?.getUndoStack().length ?? 0) > 0;
  }

  get canRedo() {
    return (this.#workspace?.getRedoStack().length ?? 0) > 0;
  }

  /** Take the last change back, or make it again. @param {boolean} [again] */
  undo(again = false) {
    this.#workspace?.undo(again);
  }

  /** Show what is wrong, at the blocks. @param {readonly BlockMark[]} marks */
  mark(marks) {
    const ids = new Set(marks.flatMap(({ id }) => (id === null ? [] : [id])));
    for (const id of this.#marked) if (!ids.has(id)) this.#block(id)?.setWarningText(null);
    for (const id of ids) {
      const texts = marks.filter((mark) => mark.id === id).map(({ text }) => text);
      this.#block(id)?.setWarningText([...new Set(texts)].join("\n"));
    }
    this.#marked = ids;
  }

  /** Lead the user to a block, and open what is wrong with it. @param {string} id */
  reveal(id) {
    const block = this.#block(id);
    if (block === null) return;
    this.#workspace?.centerOnBlock(id, true);
    Blockly.getFocusManager().focusNode(block);
    const icon = block.getIcon(Blockly.icons.WarningIcon.TYPE);
    void icon?.setBubbleVisible(true);
  }

  /** Select a block. @param {string} id */
  select(id) {
    const block = this.#block(id);
    if (block === null || Blockly.common.getSelected() === block) return;
    this.#workspace?.centerOnBlock(id, true);
    Blockly.getFocusManager().focusNode(block);
  }

  /** Mark the block that runs now; null: none. @param {string | null} id */
  highlight(id) {
    const now = id ?? "";
    if (now === this.#highlighted) return;
    this.#highlighted = now;
    this.#workspace?.highlightBlock(id);
    if (id !== null) this.#workspace?.centerOnBlock(id, true);
  }

  resize() {
    if (this.#workspace !== null && this.isVisible) Blockly.svgResize(this.#workspace);
  }

  focus() {
    if (this.#workspace !== null) Blockly.getFocusManager().focusTree(this.#workspace);
  }

  destroy() {
    this.sizes.disconnect();
    this.roles.disconnect();
    this.#close();
  }

  #close() {
    this.#workspace?.dispose();
    this.#workspace = null;
    this.#marked = new Set();
    this.#highlighted = "";
  }

  /** @param {string} id */
  #block(id) {
    return this.#workspace?.getBlockById(id) ?? null;
  }

  /** @param {import("blockly/core").Events.Abstract} event */
  #listen(event) {
    if (event.type === Blockly.Events.SELECTED) {
      const id = /** @type {import("blockly/core").Events.Selected} */ (event).newElementId ?? null;
      if (id !== null || this.place.contains(document.activeElement)) this.selected(id); // else the focus left
    } else if (!event.isUiEvent || event.type === Blockly.Events.BLOCK_DRAG) this.changed();
  }
}

/**
 * New blocks are options of a list, which may not have anything else in it: Blockly's places for blocks, and the blocks
 * in them, are none. An element with a description would count in spite of that role.
 *
 * @param {readonly MutationRecord[]} changes
 */
function tidyNewBlocks(changes) {
  for (const { target } of changes) {
    if (!(target instanceof Element) || target.closest(".blocklyFlyout") === null) continue;
    if (target.getAttribute("role") === "figure") target.setAttribute("role", "none");
    if (target.getAttribute("role") !== "none") continue;
    for (const name of DESCRIBING) target.removeAttribute(name);
  }
}
