// The plot of watched values: a canvas with one line per value, and CSV export.

import { download } from "../../browser/download.js";
import { h, setText } from "../../ui/dom.js";
import { csv } from "../numbers.js";
import { drawPlot, STYLES } from "../plot.js";

const SPANS = [5, 10, 30, 60, 300]; // seconds

/** @param {import("./index.js").ToolContext} context @returns {import("./index.js").Tool} */
export function plotTool({ t, session, redraw }) {
  const canvas = h("canvas", { class: "plot", role: "img", "aria-label": t("tool.plot") });
  const legend = h("ul", { class: "legend" });
  const nothing = h("p", { class: "nothing" }, t("plot.none"));
  const span = h(
    "select",
    { class: "select", "aria-label": t("plot.span"), onchange: redraw },
    ...SPANS.map((seconds) => h("option", { value: seconds, selected: seconds === 10 }, `${seconds} s`)),
  );
  let paused = false;
  let listed = "";
  const pause = h(
    "button",
    {
      type: "button",
      class: "btn line note slim",
      "aria-pressed": "false",
      onclick: () => {
        paused = !paused;
        pause.setAttribute("aria-pressed", String(paused));
        redraw();
      },
    },
    t("plot.pause"),
  );
  return {
    name: "plot",
    element: h(
      "div",
      { class: "plotting" },
      h(
        "div",
        { class: "row" },
        span,
        pause,
        h(
          "button",
          {
            type: "button",
            class: "btn note slim",
            onclick: () => {
              session.history.clear();
              redraw();
            },
          },
          t("clear"),
        ),
        h(
          "button",
          { type: "button", class: "btn note slim", onclick: () => download("plot.csv", csv(session.history.rows()), "text/csv") },
          "CSV",
        ),
      ),
      nothing,
      canvas,
      legend,
    ),
    render() {
      const series = [...session.history.series.values()];
      nothing.hidden = series.length > 0;
      if (paused) return;
      drawPlot(canvas, series, Number(span.value));
      const names = series.map(({ name }) => name).join();
      if (names !== listed) {
        listed = names;
        legend.replaceChildren(
          ...series.map(({ name }, index) => {
            const { color, mark } = STYLES[index % STYLES.length];
            return h(
              "li",
              {},
              h("b", { style: `color: ${color}`, "aria-hidden": "true" }, mark),
              ` ${name} `,
              h("output", {}),
            );
          }),
        );
      }
      series.forEach(({ values }, index) => {
        const output = legend.children[index]?.querySelector("output");
        if (output) setText(output, String(values.at(-1) ?? ""));
      });
    },
  };
}
