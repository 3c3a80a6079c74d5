// The pen in the hole between the wheels: draws, rubs out, or is lifted.

import { h, setAttribute } from "../../ui/dom.js";
import { HandSettings } from "./settings.js";
import { sheetHand } from "./sheet_hand.js";

/** What the pen does, and the key of its name. */
const TOOLS = /** @type {const} */ ({ down: "hand.pen.down", erase: "hand.pen.erase", up: "hand.pen.up" });
const START = { tool: /** @type {keyof typeof TOOLS} */ ("up"), color: "#c0182a", width: 10 };

/** @param {import("../../shell/context.js").Context} context @returns {import("./index.js").Hand} */
export function penHand({ text, actions, store }) {
  const t = text("stage");
  const settings = new HandSettings(store, START);
  const color = h("input", { type: "color", class: "input" });
  const width = h("input", { type: "number", class: "input", min: 1, max: 100, step: 1 });
  const send = () => {
    const { tool, color: drawn, width: millimeters } = settings.now;
    actions.operate("_pen/width", "std_msgs/msg/Float32", { data: millimeters / 1000 });
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(drawn.slice(at, at + 2), 16) / 255);
    actions.operate("_pen/color", "std_msgs/msg/ColorRGBA", { r, g, b, a: tool === "erase" ? 0 : 1 });
    actions.operate("pen/down", "std_msgs/msg/Bool", { data: tool !== "up" });
  };
  /** @param {Partial<typeof START>} changes */
  const choose = (changes) => {
    settings.change(changes);
    send();
    refresh();
  };
  const names = /** @type {(keyof typeof TOOLS)[]} */ (Object.keys(TOOLS));
  const tools = names.map((tool) => ({
    tool,
    button: h(
      "button",
      { type: "button", class: "btn line", "data-pen": tool, onclick: () => choose({ tool }) },
      t(TOOLS[tool]),
    ),
  }));
  color.addEventListener("change", () => choose({ color: color.value }));
  width.addEventListener("change", () => {
    if (width.value !== "" && width.checkValidity()) choose({ width: Number(width.value) });
  });
  const refresh = () => {
    const { tool: now, color: drawn, width: millimeters } = settings.now;
    for (const { tool, button } of tools) setAttribute(button, "aria-pressed", String(tool === now));
    color.value = drawn;
    width.value = String(millimeters);
  };
  return sheetHand({
    name: "pen",
    drawing: "pen",
    t,
    content: [
      h(
        "div",
        { class: "pen-tools", role: "group", "aria-label": t("hand.pen") },
        ...tools.map(({ button }) => button),
      ),
      h("label", { class: "value" }, h("span", {}, t("hand.pen.color")), color),
      h("label", { class: "value" }, h("span", {}, t("hand.pen.width")), width),
    ],
    isHeld: () => settings.now.tool !== "up",
    refresh,
  });
}
