// The declarations of playground files: fields, limits and sample values of robots and shapes, written down once in
// Python (thymio_sim_ros/sim/playground/declarations.py).

import builtIn from "./declarations.json" with { type: "json" };

/**
 * @typedef {object} DeclaredField
 * @property {"number" | "text" | "points" | "image" | "flag" | "object"} type
 * @property {boolean} [required]
 * @property {any} [default]        value of a field that is left out
 * @property {boolean} [nullable]   whether null is allowed
 * @property {string} [unit]        unit of a number
 * @property {number} [low]         minimum of a number
 * @property {number} [high]        maximum of a number
 * @property {string} [pattern]     regular expression that the whole text matches
 * @property {"line" | "name" | "color"} [format]  of a text
 * @property {string} [meaning]     description of a text of another format
 * @property {number} [longest]     maximum number of characters of a text or an image
 * @property {number} [fewest]      minimum number of points
 * @property {number} [most]        maximum number of points
 * @property {Record<string, DeclaredField>} [fields]  of an object
 */
/**
 * @typedef {object} DeclaredShape
 * @property {"ground" | "paint" | "object"} group
 * @property {Record<string, DeclaredField>} fields   besides `kind` and `name`
 * @property {Record<string, any>} sample             values of a new item
 * @property {import("./primitives.js").Primitive[]} primitives   of the sample at the origin
 * @property {Record<string, string>} labels          name of the kind, by language
 * @property {Record<string, Record<string, string>>} field_labels   name of each field, by language
 */
/**
 * @typedef {object} Declarations
 * @property {number} format
 * @property {{ shapes: number, robots: number, translations: number }} limits
 * @property {string} language           pattern of a language code
 * @property {DeclaredField} coordinate  rule of a coordinate of a point
 * @property {Record<string, DeclaredField>} titles
 * @property {Record<string, DeclaredField>} robot
 * @property {Record<string, DeclaredShape>} shapes
 */

/** Those of the shapes of this version of the simulator, without plug-ins. */
export const BUILT_IN = /** @type {Declarations} */ (/** @type {unknown} */ (builtIn));

/**
 * The shapes that the page's server declares: those that are installed, with plug-ins. Null without such a server, or if
 * it declares another format.
 *
 * @param {typeof fetch} [request]
 * @returns {Promise<Record<string, DeclaredShape> | null>}
 */
export async function fetchShapes(request = fetch) {
  try {
    const answer = await request("shapes.json");
    const declared = answer.ok ? /** @type {Declarations} */ (await answer.json()) : null;
    return declared?.format === BUILT_IN.format ? declared.shapes : null;
  } catch {
    return null;
  }
}
