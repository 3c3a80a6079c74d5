// The form of the item being placed or selected: what it is and how large it is; position, name, and what a movable
// thing is like behind "Details".

import { kindNamed, ROBOT } from "../playground/kinds/index.js";
import { valuesOf } from "../playground/parts.js";
import { h, renew, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { control } from "./fields.js";
import { LOAD_KEYS, loadControls } from "./load.js";
import { canTurn } from "./place.js";

/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {import("./creator_model.js").CreatorModel} CreatorModel */
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

export class ItemForm {
  /** The controls of the fields, and of those behind "Details". @type {{ main: Control[], more: Control[] }} */
  #controls = { main: [], more: [] };
  #shownKind = "";

  /** @param {Omit<Setting, "commit">} setting @param {CreatorModel} model */
  constructor(setting, model) {
    const { t } = setting.labels;
    this.setting = setting;
    this.model = model;
    this.title = h("h3", { class: "grow" });
    this.name = h("span", { class: "chip" });
    this.fields = h("div", { class: "fields" });
    this.inner = h("div", { class: "fields" });
    this.verbs = verbButtons(t, model);
    const caret = h("span", { class: "turns" }, icon("caretDown", { small: true }));
    this.details = h(
      "details",
      { class: "item-details disc" },
      h("summary", {}, icon("sliders", { small: true }), h("span", { class: "grow" }, t("form.details")), caret),
      this.inner,
      this.verbs.element,
    );
    this.element = h(
      "section",
      { class: "item-form" },
      h("div", { class: "row" }, this.title, this.name),
      this.fields,
      this.details,
    );
  }

  /** Move the focus to the first value. */
  focus() {
    const first = this.fields.querySelector("input, select");
    if (first === null) this.details.open = true;
    /** @type {HTMLElement | null} */ (first ?? this.inner.querySelector("input, select"))?.focus();
  }

  render() {
    const { placing, item } = this.model;
    const shown = shownItem(this.model);
    this.element.hidden = shown === null;
    if (shown === null) return;
    const kind = `${placing === null ? item?.name : "new"} ${shown.kind}`;
    const isOther = kind !== this.#shownKind;
    this.#shownKind = kind;
    if (isOther) this.#controls = controlsOf(this.setting, this.model, shown.kind);
    const { main, more } = this.#controls;
    const { labels } = this.setting;
    const called = labels.kind(shown.kind);
    setText(this.title, placing === null ? called : labels.t("form.new", { kind: called }));
    setText(this.name, placing === null ? shown.name : "");
    const values = valuesOf(shown);
    for (const one of [...main, ...more]) one.update(values);
    if (isOther) {
      renew(this.fields, main.map((one) => one.element)); // also when the same item was renamed
      renew(this.inner, more.map((one) => one.element));
    }
    this.verbs.render(shown);
  }
}

/**
 * The item that the form is about: the one being placed, else the selected one.
 *
 * @param {CreatorModel} model
 * @returns {Item | null}
 */
function shownItem({ placing, item }) {
  if (placing === null) return item;
  return placing.isPath ? placing.pattern : (placing.ghost?.item ?? placing.pattern);
}

/**
 * The controls for an item of a kind.
 *
 * @param {Omit<Setting, "commit">} setting
 * @param {CreatorModel} model
 * @param {string} kind
 */
function controlsOf(setting, model, kind) {
  const { fields: own = {}, points = [], path, isRelative } = kindNamed(kind) ?? {};
  const all = { name: ROBOT.fields.name, ...own };
  const fromPointer = ["name", ...(points.length > 1 ? points.flat() : []), ...(isRelative ? [] : [path])];
  const full = { ...setting, kind, commit: model.edit.bind(model) };
  const isMovable = own.mass_kg?.nullable === true;
  const isPlacing = model.placing !== null;
  /** @param {boolean} isDetail @param {readonly string[]} order */
  const controls = (isDetail, order) =>
    Object.entries(all)
      .filter(([key]) => DETAILS.includes(key) === isDetail)
      .filter(([key]) => !(isMovable && LOAD_KEYS.includes(key)) && !(isPlacing && fromPointer.includes(key)))
      .sort(([one], [other]) => rank(order, one) - rank(order, other))
      .flatMap(([key, field]) => control(full, key, field) ?? []);
  const [main, more] = [controls(false, FIRST), controls(true, DETAILS)];
  if (!isMovable) return { main, more };
  const load = loadControls(full, own);
  return { main: [...main, load.whether], more: [...more, ...load.how] };
}

/**
 * Turn the item, and put it over or under others.
 *
 * @param {import("../i18n/index.js").Translate} t
 * @param {CreatorModel} model
 */
function verbButtons(t, model) {
  const verbs = /** @type {const} */ ([
    { name: "turnLeft", drawing: "turn", act: () => model.turn(1) },
    { name: "turnRight", drawing: "turn", act: () => model.turn(-1) },
    { name: "over", drawing: "caretUp", act: () => model.selecting.raise(1) },
    { name: "under", drawing: "caretDown", act: () => model.selecting.raise(-1) },
  ]).map(({ name, drawing, act }) => {
    const word = t(`action.${name}`);
    const attributes = { class: "btn line icon", title: word, "aria-label": word, onclick: act, "data-verb": name };
    return { name, button: h("button", { type: "button", ...attributes }, icon(drawing)) };
  });
  return {
    element: h("div", { class: "row verbs" }, ...verbs.map(({ button }) => button)),
    /** @param {Item} shown */
    render(shown) {
      const { placing } = model;
      for (const { name, button } of verbs) {
        const turns = name === "turnLeft" || name === "turnRight";
        button.hidden = turns ? !canTurn(shown) || placing?.isPath === true : placing !== null;
      }
    },
  };
}
