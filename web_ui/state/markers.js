// The playground as markers by namespace and id, as in RViz.

/** @typedef {{ x: number, y: number, z: number }} Vector */
/** @typedef {{ r: number, g: number, b: number, a: number }} Color */
/**
 * @typedef {object} Marker
 * @property {string} ns
 * @property {number} id
 * @property {number} type
 * @property {number} action
 * @property {{ position: Vector, orientation: { x: number, y: number, z: number, w: number } }} pose
 * @property {Vector} scale
 * @property {Color} color
 * @property {Vector[]} points
 * @property {Color[]} colors
 * @property {{ data: ArrayLike<number>, image?: ImageBitmap | HTMLCanvasElement }} [texture]  an image over the whole
 * marker: PNG, empty for none, or already decoded
 */

export const MARKER = { CUBE: 1, SPHERE: 2, CYLINDER: 3, LINE_STRIP: 4, TRIANGLE_LIST: 11 };
const ACTION = { DELETE: 2, DELETE_ALL: 3 };

/**
 * Apply an array of markers; returns a new map.
 *
 * @param {ReadonlyMap<string, Marker>} markers
 * @param {Marker[]} changes
 * @returns {ReadonlyMap<string, Marker>}
 */
export function applyMarkers(markers, changes) {
  const next = new Map(markers);
  for (const marker of changes) {
    const key = `${marker.ns}/${marker.id}`;
    if (marker.action === ACTION.DELETE_ALL) next.clear();
    else if (marker.action === ACTION.DELETE) next.delete(key);
    else next.set(key, marker);
  }
  return next;
}

/** Whether a marker has an image. @param {Marker} marker */
export function hasPicture({ texture }) {
  return texture !== undefined && (texture.image !== undefined || texture.data.length > 0);
}
