// The notices of a program: what was not read as it is written, whether its stored text counts, what a mode lacks. Pure.

/** @typedef {import("./notices.js").Notice} Notice */
/** @typedef {import("../kinds.js").Mode} Mode */

/**
 * The notices by name; null: there is none.
 *
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {import("./editing.js").VplEditing} options.editing
 * @param {Mode | null} options.wanted   a mode in which blocks would be lost
 * @param {(isRenewed: boolean) => void} options.decide
 * @param {() => void} options.read      the warnings were read
 * @param {(isYes: boolean) => void} options.answer   to the loss of blocks
 * @param {() => void} options.turn      make the program a text
 * @returns {Record<"error" | "warnings" | "question" | "loss", Notice | null>}
 */
export function questionNotices({ t, editing, wanted, decide, read, answer, turn }) {
  const { error, warnings, question } = editing;
  /** @param {import("../program.js").Finding} finding */
  const say = ({ key, values }) => t(key, values);
  return {
    error: error && {
      text: t(error.key, error.values),
      look: "stop",
      buttons: [{ name: "turn", text: t("pane.turn"), act: turn }],
    },
    warnings:
      warnings.length === 0
        ? null
        : {
            text: t("load.title"),
            items: warnings.map(say),
            look: "wait",
            buttons: [{ name: "read", text: t("load.read"), act: read }],
          },
    question: question && {
      text: question.isAsked ? t("decide.edit") : say(question.message),
      about: question.isAsked ? say(question.message) : question.changes.length > 0 ? t("decide.changes") : undefined,
      items: question.changes.map(say),
      look: "wait",
      buttons: [
        { name: "new", text: t("decide.new"), isMain: true, act: () => decide(true) },
        ...(question.isAsked ? [{ name: "keep", text: t("decide.keep"), act: () => decide(false) }] : []),
      ],
    },
    loss:
      wanted === null
        ? null
        : {
            text: t("loss.title", { mode: t(`modes.${wanted}`) }),
            items: editing.lostIn(wanted).map(say),
            look: "wait",
            buttons: [
              { name: "do", text: t("loss.do"), act: () => answer(true) },
              { name: "stay", text: t("loss.keep"), isMain: true, act: () => answer(false) },
            ],
          },
  };
}
