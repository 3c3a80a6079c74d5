// The tab "Class", which is loaded when it is shown for the first time. It is offered while there are several robots.

import { membersOf, Troubles } from "../class_tab/class_states.js";
import { CONNECTION } from "../state/index.js";
import { h } from "../ui/dom.js";

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {typeof import("../class_tab/index.js")} Module */

// Both outlive the panel, which is created again for another language.
const troubles = new Troubles();
/** @type {Module | null} */
let loaded = null;

/** @param {Context} context @returns {import("../shell/context.js").Panel} */
export function classPanel(context) {
  const { workspace, scene, store, text } = context;
  const element = h("div", { class: "class-slot" });
  /** @type {ReturnType<Module["createClassTab"]> | null} */ let view = null;
  let isAsked = false;
  const load = async () => {
    isAsked = true;
    loaded ??= await import("../class_tab/index.js").catch(() => null);
    if (loaded === null) {
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
      return;
    }
    view = loaded.createClassTab(context, troubles);
    element.append(view.element);
    scene.invalidate();
  };
  /** @type {unknown} */ let programs = null;
  /** @type {unknown} */ let simulator = null;
  return {
    slot: "class",
    element,
    watch(state) {
      workspace.offerClass(Object.keys(state.robots).length > 1);
      if (workspace.tab !== "class" && view === null) isAsked = false; // after a failure: again with the next visit
      if (state.programs === programs && state.simulator === simulator) return;
      ({ programs, simulator } = state);
      troubles.update(membersOf(state), performance.now());
    },
    render(state) {
      if (!isAsked) void load();
      view?.render(state);
    },
  };
}
