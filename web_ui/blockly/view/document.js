// The open file as blocks: what the blocks stand for, and which text the file has. Every change of the blocks becomes a
// whole text of the file. No DOM.

import { readAesl } from "../../editor/aesl.js";
import { blocksOf, difference } from "../compare.js";
import { readFile, writeFile } from "../file.js";
import { generate, linesOfBlock } from "../generator.js";
import { sameWorkspace } from "../state.js";

/** @typedef {import("../state.js").WorkspaceState} WorkspaceState */
/**
 * Blocks of a file as Blockly had them, for a view that is created again: for another look, or another language.
 *
 * @typedef {object} KeptBlocks
 * @property {string} text
 * @property {boolean} isOther   whether the program of the file was another one
 * @property {import("../toolbox.js").Look | null} chosen   by the user
 * @property {WorkspaceState} state
 * @property {import("./blocks_field.js").History} history
 */

export class BlocksDocument {
  /** @type {readonly (string | null)[] | null} */ #blocks = null;
  /** Whether the program of the file has comments that the blocks do not have. */ #hasOwnComments = false;

  /** @param {string} text  of an .aesl file */
  constructor(text) {
    this.file = readFile(text);
    this.reserved = this.canEdit ? readAesl(text).constants.map(({ name }) => name) : [];
    /** The text of the file. */
    this.text = text;
    this.state = this.file.state;
    /** The program in the file; in an error that of the last blocks that had none. */
    this.code = this.file.code ?? "";
    this.generated = this.#generate();
    /** Where the program of the file is another one than that of its blocks; null: nowhere. */
    this.difference = this.canEdit ? difference(this.file, this.reserved) : null;
  }

  /** Whether everything in the file is known here; else it runs, but its blocks cannot be changed. */
  get canEdit() {
    return this.file.problems.length === 0;
  }

  /** Whether the program was edited, or made by another generator: it runs until the user decides. */
  get isOther() {
    return this.difference !== null;
  }

  /** Problems because of which the blocks are no program. */
  get errors() {
    return this.generated.problems.filter(({ severity }) => severity === "error");
  }

  /** The id of the block of each line of the program; empty if the program is another one. */
  get blocks() {
    this.#blocks ??= this.isOther ? [] : blocksOf(this.code, this.generated);
    return this.#blocks;
  }

  /** The lines of a block in the program: first and last, from 0; null if it has none. @param {string} id */
  linesOf(id) {
    return linesOfBlock(this.blocks, this.state, id);
  }

  /** Whether the next change loses text that is not in the blocks: another program, or comments. */
  get hasOwnText() {
    return this.isOther || (this.#hasOwnComments && this.code === this.file.code);
  }

  /** Whether a workspace is the same program in the same places. @param {WorkspaceState} state */
  isSame(state) {
    return sameWorkspace(this.state, state);
  }

  /**
   * The workspace as Blockly has it after loading, with ids and fields that the file lacks.
   *
   * @param {WorkspaceState} state
   */
  loaded(state) {
    this.file = { ...this.file, state };
    this.#setState(state);
    const made = new Set(commentsOf(this.generated.code));
    this.#hasOwnComments = commentsOf(this.code).some((comment) => !made.has(comment));
  }

  /**
   * The blocks were changed. The program of the file stays if it is another one, and in an error. Returns the text.
   *
   * @param {WorkspaceState} state
   */
  change(state) {
    this.#setState(state);
    return this.#write();
  }

  /** Make the program from the blocks, now and after each change. Returns the text of the file. */
  adopt() {
    this.difference = null;
    return this.#write();
  }

  /** @param {WorkspaceState} state */
  #setState(state) {
    this.state = state;
    this.generated = this.#generate();
    this.#blocks = null;
  }

  #generate() {
    return generate(this.state, { reserved: this.reserved });
  }

  #write() {
    const { file } = this;
    this.#blocks = null;
    if (this.isSame(file.state) && (this.isOther || difference(file, this.reserved) === null)) {
      this.code = file.code ?? "";
      this.text = file.text; // byte for byte
    } else {
      if (!this.isOther && this.errors.length === 0) this.code = this.generated.code;
      this.text = writeFile(file, this.state, this.isOther ? null : this.code);
    }
    return this.text;
  }
}

/** @param {string} code */
const commentsOf = (code) => [...code.matchAll(/#.*/g)].map(([comment]) => comment.trim());
