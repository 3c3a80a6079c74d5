// Labels with the robots' names: elements in a layer over the canvas, updated only where something changed.

/** @typedef {{ x: number, y: number }} LabelPosition  CSS pixels of the layer */

export class NameTags {
  /** @param {HTMLElement} layer */
  constructor(layer) {
    this.layer = layer;
    /** @type {Map<string, { label: HTMLElement, transform: string, color: string }>} */ this.tags = new Map();
  }

  /** @param {string} robot @param {string} title @param {string} color  of its dot; empty: no dot */
  show(robot, title, color) {
    let tag = this.tags.get(robot);
    if (tag === undefined) {
      tag = { label: document.createElement("span"), transform: "", color: "" };
      tag.label.className = "robot-label";
      this.layer.append(tag.label);
      this.tags.set(robot, tag);
    }
    if (tag.label.textContent !== title) tag.label.textContent = title;
    if (tag.color === color) return;
    tag.color = color;
    tag.label.toggleAttribute("data-colored", color !== "");
    tag.label.style.setProperty("--color", color);
  }

  /**
   * Position a label by the center of its lower edge; null hides it.
   *
   * @param {string} robot
   * @param {LabelPosition | null} position
   */
  place(robot, position) {
    const tag = this.tags.get(robot);
    if (tag === undefined) return;
    const { label } = tag;
    if (label.hidden !== (position === null)) label.hidden = position === null;
    if (position === null) return;
    const transform = `translate(${Math.round(position.x)}px, ${Math.round(position.y)}px) translate(-50%, -100%)`;
    if (tag.transform !== transform) label.style.transform = tag.transform = transform;
  }

  /** @param {string} robot */
  remove(robot) {
    this.tags.get(robot)?.label.remove();
    this.tags.delete(robot);
  }
}
