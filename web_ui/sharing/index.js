// The dialogs of sharing: a link with its QR code, a link that was opened, a field for one.

import { copyText } from "../browser/clipboard.js";
import { download } from "../browser/download.js";
import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { isShipped, LONGEST_LINK, LONGEST_QR } from "./link.js";
import { qrImage } from "./qr_image.js";

import "./sharing.css";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("./link.js").Item} Item */
/** @typedef {{ title: string, meta: string }} Description   of an item, in words */
/** @typedef {{ verb: string, text: string, look: string, act: () => unknown }} Choice */

const MIME = { program: "application/xml", playground: "application/json", mission: "application/octet-stream" };

/** Save an item on the user's computer. @param {Item} item */
export function save({ kind, name, content }) {
  download(name, content, MIME[kind]);
}

/** @param {string} title @param {readonly Node[]} content @param {readonly Choice[]} choices @param {Translate} t */
function dialogOf(title, content, choices, t) {
  const close = () => dialog.close();
  const buttons = choices.map(({ verb, text, look, act }) =>
    h("button", { type: "button", class: `btn ${look}`, "data-share": verb, onclick: act }, text),
  );
  const dialog = h(
    "dialog",
    { class: "dialog sharing", "aria-labelledby": "sharing-title" },
    h(
      "div",
      { class: "sharing-head" },
      h("h2", { id: "sharing-title", class: "grow" }, title),
      h("button", { type: "button", class: "btn icon", title: t("close"), "aria-label": t("close"), onclick: close }, icon("close")),
    ),
    ...content,
    h("div", { class: "row sharing-buttons" }, ...buttons),
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

/** A sentence. @param {string} text @param {string} [look] */
const line = (text, look = "small muted") => h("p", { class: look }, text);

/**
 * A link of an item, to copy, and its QR code.
 *
 * @param {object} options
 * @param {Translate} options.t
 * @param {Item} options.item
 * @param {Description} options.about
 * @param {string} options.address     the whole link
 * @param {boolean} options.isLocal    whether only this computer reaches the address
 */
export function openShare({ t, item, about, address, isLocal }) {
  const size = { found: address.length, most: LONGEST_LINK };
  const saving = { verb: "save", text: t("save"), act: () => save(item) };
  const title = t("title", { name: item.name });
  if (address.length > LONGEST_LINK) {
    dialogOf(title, [line(about.meta), line(t("tooLong", size), "note-box wait")], [{ ...saving, look: "you" }], t);
    return;
  }
  const field = h("input", { class: "input", readonly: true, "aria-label": t("link"), onfocus: () => field.select() });
  field.value = address;
  const said = h("span", { class: "small muted grow", role: "status" });
  const copy = async () => setText(said, t((await copyText(address)) ? "copied" : "copyByHand"));
  const fits = address.length <= LONGEST_QR;
  const picture = fits ? [qrImage(address, t("qr"))] : [line(t("noQr", { ...size, most: LONGEST_QR }))];
  dialogOf(
    title,
    [
      line(about.meta),
      ...picture,
      h("div", { class: "row sharing-link" }, field, h("button", { type: "button", class: "btn you", "data-share": "copy", onclick: copy }, icon("copy"), t("copy"))),
      said,
      line(t(`holds.${item.kind}`, { found: address.length })),
      ...(isLocal ? [line(t("local"), "note-box wait")] : []),
    ],
    [{ ...saving, look: "line" }],
    t,
  );
}

/**
 * An item of a link: the user decides.
 *
 * @param {object} options
 * @param {Translate} options.t
 * @param {Item} options.item
 * @param {Description} options.about
 * @param {string} options.heading
 * @param {() => unknown} options.open    opens it; own work stays
 * @param {() => void} options.decided    called when the dialog closes
 */
export function openReceived({ t, item, about, heading, open, decided }) {
  const finish = (/** @type {() => unknown} */ act) => () => {
    dialog.close();
    void act();
  };
  const dialog = dialogOf(
    heading,
    [h("p", { class: "sharing-name" }, about.title), line(about.meta), line(t(`keeps.${item.kind}`))],
    [
      { verb: "later", text: t("later"), look: "line", act: finish(() => {}) },
      ...(isShipped(item) ? [] : [{ verb: "save", text: t("save"), look: "line", act: () => save(item) }]),
      { verb: "open", text: t(`open.${item.kind}`), look: "you", act: finish(open) },
    ],
    t,
  );
  dialog.addEventListener("close", decided);
}

/** A field for a link. @param {{ t: Translate, trouble: string, open: (text: string) => void }} options  trouble: why the last one was refused */
export function openField({ t, trouble, open }) {
  const field = h("textarea", { class: "input", id: "sharing-paste", rows: "4", spellcheck: "false", autocomplete: "off", "aria-describedby": "sharing-trouble" });
  const finish = () => {
    dialog.close();
    open(field.value);
  };
  const dialog = dialogOf(
    t("field.title"),
    [
      h("p", { class: "note-box stop", id: "sharing-trouble", role: "alert", hidden: trouble === "" }, trouble),
      h("label", { for: "sharing-paste" }, t("field.label")),
      field,
    ],
    [{ verb: "paste", text: t("field.open"), look: "you", act: finish }],
    t,
  );
  field.focus();
}
