// The form of the playground as a whole: description and main ground. Its title is in the head.

import { h } from "../ui/dom.js";
import { grounded, groundOf, titled } from "./commands.js";
import { control } from "./fields.js";
import { BUILT_IN } from "../playground/declarations.js";
import { kindNamed, shapeKinds } from "../playground/kinds/index.js";
import { fits } from "../playground/rules.js";
import { valuesOf } from "../playground/parts.js";

/** @typedef {import("./fields.js").Control} Control */

/** Fields of the ground that are shown here; the others appear when it is selected. */
const GROUND_KEYS = ["size_x_m", "size_y_m", "side_m", "color", "walls"];

/** The usual ground comes first. @param {string} kind */
const rank = (kind) => (kind === "rectangle" ? 0 : 1);

/**
 * @param {Omit<import("./fields.js").Setting, "commit">} setting
 * @param {import("./creator_model.js").CreatorModel} model
 */
export function playgroundForm(setting, model) {
  const { t } = setting.labels;
  /** @param {Record<string, any>} values */
  const describe = (values) => {
    if (!fits(BUILT_IN.titles.description, values.description)) return { word: "problem.line" };
    return model.replacePlayground(titled(model.playground, values), { word: "change.titled" });
  };
  const description = control({ ...setting, commit: describe }, "description", BUILT_IN.titles.description);
  const select = h("select", { id: "creator-ground", class: "input", "data-field": "ground" });
  const grounds = shapeKinds().filter(({ group }) => group === "ground");
  const names = [...grounds.map(({ name }) => name).sort((one, other) => rank(one) - rank(other)), "none"];
  select.append(...names.map((name) => h("option", { value: name }, setting.labels.ground(name))));
  select.addEventListener("change", () =>
    model.replacePlayground(grounded(model.playground, select.value), { word: "change.ground" }),
  );
  const fields = h("div", { class: "fields" });
  const element = h(
    "section",
    { class: "playground-form" },
    ...(description === null ? [] : [description.element]),
    h("div", { class: "field" }, h("label", { class: "cap", for: "creator-ground" }, t("ground")), select),
    fields,
  );
  /** @type {Control[]} */ let controls = [];
  let shownKind = "";

  /** @param {Record<string, any>} values */
  const change = (values) => {
    const ground = groundOf(model.playground);
    if (ground === null) return null;
    const before = model.selected;
    model.selected = ground.name;
    const problem = model.edit(values);
    model.selected = before;
    model.changed();
    return problem;
  };

  return {
    element,
    render() {
      element.hidden = model.placing !== null || model.item !== null;
      if (element.hidden) return;
      description?.update(model.playground);
      const ground = groundOf(model.playground);
      select.value = ground?.kind ?? "none";
      const kind = `${ground?.name} ${ground?.kind}`;
      if (kind !== shownKind) {
        shownKind = kind;
        const own = Object.entries(kindNamed(ground?.kind ?? "")?.fields ?? {}).filter(([key]) =>
          GROUND_KEYS.includes(key),
        );
        controls = own.flatMap(([key, field]) => control({ ...setting, commit: change }, key, field) ?? []);
        fields.replaceChildren(...controls.map((one) => one.element));
      }
      if (ground !== null) for (const one of controls) one.update(valuesOf(ground));
    },
  };
}
