// Dialogs of the teacher's page: a message, a question, one robot for the projector.

import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { drawPlan } from "./plan.js";
import { qrImages } from "./sheet.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */

/** As the server allows (thymio_sim_ros/classroom/classroom.py). */
const MAX_MESSAGE = 500;

/** Open a dialog, which is removed when it closes. @param {HTMLDialogElement} dialog */
export function open(dialog) {
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

/**
 * Ask for a message; an empty one removes the message that is shown.
 *
 * @param {{ title: string, text: string, t: Translate, send: (text: string) => void }} options
 */
export function askMessage({ title, text, t, send }) {
  const described = { "aria-labelledby": "message-title", "aria-describedby": "message-help" };
  const field = h("textarea", { class: "input", id: "message", rows: "3", maxlength: MAX_MESSAGE, ...described });
  field.value = text;
  const finish = (/** @type {string} */ sent) => {
    dialog.close();
    send(sent);
  };
  const dialog = h(
    "dialog",
    { class: "card class-dialog", "aria-labelledby": "message-title" },
    h("h2", { id: "message-title" }, title),
    field,
    h("p", { class: "small muted", id: "message-help" }, t("message.text")),
    h(
      "div",
      { class: "row class-buttons" },
      h("button", { type: "button", class: "btn line", "data-verb": "cancel", onclick: () => dialog.close() }, t("cancel")),
      h("button", { type: "button", class: "btn line", "data-verb": "remove", onclick: () => finish("") }, t("message.remove")),
      h("button", { type: "button", class: "btn you", "data-verb": "send", onclick: () => finish(field.value) }, t("message.send")),
    ),
  );
  open(dialog);
  field.focus();
}

/** @param {{ question: string, verb: string, t: Translate, act: () => void }} options */
export function ask({ question, verb, t, act }) {
  const yes = () => {
    dialog.close();
    act();
  };
  const dialog = h(
    "dialog",
    { class: "card class-dialog", "aria-label": verb },
    h("p", {}, question),
    h(
      "div",
      { class: "row class-buttons" },
      h("button", { type: "button", class: "btn line", "data-verb": "cancel", onclick: () => dialog.close() }, t("cancel")),
      h("button", { type: "button", class: "btn you", "data-verb": "yes", onclick: yes }, verb),
    ),
  );
  open(dialog);
}

/** A dialog with anything in it, to look at. @param {readonly Node[]} content @param {string} title  id of its title @param {Translate} t */
export function showContent(content, title, t) {
  const close = () => dialog.close();
  const dialog = h(
    "dialog",
    { class: "card class-dialog class-content", "aria-labelledby": title },
    ...content,
    h("div", { class: "row class-buttons" }, h("button", { type: "button", class: "btn line", "data-verb": "close", onclick: close }, t("close"))),
  );
  open(dialog);
}

/**
 * How pupils reach the class, as large as the window, for the projector.
 *
 * @param {import("./api.js").Room} room
 * @param {Translate} t
 */
export function showRoom({ address, code, qr }, t) {
  const close = () => dialog.close();
  const dialog = h(
    "dialog",
    { class: "card class-present class-room", "aria-labelledby": "room-address" },
    h(
      "div",
      { class: "row" },
      h("p", { class: "grow" }, t("room.help")),
      h("button", { type: "button", class: "btn icon", "data-verb": "close", "aria-label": t("close"), onclick: close }, icon("close")),
    ),
    h("h2", { id: "room-address" }, address),
    h("h2", { class: "num" }, t("room.code", { code })),
    ...qrImages(qr),
  );
  open(dialog);
}

/**
 * One robot as large as the window, for the projector. Returns a function that draws it again, null once it is closed.
 *
 * @param {{ pupil: import("./api.js").Pupil, t: Translate, offer: (isOffered: boolean) => void }} options
 */
export function present({ pupil, t, offer }) {
  const canvas = h("canvas", { role: "img", "aria-label": t("plan", { name: pupil.name }) });
  let isOffered = false;
  let isOpen = true;
  const note = h("span", { class: "small muted grow", role: "status" });
  const offering = h(
    "button",
    {
      type: "button",
      class: "btn you",
      "data-verb": "offer",
      "aria-pressed": "false",
      onclick: () => {
        isOffered = !isOffered;
        offering.setAttribute("aria-pressed", String(isOffered));
        setText(note, isOffered ? t("present.offered", { name: pupil.name }) : "");
        offer(isOffered);
      },
    },
    t("present.offer"),
  );
  const dialog = h(
    "dialog",
    { class: "card class-present", "aria-labelledby": "present-title" },
    h(
      "div",
      { class: "row" },
      h("h2", { id: "present-title" }, pupil.name),
      note,
      offering,
      h("a", { class: "btn line", href: pupil.watch, target: "_blank", rel: "noreferrer" }, icon("eye"), t("present.3d")),
      h("button", { type: "button", class: "btn icon", "data-verb": "close", "aria-label": t("close"), onclick: () => dialog.close() }, icon("close")),
    ),
    canvas,
  );
  open(dialog);
  dialog.addEventListener("close", () => {
    isOpen = false;
    if (isOffered) offer(false);
  });
  /** @param {import("./api.js").Pupil} now @param {import("./plan.js").Plan | undefined} plan */
  const draw = (now, plan) => {
    if (plan !== undefined && isOpen) drawPlan(canvas, plan, now.overview);
    return isOpen;
  };
  return draw;
}
