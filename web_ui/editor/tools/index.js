// The tools beside the text, one tab each. To add one: a file, and a line here.

import { h, setAttribute } from "../../ui/dom.js";
import { eventsTool } from "./events.js";
import { plotTool } from "./plot.js";
import { referenceTool } from "./reference.js";
import { valuesTool } from "./values.js";

/**
 * @typedef {object} View   the data that tools draw
 * @property {string} robot
 * @property {import("../state.js").Target | null} target
 * @property {import("../state.js").Variables | null} variables
 * @property {readonly import("../state.js").LoggedEvent[]} log
 * @property {import("../aesl.js").Aesl} file
 * @property {string} code   of the shown text
 * @property {string} disabledReason   why robots cannot be controlled; empty if they can
 */
/**
 * @typedef {object} ToolContext
 * @property {import("../../i18n/index.js").Translate} t
 * @property {import("../editor_session.js").EditorSession} session
 * @property {(text: string) => void} announce
 * @property {(text: string) => void} insert          inserts text into the program at the cursor
 * @property {(name: string, values: number[]) => Promise<{ ok: boolean, message: string }>} setVariable
 * @property {(event: string, values: number[]) => void} emit
 * @property {(kind: "event" | "constant", name: string, value: number | null) => void} define
 * @property {() => void} redraw
 */
/** @typedef {{ name: string, element: HTMLElement, render: (view: View) => void }} Tool */

/** @type {((context: ToolContext) => Tool)[]} */
const TOOLS = [valuesTool, eventsTool, plotTool, referenceTool];

/** @param {ToolContext} context */
export function toolbox(context) {
  const { t, session } = context;
  const tools = TOOLS.map((create) => create(context));
  const tabs = tools.map(({ name }) =>
    h(
      "button",
      {
        type: "button",
        class: "tool-tab",
        role: "tab",
        id: `tool-tab-${name}`,
        "aria-controls": `tool-${name}`,
        onclick: () => choose(name),
      },
      t(`tool.${name}`),
    ),
  );
  const panels = tools.map(({ name, element }) =>
    h("div", { role: "tabpanel", class: "tool", id: `tool-${name}`, "aria-labelledby": `tool-tab-${name}` }, element),
  );
  /** @param {string} name */
  const choose = (name) => {
    session.tool = name;
    context.redraw();
  };
  const list = h("div", { role: "tablist", class: "tool-tabs", "aria-label": t("tools") }, ...tabs);
  list.addEventListener("keydown", ({ key }) => {
    const step = key === "ArrowRight" ? 1 : key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    const index = (tools.findIndex(({ name }) => name === session.tool) + step + tools.length) % tools.length;
    choose(tools[index].name);
    tabs[index].focus();
  });
  return {
    element: h("div", { class: "tools" }, list, ...panels),
    /** @param {View} view */
    render(view) {
      tools.forEach((tool, index) => {
        const chosen = tool.name === session.tool;
        setAttribute(tabs[index], "aria-selected", String(chosen));
        setAttribute(tabs[index], "tabindex", chosen ? "0" : "-1");
        panels[index].hidden = !chosen;
        if (chosen) tool.render(view);
      });
    },
  };
}
