// The constants of the program: edited in place, stored in the file.

import { h, renew, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { GREATEST, LEAST } from "../aesl.js";
import { parseNumbers } from "../numbers.js";
import { entryForm } from "./entry_form.js";

/** A part of the values. @param {Pick<import("./index.js").ToolContext, "t" | "define">} context */
export function constantsPart({ t, define }) {
  const body = h("tbody");
  const errorText = h("p", { class: "fault", role: "alert", hidden: true });
  let listed = "";

  /** @param {string} name @param {number} value */
  const rowOf = (name, value) => {
    const input = h("input", { type: "text", inputmode: "numeric", value, "aria-label": name, "data-constant": name });
    input.addEventListener("change", () => {
      const { values, problem } = parseNumbers(input.value, 1);
      errorText.hidden = values !== null;
      if (values !== null) return define("constant", name, values[0]);
      setText(errorText, `${name}: ${t(problem.key, problem.values)}`);
      input.value = String(value);
    });
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, name),
      h("td", {}, input),
      h(
        "td",
        { class: "mark" },
        h(
          "button",
          {
            type: "button",
            class: "btn icon",
            "aria-label": t("remove", { name }),
            title: t("remove", { name }),
            onclick: () => define("constant", name, null),
          },
          icon("close", { small: true }),
        ),
      ),
    );
  };

  const form = entryForm({
    t,
    kind: "constant",
    least: LEAST,
    greatest: GREATEST,
    label: t("value"),
    add: (name, value) => define("constant", name, value),
  });
  return {
    element: h(
      "details",
      { class: "constants disc" },
      h("summary", {}, h("span", {}, t("tool.constants")), icon("caretDown", { small: true })),
      h("table", {}, body),
      errorText,
      form,
    ),
    /** @param {import("../aesl.js").Aesl} file */
    render(file) {
      const signature = JSON.stringify(file.constants.map(({ name, value }) => [name, value]));
      if (signature === listed) return;
      listed = signature;
      renew(
        body,
        file.constants.map(({ name, value }) => rowOf(name, value)),
      );
    },
  };
}
