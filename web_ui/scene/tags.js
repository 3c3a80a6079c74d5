// Several robots have a dot with a number each, as elements in a layer over the canvas, updated only where something
// changed. The selected one and the one under the pointer have their name beside it. A single robot has neither.

/** @typedef {{ x: number, y: number }} LabelPosition  CSS pixels of the layer */
/**
 * @typedef {object} Tag
 * @property {string} title
 * @property {string} number       what the dot shows
 * @property {string} color        of the dot
 * @property {boolean} isSelected
 * @property {boolean} isHovered   under the pointer, in the view
 * @property {boolean} hasTrouble  needs a look
 */
/** @typedef {{ dot: HTMLButtonElement, name: HTMLElement, place: string, wantsName: boolean }} TagElements */

/** Dots that are closer to each other are moved apart. */
const CLOSE_PX = 22;
const NUDGE_PX = 14;
/** The name begins behind the dot: this far to the left of its center, and as much lower as it is higher. */
const NAME_PX = { left: 16, below: 2 };

/** The number of a robot: the last digits of its name, else its place. @param {string} name @param {number} place  from 1 */
export function numberOf(name, place) {
  return /(\d{1,3})\D*$/.exec(name)?.[1].replace(/^0+(?=\d)/, "") ?? String(place);
}

/**
 * Positions with dots that would cover each other moved apart, in the order of their heights. Pure.
 *
 * @param {readonly (LabelPosition | null)[]} positions
 */
export function nudged(positions) {
  /** @type {LabelPosition[]} */ const taken = [];
  const places = positions.map((position) => (position === null ? null : { ...position }));
  const highFirst = places.filter((place) => place !== null).sort((one, other) => one.y - other.y);
  for (const place of highFirst) {
    for (let tries = 0; tries < 4; tries++) {
      if (!taken.some(({ x, y }) => Math.hypot(x - place.x, y - place.y) < CLOSE_PX)) break;
      place.y += NUDGE_PX;
    }
    taken.push(place);
  }
  return places;
}

export class NameTags {
  /** @param {HTMLElement} layer @param {(robot: string) => void} select */
  constructor(layer, select) {
    this.layer = layer;
    this.select = select;
    /** The robot whose dot is under the pointer or has the focus. */
    this.pointed = "";
    /** @type {Map<string, TagElements>} */ this.tags = new Map();
  }

  /** @param {string} robot @param {Tag} tag */
  show(robot, { title, number, color, isSelected, isHovered, hasTrouble }) {
    const tag = this.tags.get(robot) ?? this.#create(robot);
    const { dot, name } = tag;
    setText(dot, number);
    setText(name, title);
    setAttribute(dot, "aria-label", title.includes(number) ? title : `${number} ${title}`);
    setAttribute(dot, "aria-pressed", String(isSelected));
    if (dot.style.getPropertyValue("--color") !== color) dot.style.setProperty("--color", color);
    for (const element of [dot, name]) element.toggleAttribute("data-selected", isSelected);
    dot.toggleAttribute("data-trouble", hasTrouble);
    tag.wantsName = isSelected || isHovered;
  }

  /**
   * Place all dots by the center of their lower edge; null hides one.
   *
   * @param {ReadonlyMap<string, LabelPosition | null>} positions
   */
  place(positions) {
    const tags = [...this.tags];
    const places = nudged(tags.map(([robot]) => positions.get(robot) ?? null));
    tags.forEach(([robot, tag], index) => {
      const position = places[index];
      const isNamed = position !== null && (tag.wantsName || robot === this.pointed);
      setHidden(tag.dot, position === null);
      setHidden(tag.name, !isNamed);
      if (position === null) return;
      const [x, y] = [Math.round(position.x), Math.round(position.y)];
      const place = `${x} ${y}`;
      if (tag.place === place) return;
      tag.place = place;
      tag.dot.style.transform = `translate(${x}px, ${y}px) translate(-50%, -100%)`;
      tag.name.style.transform = `translate(${x - NAME_PX.left}px, ${y + NAME_PX.below}px) translate(0, -100%)`;
    });
  }

  /** @param {string} robot */
  remove(robot) {
    const tag = this.tags.get(robot);
    tag?.dot.remove();
    tag?.name.remove();
    this.tags.delete(robot);
  }

  /** @param {string} robot */
  #create(robot) {
    const name = document.createElement("span");
    name.className = "tag";
    name.setAttribute("aria-hidden", "true"); // the dot has it as its label
    const dot = document.createElement("button");
    dot.type = "button";
    dot.className = "dot";
    dot.dataset.robot = robot;
    dot.addEventListener("click", () => this.select(robot));
    for (const event of ["pointerenter", "focus"]) dot.addEventListener(event, () => this.#point(robot));
    for (const event of ["pointerleave", "blur"]) dot.addEventListener(event, () => this.#point(""));
    this.layer.append(name, dot); // the dot is over the name
    const tag = { dot, name, place: "", wantsName: false };
    this.tags.set(robot, tag);
    return tag;
  }

  /** Show the name at once, also while nothing moves. @param {string} robot */
  #point(robot) {
    for (const [name, tag] of this.tags) {
      if (name === robot) setHidden(tag.name, tag.dot.hidden === true);
      else if (name === this.pointed) setHidden(tag.name, !tag.wantsName);
    }
    this.pointed = robot;
  }
}

/** @param {HTMLElement} element @param {string} text */
function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** @param {HTMLElement} element @param {string} attribute @param {string} value */
function setAttribute(element, attribute, value) {
  if (element.getAttribute(attribute) !== value) element.setAttribute(attribute, value);
}

/** @param {HTMLElement} element @param {boolean} hidden */
function setHidden(element, hidden) {
  if (element.hidden !== hidden) element.hidden = hidden;
}
