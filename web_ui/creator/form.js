// The form with all values of the item being placed or selected.

import { h, renew, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { kindNamed, ROBOT } from "../playground/kinds/index.js";
import { valuesOf } from "../playground/parts.js";
import { canTurn } from "./place.js";
import { control, LOAD_KEYS, loadControl } from "./fields.js";

/** @typedef {import("./fields.js").Setting} Setting */
/** @typedef {import("./fields.js").Control} Control */

/** These fields come first: name and position. */
const FIRST = ["name", "x_m", "y_m"];

/** @param {Omit<Setting, "commit">} setting @param {import("./creator_model.js").CreatorModel} model */
export function itemForm(setting, model) {
  const { labels } = setting;
  const { t } = labels;
  const title = h("h3");
  const fields = h("div", { class: "fields" });
  const verbs = /** @type {const} */ ([
    { icon: "turnLeft", drawing: "turn", word: "action.turnLeft", act: () => model.turn(1) },
    { icon: "turnRight", drawing: "turn", word: "action.turnRight", act: () => model.turn(-1) },
    { icon: "copy", drawing: "copy", word: "action.copy", act: () => model.selecting.duplicate() },
    { icon: "over", drawing: "caretUp", word: "action.over", act: () => model.selecting.raise(1) },
    { icon: "under", drawing: "caretDown", word: "action.under", act: () => model.selecting.raise(-1) },
    { icon: "remove", drawing: "remove", word: "action.remove", act: () => model.selecting.remove() },
  ]).map((verb) => ({
    ...verb,
    button: h(
      "button",
      {
        type: "button",
        class: "btn icon square",
        title: t(verb.word),
        "aria-label": t(verb.word),
        onclick: verb.act,
        "data-verb": verb.icon,
      },
      icon(verb.drawing),
    ),
  }));
  const element = h(
    "section",
    { class: "item-form" },
    title,
    h("div", { class: "row verbs-row" }, ...verbs.map(({ button }) => button)),
    fields,
  );
  /** @type {Control[]} */ let controls = [];
  let shownKind = "";

  /** @param {string} kind @param {boolean} placing */
  const build = (kind, placing) => {
    const { fields: own = {}, points = [], path, isRelative } = kindNamed(kind) ?? {};
    const all = { name: ROBOT.fields.name, ...own };
    const fromPointer = ["name", ...(points.length > 1 ? points.flat() : []), ...(isRelative ? [] : [path])];
    const full = { ...setting, kind, commit: model.edit.bind(model) };
    const isMovable = own.mass_kg?.nullable === true;
    /** @param {[string, any]} entry */
    const rank = ([key]) => (FIRST.includes(key) ? FIRST.indexOf(key) : FIRST.length);
    const ordered = Object.entries(all).sort((one, other) => rank(one) - rank(other));
    controls = ordered.flatMap(([key, field]) => {
      if ((isMovable && LOAD_KEYS.includes(key)) || (placing && fromPointer.includes(key))) return [];
      return control(full, key, field) ?? [];
    });
    if (isMovable) controls.push(loadControl(full, own));
  };

  return {
    element,
    focus: () => /** @type {HTMLElement | null} */ (fields.querySelector("input, select"))?.focus(),
    render() {
      const { placing, item } = model;
      const shown =
        placing === null ? item : placing.isPath ? placing.pattern : (placing.ghost?.item ?? placing.pattern);
      element.hidden = shown === null;
      if (shown === null) return;
      const kind = `${placing === null ? item?.name : "new"} ${shown.kind}`;
      const isOther = kind !== shownKind;
      shownKind = kind;
      if (isOther) build(shown.kind, placing !== null);
      setText(
        title,
        placing === null
          ? `${labels.kind(shown.kind)} – ${shown.name}`
          : t("form.new", { kind: labels.kind(shown.kind) }),
      );
      const values = valuesOf(shown);
      for (const one of controls) one.update(values);
      const elements = controls.map((one) => one.element);
      if (isOther) renew(fields, elements); // also when the same item was renamed
      for (const { icon: verb, button } of verbs) {
        const turns = verb === "turnLeft" || verb === "turnRight";
        button.hidden = turns ? !canTurn(shown) || placing?.isPath === true : placing !== null;
      }
    },
  };
}
