// The tools in named groups: each places a kind of item. Those of plug-ins have a group of their own.

import { kindNamed, shapeKinds } from "../playground/kinds/index.js";
import { h, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { readPicture } from "./read_picture.js";

/** The groups in display order, their tools, and the icon of each tool. */
const GROUPS = /** @type {const} */ ({
  ground: { rectangle: "rectangle", octagon: "octagon", picture: "image", track: "track" },
  things: { box: "box", cylinder: "post", wall: "wall", u_figure: "uShape" },
  doors: { door: "door", activation: "plate", robot: "robot" },
});

/**
 * @param {object} options
 * @param {import("../playground/labels.js").Labels} options.labels
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
  /** @type {{ tool: string, button: HTMLButtonElement }[]} */ const buttons = [];
  /** @param {string} tool @param {import("../ui/icons.js").IconName} drawing */
  const toolButton = (tool, drawing) => {
    const button = h(
      "button",
      { type: "button", class: "build-tool", title: labels.help(tool), "data-tool": tool, onclick: () => choose(tool) },
      icon(drawing),
      h("span", {}, labels.kind(tool)),
    );
    buttons.push({ tool, button });
    return button;
  };
  /** @param {string} name @param {readonly (readonly [string, import("../ui/icons.js").IconName])[]} tools */
  const group = (name, tools) =>
    h(
      "section",
      { class: "tool-group", role: "group", "aria-labelledby": `creator-group-${name}`, style: `--tools: ${tools.length}` },
      h("h3", { class: "cap", id: `creator-group-${name}` }, t(`group.${name}`)),
      h("div", { class: "tool-grid" }, ...tools.map(([tool, drawing]) => toolButton(tool, drawing))),
    );
  const groups = Object.entries(GROUPS).map(([name, tools]) => group(name, Object.entries(tools)));
  const listed = buttons.map(({ tool }) => tool);
  const added = shapeKinds().flatMap(({ name }) => (listed.includes(name) ? [] : [/** @type {const} */ ([name, "plugin"])]));
  if (added.length > 0) groups.push(group("plugins", added));

  /** @param {string} tool */
  function choose(tool) {
    const fields = kindNamed(tool)?.fields ?? {};
    const key = Object.keys(fields).find((name) => fields[name].type === "image" && fields[name].required);
    if (key !== undefined) {
      wanted = { kind: tool, key };
      return file.click();
    }
    model.choose(model.placing?.kind === tool ? null : tool); // a second click ends placing
    canvas.focus();
  }
  const element = h("div", { class: "palette", role: "group", "aria-label": t("palette") }, ...groups, file);
  return {
    element,
    render() {
      for (const { tool, button } of buttons) setAttribute(button, "aria-pressed", String(tool === model.placing?.kind));
    },
  };
}
