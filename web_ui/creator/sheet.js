// The form of the playground as a whole: title, description, main ground.

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
export function sheetForm(setting, model) {
  const { t } = setting.labels;
  /** @param {Record<string, any>} values */
  const title = (values) => {
    if (!fits(BUILT_IN.titles.title, values.title ?? values.description ?? "")) return { word: "problem.line" };
    return model.replacePlayground(titled(model.playground, values), { word: "change.titled" });
  };
  const titles = Object.entries(BUILT_IN.titles).map(([key, field]) => control({ ...setting, commit: title }, key, field));
  const select = h("select", { id: "creator-ground", "data-field": "ground" });
  const grounds = shapeKinds().filter(({ group }) => group === "ground");
  const names = [...grounds.map(({ name }) => name).sort((one, other) => rank(one) - rank(other)), "none"];
  select.append(...names.map((name) => h("option", { value: name }, setting.labels.ground(name))));
  select.addEventListener("change", () =>
    model.replacePlayground(grounded(model.playground, select.value), { word: "change.ground" }),
  );
  const fields = h("div", { class: "fields" });
  const element = h(
    "section",
    { class: "sheet" },
    h("div", { class: "fields wide" }, ...titles.flatMap((one) => (one === null ? [] : [one.element]))),
    h("div", { class: "field" }, h("label", { for: "creator-ground" }, t("ground")), select),
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
      for (const one of titles) one?.update(model.playground);
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
