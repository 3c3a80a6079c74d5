// A QR code as an image, drawn by this page: the link need not be sent to a server.

import { encodeQR } from "qr";

import { h } from "../ui/dom.js";

/** @param {string} text  at most `LONGEST_QR` bytes @param {string} alt */
export function qrImage(text, alt) {
  const drawn = encodeQR(text, "svg", { ecc: "low", border: 2 });
  return h("img", { class: "sharing-qr", src: `data:image/svg+xml,${encodeURIComponent(drawn)}`, alt });
}
