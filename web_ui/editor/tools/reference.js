// The names that the robot offers, by topic: motors, lights, sound and sensors first. A click inserts one.

import { h } from "../../ui/dom.js";
import { signature } from "../help.js";

/** @typedef {{ shown: string, text: string, help: string }} Entry   text: what is inserted */

/**
 * The names of a robot by topic, in the order of the topics. Pure.
 *
 * @param {import("../state.js").Target} target
 * @returns {{ topic: string, entries: Entry[] }[]}
 */
export function byTopic({ topics = [], variables, events, natives }) {
  /** @type {Map<string, Entry[]>} */ const found = new Map(topics.map((topic) => [topic, []]));
  /** @param {string | undefined} topic @param {Entry} entry */
  const add = (topic, entry) => {
    const name = topic ?? "others";
    found.set(name, [...(found.get(name) ?? []), entry]);
  };
  for (const { name, size, help, hidden, topic } of variables) {
    if (!hidden) add(topic, { shown: size === 1 ? name : `${name}[${size}]`, text: name, help });
  }
  for (const { name, help, topic } of events) add(topic, { shown: `onevent ${name}`, text: `onevent ${name}`, help });
  for (const native of natives) {
    const shown = signature(native);
    if (!native.hidden) add(native.topic, { shown: `call ${shown}`, text: `call ${shown}`, help: native.help });
  }
  return [...found].map(([topic, entries]) => ({ topic, entries })).filter(({ entries }) => entries.length > 0);
}

/** @param {import("./index.js").ToolContext} context @returns {import("./index.js").Tool} */
export function referenceTool({ t, insert }) {
  const filter = h("input", { type: "search", class: "input", placeholder: t("filter"), "aria-label": t("filter") });
  const list = h("div", {});
  const nothing = h("p", { class: "nothing" }, t("reference.none"));
  /** @type {import("../state.js").Target | null} */ let shown = null;

  /** @param {Entry} entry */
  const rowOf = ({ shown: name, text, help }) =>
    h(
      "div",
      { class: "entry-help", "data-search": `${name} ${help}`.toLowerCase() },
      h("button", { type: "button", title: t("reference.insert"), onclick: () => insert(text) }, name),
      h("p", {}, help),
    );
  const apply = () => {
    const wanted = filter.value.trim().toLowerCase();
    for (const part of list.querySelectorAll("section")) {
      let any = false;
      for (const item of part.querySelectorAll("[data-search]")) {
        const fits = (item.getAttribute("data-search") ?? "").includes(wanted);
        /** @type {HTMLElement} */ (item).hidden = !fits;
        any ||= fits;
      }
      part.hidden = !any;
    }
  };
  filter.addEventListener("input", apply);
  return {
    name: "reference",
    element: h("div", { class: "reference" }, filter, nothing, list),
    render({ target }) {
      if (target === shown) return;
      shown = target;
      nothing.hidden = target !== null;
      const parts = target === null ? [] : byTopic(target);
      list.replaceChildren(
        ...parts.map(({ topic, entries }) =>
          h("section", { "data-topic": topic }, h("h3", {}, t(`topic.${topic}`)), ...entries.map(rowOf)),
        ),
      );
      apply();
    },
  };
}
