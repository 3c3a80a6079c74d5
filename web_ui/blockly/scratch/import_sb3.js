// Imports a Scratch 3 project (.sb3): what the robot can do becomes a workspace, the rest is listed.

import { emptyState } from "../state.js";
import { Converter } from "./convert.js";
import { ZipError, readZip } from "./zip.js";

/** @typedef {import("../state.js").WorkspaceState} WorkspaceState */
/** @typedef {{ key: string, values: Record<string, string | number> }} LeftOut  `scratch.<key>` in the texts */
/**
 * @typedef {object} Imported
 * @property {WorkspaceState} state
 * @property {LeftOut | null} error     why nothing could be imported
 * @property {LeftOut[]} leftOut
 */

/**
 * @param {Uint8Array} archive
 * @returns {Promise<Imported>}
 */
export async function importSb3(archive) {
  let text;
  try {
    text = new TextDecoder().decode(await readZip(archive, "project.json"));
    return importProject(JSON.parse(text));
  } catch (error) {
    if (!(error instanceof ZipError || error instanceof SyntaxError)) throw error;
    return failed("notZip", { message: error.message });
  }
}

/**
 * @param {any} project  the content of project.json
 * @returns {Imported}
 */
export function importProject(project) {
  if (!Array.isArray(project?.targets)) {
    const isOlder = project?.objName !== undefined || Array.isArray(project?.children);
    return isOlder ? failed("olderScratch", {}) : failed("notZip", { message: "found no targets in project.json" });
  }
  const converter = new Converter();
  for (const target of project.targets) converter.add(target);
  return { state: converter.state(), error: null, leftOut: converter.leftOut() };
}

/** @param {string} key @param {Record<string, string | number>} values @returns {Imported} */
const failed = (key, values) => ({ state: emptyState(), error: { key, values }, leftOut: [] });
