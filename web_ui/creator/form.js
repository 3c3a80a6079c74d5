// The form of the item being placed or selected: what it is and how large it is; position, name, and what a movable
// thing is like behind "Details".

import { h, renew, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { kindNamed, ROBOT } from "../playground/kinds/index.js";
import { valuesOf } from "../playground/parts.js";
import { canTurn } from "./place.js";
import { control } from "./fields.js";
import { LOAD_KEYS, loadControls } from "./load.js";

/** @typedef {import("./fields.js").Setting} Setting */
/** @typedef {import("./fields.js").Control} Control */

/** The order of the fields; others of a plug-in come after them. */
const FIRST = ["size_x_m", "size_y_m", "side_m", "radius_m", "unit_m", "width_m", "height_m", "color", "door", "walls"];
/** Fields behind "Details", in this order. */
const DETAILS = [
  "name",
  "x_m",
  "y_m",
  "start_x_m",
  "start_y_m",
  "end_x_m",
  "end_y_m",
  "closed_x_m",
  "closed_y_m",
  "opened_x_m",
  "opened_y_m",
  "yaw_rad",
  "corner_radius_m",
  "points_m",
  "area_m",
  "move_s",
];

/** @param {readonly string[]} order @param {string} key */
const rank = (order, key) => (order.includes(key) ? order.indexOf(key) : order.length);

/** @param {Omit<Setting, "commit">} setting @param {import("./creator_model.js").CreatorModel} model */
export function itemForm(setting, model) {
  const { labels } = setting;
  const { t } = labels;
  const title = h("h3", { class: "grow" });
  const name = h("span", { class: "chip" });
  const fields = h("div", { class: "fields" });
  const inner = h("div", { class: "fields" });
  const verbs = /** @type {const} */ ([
    { name: "turnLeft", drawing: "turn", word: "action.turnLeft", act: () => model.turn(1) },
    { name: "turnRight", drawing: "turn", word: "action.turnRight", act: () => model.turn(-1) },
    { name: "over", drawing: "caretUp", word: "action.over", act: () => model.selecting.raise(1) },
    { name: "under", drawing: "caretDown", word: "action.under", act: () => model.selecting.raise(-1) },
  ]).map((verb) => ({
    name: verb.name,
    button: h(
      "button",
      {
        type: "button",
        class: "btn line icon",
        title: t(verb.word),
        "aria-label": t(verb.word),
        onclick: verb.act,
        "data-verb": verb.name,
      },
      icon(verb.drawing),
    ),
  }));
  const caret = h("span", { class: "turns" }, icon("caretDown", { small: true }));
  const details = h(
    "details",
    { class: "item-details disc" },
    h("summary", {}, icon("sliders", { small: true }), h("span", { class: "grow" }, t("form.details")), caret),
    inner,
    h("div", { class: "row verbs" }, ...verbs.map(({ button }) => button)),
  );
  const element = h("section", { class: "item-form" }, h("div", { class: "row" }, title, name), fields, details);
  /** @type {Control[]} */ let main = [];
  /** @type {Control[]} */ let more = [];
  let shownKind = "";

  /** @param {string} kind @param {boolean} placing */
  const build = (kind, placing) => {
    const { fields: own = {}, points = [], path, isRelative } = kindNamed(kind) ?? {};
    const all = { name: ROBOT.fields.name, ...own };
    const fromPointer = ["name", ...(points.length > 1 ? points.flat() : []), ...(isRelative ? [] : [path])];
    const full = { ...setting, kind, commit: model.edit.bind(model) };
    const isMovable = own.mass_kg?.nullable === true;
    /** @param {boolean} isDetail @param {readonly string[]} order */
    const controls = (isDetail, order) =>
      Object.entries(all)
        .filter(([key]) => DETAILS.includes(key) === isDetail)
        .filter(([key]) => !(isMovable && LOAD_KEYS.includes(key)) && !(placing && fromPointer.includes(key)))
        .sort(([one], [other]) => rank(order, one) - rank(order, other))
        .flatMap(([key, field]) => control(full, key, field) ?? []);
    main = controls(false, FIRST);
    more = controls(true, DETAILS);
    if (!isMovable) return;
    const load = loadControls(full, own);
    main.push(load.whether);
    more.push(...load.how);
  };

  return {
    element,
    /** Move the focus to the first value. */
    focus: () => {
      const first = fields.querySelector("input, select");
      if (first === null) details.open = true;
      /** @type {HTMLElement | null} */ (first ?? inner.querySelector("input, select"))?.focus();
    },
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
      const called = labels.kind(shown.kind);
      setText(title, placing === null ? called : t("form.new", { kind: called }));
      setText(name, placing === null ? shown.name : "");
      const values = valuesOf(shown);
      for (const one of [...main, ...more]) one.update(values);
      if (isOther) {
        renew(fields, main.map((one) => one.element)); // also when the same item was renamed
        renew(inner, more.map((one) => one.element));
      }
      for (const { name: verb, button } of verbs) {
        const turns = verb === "turnLeft" || verb === "turnRight";
        button.hidden = turns ? !canTurn(shown) || placing?.isPath === true : placing !== null;
      }
    },
  };
}
