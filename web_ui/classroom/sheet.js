// The sheet of links and QR codes, to print and cut.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** The image of a QR code; none where the server cannot draw it. @param {string} qr */
export function qrImages(qr) {
  return qr === "" ? [] : [h("img", { src: `data:image/svg+xml,${encodeURIComponent(qr)}`, alt: "" })];
}

/**
 * @param {readonly { name: string, url: string, qr: string }[]} links
 * @param {import("../i18n/index.js").Translate} t
 * @param {() => void} close
 */
export function sheetOf(links, t, close) {
  return h(
    "section",
    { class: "class-sheet", "aria-label": t("sheet") },
    h(
      "div",
      { class: "row class-bar" },
      h("button", { type: "button", class: "btn line", "data-verb": "back", onclick: close }, icon("undo"), t("back")),
      h("p", { class: "small muted grow" }, t("sheet.help")),
      h("button", { type: "button", class: "btn you", "data-verb": "print", onclick: () => window.print() }, t("print")),
    ),
    h(
      "ul",
      { class: "class-links" },
      ...links.map(({ name, url, qr }) =>
        h(
          "li",
          { class: "class-link" },
          ...qrImages(qr),
          h("div", { class: "grow" }, h("h2", {}, name), h("a", { href: url, target: "_blank", rel: "noreferrer" }, url)),
        ),
      ),
    ),
  );
}
