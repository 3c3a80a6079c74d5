// The tool palette: select, or place an item.

import { h, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { kindNamed, shapeKinds } from "../playground/kinds/index.js";
import { readPicture } from "./read_picture.js";

/** @type {Readonly<Record<string, import("../ui/icons.js").IconName>>} */
const ICONS = {
  select: "select",
  rectangle: "rectangle",
  octagon: "octagon",
  picture: "image",
  track: "track",
  box: "box",
  cylinder: "post",
  wall: "wall",
  u_figure: "uShape",
  door: "door",
  activation: "plate",
  robot: "robot",
};

/** In display order; those of plug-ins come before the robot. */
const TOOLS = [
  "select",
  "rectangle",
  "octagon",
  "picture",
  "track",
  "box",
  "cylinder",
  "wall",
  "u_figure",
  "door",
  "activation",
];

/**
 * @param {object} options
 * @param {import("./labels.js").Labels} options.labels
 * @param {import("./creator_model.js").CreatorModel} options.model
 * @param {HTMLElement} options.canvas   gets the focus so that keys act on the view
 */
export function palette({ labels, model, canvas }) {
  const { t } = labels;
  const file = h("input", {
    type: "file",
    accept: "image/png,image/jpeg,image/svg+xml",
    hidden: true,
    id: "creator-picture",
    "aria-label": t("field.image"),
  });
  /** The kind whose image is chosen by the file input, and its field. */
  let wanted = { kind: "picture", key: "image" };
  file.addEventListener("change", async () => {
    const chosen = file.files?.[0];
    file.value = "";
    if (chosen === undefined) return;
    const image = await readPicture(chosen);
    if (image === null) return model.report({ word: "problem.picture", values: { name: chosen.name } });
    model.choose(wanted.kind, { [wanted.key]: image });
    canvas.focus();
  });
  const added = shapeKinds().flatMap(({ name }) => (TOOLS.includes(name) ? [] : [name]));
  const buttons = [...TOOLS, ...added, "robot"].map((tool) => ({
    tool,
    button: h(
      "button",
      {
        type: "button",
        class: "btn icon",
        title: labels.tool(tool),
        "aria-label": labels.tool(tool),
        "data-tool": tool,
        onclick: () => choose(tool),
      },
      icon(ICONS[tool] ?? "plugin"),
    ),
  }));
  /** @param {string} tool */
  function choose(tool) {
    const fields = kindNamed(tool)?.fields ?? {};
    const key = Object.keys(fields).find((name) => fields[name].type === "image" && fields[name].required);
    if (key !== undefined) {
      wanted = { kind: tool, key };
      return file.click();
    }
    model.choose(tool === "select" ? null : tool);
    canvas.focus();
  }
  const element = h(
    "div",
    { class: "palette", role: "toolbar", "aria-label": t("palette") },
    ...buttons.map(({ button }) => button),
    file,
  );
  return {
    element,
    render() {
      const now = model.placing?.kind ?? "select";
      for (const { tool, button } of buttons) setAttribute(button, "aria-pressed", String(tool === now));
    },
  };
}
