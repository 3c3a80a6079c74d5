// A tile for each robot of the class: dot with number, name, state. Only tiles that changed are written to.

import { robotNames } from "../browser/robot_names.js";
import { robotColor } from "../state/robot_colors.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("./class_states.js").Member} Member */
/** @typedef {import("./class_states.js").ClassState} ClassState */

/** @type {Readonly<Record<ClassState, import("../ui/icons.js").IconName | null>>} */
const ICONS = { runs: "check", stopped: "stop", halted: "halt", mistake: "warning", fell: "warning", idle: null };

export class Tiles {
  /**
   * @param {import("../i18n/index.js").Translate} t
   * @param {(robot: string) => void} select
   */
  constructor(t, select) {
    this.t = t;
    this.select = select;
    /** Whether the names are being edited. */
    this.isEditing = false;
    this.element = h("ul", { class: "class-tiles", "aria-label": t("class") });
    /** @type {Map<string, { element: HTMLElement, shown: string }>} */ this.tiles = new Map();
  }

  /** @param {boolean} editing */
  setEditing(editing) {
    this.isEditing = editing;
    this.tiles.clear();
  }

  /**
   * @param {readonly Member[]} members    those to show
   * @param {readonly string[]} names      of all robots
   * @param {string} selected
   */
  show(members, names, selected) {
    const elements = members.map((member) => this.#shown(member, names, member.robot === selected));
    const { children } = this.element;
    if (elements.length === children.length && elements.every((element, at) => element === children[at])) return;
    const focused = document.activeElement;
    this.element.replaceChildren(...elements);
    if (focused instanceof HTMLElement && this.element.contains(focused)) focused.focus();
  }

  /** The tile of a robot, up to date. @param {Member} member @param {readonly string[]} names @param {boolean} isSelected */
  #shown(member, names, isSelected) {
    const { robot, number, state } = member;
    const color = robotColor(names, robot);
    const signature = `${number} ${state} ${isSelected} ${color} ${robotNames.of(robot)}`;
    let tile = this.tiles.get(robot);
    if (tile === undefined) {
      tile = { element: this.isEditing ? this.#field(robot) : this.#button(robot), shown: "" };
      this.tiles.set(robot, tile);
    }
    if (tile.shown === signature) return tile.element;
    tile.shown = signature;
    const { element } = tile;
    const dot = /** @type {HTMLElement} */ (element.querySelector(".class-dot"));
    setText(dot, number);
    setAttribute(dot, "style", `--color: ${color}`);
    if (this.isEditing) setAttribute(element.querySelector("input") ?? dot, "aria-label", this.t("names.of", { number }));
    else this.#write(element, member, isSelected);
    return element;
  }

  /** @param {HTMLElement} element @param {Member} member @param {boolean} isSelected */
  #write(element, { robot, state }, isSelected) {
    const button = /** @type {HTMLElement} */ (element.querySelector("button"));
    const word = /** @type {HTMLElement} */ (element.querySelector(".class-state"));
    setAttribute(button, "aria-pressed", String(isSelected));
    setText(/** @type {HTMLElement} */ (element.querySelector(".class-name")), robotNames.title(robot));
    if (word.dataset.state === state) return;
    word.dataset.state = state;
    const symbol = ICONS[state];
    word.replaceChildren(symbol === null ? h("span", { class: "class-idle" }) : icon(symbol, { small: true }), this.t(`state.${state}`));
  }

  /** @param {string} robot */
  #button(robot) {
    return h(
      "li",
      {},
      h(
        "button",
        { type: "button", class: "class-tile", "data-robot": robot, onclick: () => this.select(robot) },
        h("span", { class: "class-dot num" }),
        h("span", { class: "class-name" }),
        h("span", { class: "class-state" }),
      ),
    );
  }

  /** @param {string} robot */
  #field(robot) {
    const field = h("input", { class: "class-field", "data-name-of": robot, placeholder: robot, maxlength: 20, autocomplete: "off" });
    field.value = robotNames.of(robot);
    field.addEventListener("input", () => robotNames.set(robot, field.value));
    field.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      const fields = /** @type {HTMLInputElement[]} */ ([...this.element.querySelectorAll("input")]);
      fields[(fields.indexOf(field) + 1) % fields.length].focus();
    });
    return h("li", { class: "class-edit" }, h("span", { class: "class-dot num" }), field);
  }
}
