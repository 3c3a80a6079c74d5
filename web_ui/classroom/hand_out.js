// The dialog in which a teacher hands out a file: what, to whom, and until when.

import { LinkError, sharedPart, unpacked } from "../sharing/link.js";
import { titleIn } from "../missions/list.js";
import { h, setText } from "../ui/dom.js";
import { open } from "./dialogs.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../sharing/link.js").Kind} Kind */
/** @typedef {{ kind: Kind, name: string, content: string, pupils: string[] | null, due: string, solution_of: string, title: string }} Given   content: base64; "": a shipped mission */

/** As the server allows (thymio_sim_ros/classroom/handouts.py). */
export const LARGEST = 4_000_000;

/**
 * What a file is: by its ending, and a JSON file or an archive by what a mission has. Pure.
 *
 * @param {string} name
 * @param {Uint8Array} content
 * @returns {Kind}
 */
export function kindOfFile(name, content) {
  if (/\.(?:aesl|aseba|txt|py)$/i.test(name)) return "program";
  let letters = "";
  for (const byte of content) letters += String.fromCharCode(byte);
  if (/\.zip$/i.test(name)) return letters.includes("mission.json") ? "mission" : "playground";
  return /"success"\s*:/.test(letters) ? "mission" : "playground";
}

/** @param {Uint8Array} bytes */
export function base64(bytes) {
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return btoa(letters);
}

/**
 * Ask what to hand out.
 *
 * @param {object} options
 * @param {Translate} options.t
 * @param {string} options.language
 * @param {readonly { id: string, name: string }[]} options.pupils
 * @param {readonly import("../missions/list.js").Step[]} options.missions   that are shipped
 * @param {{ id: string, name: string, pupils: readonly string[] } | null} options.task   what a solution is for; null: it is none
 * @param {(given: Given) => Promise<void>} options.send   throws an Error with the reason of the server
 */
export function askHandOut({ t, language, pupils, missions, task, send }) {
  const file = h("input", { type: "file", id: "handout-file", accept: ".aesl,.aseba,.txt,.py,.json,.playground,.xml,.zip" });
  const link = h("input", { class: "input", id: "handout-link", autocomplete: "off", spellcheck: "false" });
  const groups = missions.map(({ titles, missions: ofStep }) => {
    const group = h("optgroup", { label: titleIn(titles, language) });
    group.append(...ofStep.map(({ name, titles: ofMission }) => h("option", { value: name }, titleIn(ofMission, language))));
    return group;
  });
  const mission = h("select", { id: "handout-mission", class: "select" }, h("option", { value: "" }, t("handout.noMission")), ...groups);
  const hasMissions = missions.length > 0 && task === null;
  const due = h("input", { type: "datetime-local", class: "input", id: "handout-due" });
  const boxes = pupils.map(({ id, name }) => {
    const box = h("input", { type: "checkbox", value: id, checked: task === null || task.pupils.includes(id) });
    return { box, label: h("label", { class: "check" }, box, h("span", {}, name)) };
  });
  const all = h("input", { type: "checkbox", checked: boxes.every(({ box }) => box.checked) });
  all.addEventListener("change", () => boxes.forEach(({ box }) => (box.checked = all.checked)));
  for (const { box } of boxes) box.addEventListener("change", () => (all.checked = boxes.every((each) => each.box.checked)));
  const trouble = h("p", { class: "note-box stop", role: "alert", hidden: true });
  /** @param {string} words */
  const refuse = (words) => {
    trouble.hidden = false;
    setText(trouble, words);
  };

  const item = async () => {
    const chosen = file.files?.[0];
    if (chosen !== undefined) {
      if (chosen.size > LARGEST) return refuse(t("handout.tooLarge", { name: chosen.name, size: LARGEST / 1_000_000 }));
      const content = new Uint8Array(await chosen.arrayBuffer());
      return { kind: kindOfFile(chosen.name, content), name: chosen.name, content };
    }
    if (mission.value !== "") {
      const title = mission.selectedOptions[0].textContent ?? "";
      return { kind: /** @type {const} */ ("mission"), name: mission.value, title, content: new Uint8Array() };
    }
    const part = sharedPart(link.value);
    if (part === null) return refuse(t(link.value.trim() === "" ? "handout.nothing" : "handout.badLink"));
    return unpacked(part).catch((error) => {
      if (!(error instanceof LinkError)) throw error;
      return refuse(t("handout.badLink"));
    });
  };
  const submit = async (/** @type {Event} */ event) => {
    event.preventDefault();
    const chosen = boxes.filter(({ box }) => box.checked).map(({ box }) => box.value);
    if (chosen.length === 0) return refuse(t("handout.noPupils"));
    const given = await item();
    if (given === undefined) return;
    give.disabled = true;
    try {
      await send({
        kind: given.kind,
        name: given.name,
        title: "title" in given ? given.title : "",
        content: base64(given.content),
        pupils: chosen.length === pupils.length ? null : chosen,
        due: due.value === "" ? "" : new Date(due.value).toISOString(),
        solution_of: task?.id ?? "",
      });
      dialog.close();
    } catch (error) {
      refuse(t("handout.refused", { reason: error instanceof Error ? error.message : String(error) }));
    } finally {
      give.disabled = false;
    }
  };
  const give = h("button", { type: "submit", class: "btn you", "data-verb": "give" }, t("handout.give"));
  const dialog = h(
    "dialog",
    { class: "card class-dialog", "aria-labelledby": "handout-title" },
    h(
      "form",
      { class: "handout-form", onsubmit: submit },
      h("h2", { id: "handout-title" }, task === null ? t("handout") : t("handout.solution", { name: task.name })),
      h("label", { for: "handout-file" }, t("handout.file")),
      file,
      h("label", { for: "handout-link" }, t("handout.link")),
      link,
      ...(hasMissions ? [h("label", { for: "handout-mission" }, t("handout.mission")), mission] : []),
      h("label", { for: "handout-due" }, t("handout.due")),
      due,
      h(
        "fieldset",
        { class: "handout-pupils" },
        h("legend", {}, t("handout.pupils")),
        h("label", { class: "check" }, all, h("strong", {}, t("all"))),
        ...boxes.map(({ label }) => label),
      ),
      h("p", { class: "small muted" }, t("handout.help")),
      trouble,
      h(
        "div",
        { class: "row class-buttons" },
        h("button", { type: "button", class: "btn line", "data-verb": "cancel", onclick: () => dialog.close() }, t("cancel")),
        give,
      ),
    ),
  );
  open(dialog);
}
