// The field that takes the place of a value while it is edited.

import { h } from "../../ui/dom.js";
import { parseNumbers } from "../numbers.js";

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {string} options.name
 * @param {readonly number[]} options.before   the value until now
 * @param {HTMLElement} options.cell           shows the value; it returns when the field is closed
 * @param {(values: number[]) => Promise<{ ok: boolean, message: string }>} options.send
 * @param {(problem: string) => void} options.report   empty: there is none any more
 * @param {(values: number[]) => void} options.done
 */
export function editValue({ t, name, before, cell, send, report, done }) {
  const label = t("variables.edit", { name });
  const input = h("input", { type: "text", class: "input", value: before.join(" "), "aria-label": label });
  let isOpen = true;
  /** @param {{ focus: boolean }} where */
  const close = ({ focus }) => {
    if (!isOpen) return;
    isOpen = false; // removing the element blurs it, which calls this function again
    report("");
    input.replaceWith(cell);
    if (focus) cell.focus();
  };
  /** @param {string} text */
  const refuse = (text) => {
    report(`${name}: ${text}`);
    input.setAttribute("aria-invalid", "true");
  };
  const submit = async () => {
    const { values, problem } = parseNumbers(input.value, before.length);
    if (values === null) return refuse(t(problem.key, problem.values));
    const { ok, message } = await send(values);
    if (!ok) return refuse(message);
    close({ focus: true });
    done(values);
  };
  input.addEventListener("keydown", ({ key }) => {
    if (key === "Escape") close({ focus: true });
    if (key === "Enter") void submit();
  });
  input.addEventListener("blur", () => close({ focus: false }));
  cell.replaceWith(input);
  input.select();
  input.focus();
}
