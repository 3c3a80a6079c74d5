// A playground to choose: thumbnail, title, number of robots; and small buttons beside the title.

import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("./thumbnail_cache.js").Sample} Sample */
/** @typedef {{ name: string, label: string, help: string, drawing: import("../ui/icons.js").IconName, act: () => void }} SmallButton */

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {string} options.title
 * @param {string} options.description
 * @param {Record<string, string>} options.attributes   of the large button
 * @param {() => Promise<Sample | null>} options.sample   asked when the card comes into sight
 * @param {() => void} options.choose
 * @param {readonly SmallButton[]} options.buttons
 */
export function card({ t, title, description, attributes, sample, choose, buttons }) {
  const picture = h("img", { alt: "", width: 240, height: 160, hidden: true });
  const robots = h("small", { class: "count" });
  const button = h(
    "button",
    { type: "button", class: "sample", title: description, ...attributes, onclick: choose },
    h("span", { class: "frame" }, picture),
    h("strong", {}, title),
    robots,
  );
  const small = buttons.map(({ name, label, help, drawing, act }) =>
    h(
      "button",
      { type: "button", class: `btn icon ${name}`, title: help, "aria-label": label, onclick: act },
      icon(drawing, { small: true }),
    ),
  );
  const element = h("li", { class: "card" }, button, h("span", { class: "small-buttons" }, ...small));
  whenSeen(element, async () => {
    const found = await sample();
    element.toggleAttribute("data-missing", found === null);
    if (found === null) return;
    const count = found.playground.items.filter(({ kind }) => kind === "robot").length;
    setText(robots, t(count === 1 ? "robots.one" : "robots.many", { count }));
    picture.src = found.picture;
    picture.hidden = false;
  });
  return { element, button };
}

/** Act once, when an element comes into sight. @param {Element} element @param {() => void} act */
function whenSeen(element, act) {
  const watch = new IntersectionObserver((entries) => {
    if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
    watch.disconnect();
    act();
  });
  watch.observe(element);
}
