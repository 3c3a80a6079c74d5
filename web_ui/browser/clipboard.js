// Copies text to the clipboard. Pages that are not from this machine have no clipboard API; there a selection is used.

import { h } from "../ui/dom.js";

/** Returns whether the text was copied. @param {string} text */
export async function copyText(text) {
  if (navigator.clipboard !== undefined) {
    const written = await navigator.clipboard.writeText(text).then(
      () => true,
      () => false,
    );
    if (written) return true;
  }
  const field = h("textarea", { class: "vh", "aria-hidden": "true" });
  field.value = text;
  // Inside an open dialog: elements outside it cannot have the focus.
  (document.querySelector("dialog:modal") ?? document.body).append(field);
  field.select();
  const done = document.execCommand("copy");
  field.remove();
  return done;
}
