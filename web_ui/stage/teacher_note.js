// What the teacher of a class says to the reader of this page, shows, or hands out, and that time is paused by the teacher
// (docs/classroom.md): parameters of the page's node. It is over the view, or above the open tab where this tab has the
// place of the view, and while a playground is built, because the view has the hints of the tools then.

import { timeDisabledReason } from "../state/disabled_reason.js";
import { readHandouts } from "../state/handouts.js";
import { PARAMETERS } from "../state/names.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** Put the note where it is seen. @param {HTMLElement} element @param {boolean} isBuilding */
function place(element, isBuilding) {
  const view = document.querySelector("#messages");
  const isInView = view?.checkVisibility() !== false && !isBuilding;
  if (isInView === (element.parentElement?.id === "messages")) return;
  if (isInView) view?.querySelector(":scope > .banner")?.after(element);
  else document.querySelector("#tabs")?.after(element);
}

/** Whether a link leads to a page of the web; it may be relative to this page. @param {string} address  "": none */
function isWebAddress(address) {
  try {
    return address !== "" && /^https?:$/.test(new URL(address, location.href).protocol);
  } catch {
    return false;
  }
}

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function teacherNotePanel({ text, announce, scene, creator, share }) {
  const pageText = text("page");
  let hiddenNote = "";
  let newest = "";
  const open = h(
    "button",
    { type: "button", class: "btn soft", "data-handout": "newest", hidden: true, onclick: () => void share.openHandout(newest) },
    icon("open"),
    pageText("handout.open"),
  );
  let announced = "";
  const words = h("p", { class: "teacher-words" });
  const link = h("a", { class: "btn soft", target: "_blank", rel: "noreferrer", hidden: true }, icon("eye"), pageText("notice.look"));
  const hide = h("button", {
    type: "button",
    class: "btn icon",
    "aria-label": pageText("notice.dismiss"),
    onclick: () => {
      hiddenNote = key;
      scene.invalidate();
    },
  }, icon("close"));
  const element = h("div", { class: "message note-box teacher-note", hidden: true }, h("div", { class: "grow" }, h("p", { class: "cap" }, pageText("notice.teacher")), words), link, open, hide);
  let key = "";
  return {
    slot: "messages",
    element,
    render({ parameters }) {
      const note = String(parameters[PARAMETERS.notice] ?? "");
      const address = String(parameters[PARAMETERS.noticeLink] ?? "");
      const paused = timeDisabledReason({ parameters }, pageText);
      const handout = readHandouts(parameters[PARAMETERS.handouts]).find(({ opened }) => !opened);
      newest = handout?.id ?? "";
      const given = handout === undefined ? "" : pageText("handout.given", { name: handout.name });
      const said = [paused, note, given].filter((line) => line !== "").join("\n");
      key = `${said}\n${address}\n${newest}`;
      if (said === "") hiddenNote = "";
      element.hidden = said === "" || key === hiddenNote;
      place(element, creator.isOpen);
      setText(words, said);
      open.hidden = handout === undefined;
      link.hidden = !isWebAddress(address);
      if (!link.hidden) setAttribute(link, "href", address);
      if (said !== announced) {
        announced = said;
        if (said !== "") announce(`${pageText("notice.teacher")}: ${said}`);
      }
    },
  };
}
