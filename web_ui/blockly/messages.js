// What a pupil reads about problems. A problem has a key and values, so that it can be shown in any language.

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {{ key: string, values: Record<string, string | number> }} Message */

/** A problem of a workspace. @param {Message} problem @param {Translate} t */
export const problemText = ({ key, values }, t) => t(`problem.${key}`, values);

/** A problem of a file, without its place. @param {Message} problem @param {Translate} t */
export const fileProblemText = ({ key, values }, t) => t(`file.${key}`, values);

/**
 * Why a Scratch project cannot be imported, or what was left out of it.
 *
 * @param {Message} message
 * @param {Translate} t
 */
export const scratchText = ({ key, values }, t) => t(`scratch.${key}`, values);
