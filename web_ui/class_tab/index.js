// The tab "Class": all robots at a glance, who needs a look, and what all get at once.

import { robotNames } from "../browser/robot_names.js";
import { titleOf } from "../examples/index.js";
import { translator } from "../i18n/index.js";
import classTexts from "../i18n/class.texts.js";
import { disabledReason } from "../state/disabled_reason.js";
import { faultMessage } from "../state/program_status.js";
import { robotColor } from "../state/robot_colors.js";
import { h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";
import { fits, FILTERS, needsLook, membersOf } from "./class_states.js";
import { Tiles } from "./tiles.js";

import "./class_tab.css";

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("./class_states.js").Member} Member */

/** Behaviors that are no program to give: the menu, and the one that only waits. */
const NOT_GIVEN = ["menu", "welcome"];

/** @param {Context} context @param {import("./class_states.js").Troubles} troubles */
export function createClassTab(context, troubles) {
  const t = translator(context.language, classTexts);
  const { store, scene } = context;
  /** @type {import("./class_states.js").Filter} */ let filter = "all";
  const filters = FILTERS.map((name) => {
    const count = h("span", { class: "num muted" });
    const button = h(
      "button",
      {
        type: "button",
        class: "btn",
        "data-filter": name,
        onclick: () => {
          filter = name;
          scene.invalidate();
        },
      },
      t(`show.${name}`),
      count,
    );
    return { name, button, count };
  });
  const tiles = new Tiles(t, (robot) => store.dispatch({ type: "select", robot }));
  const namesWord = h("span", {}, t("names"));
  const names = h(
    "button",
    {
      type: "button",
      class: "btn slim",
      "aria-pressed": "false",
      "data-names": "edit",
      title: t("names.help"),
      onclick: () => {
        tiles.setEditing(!tiles.isEditing);
        setAttribute(names, "aria-pressed", String(tiles.isEditing));
        setText(namesWord, t(tiles.isEditing ? "names.done" : "names"));
        help.hidden = !tiles.isEditing;
        scene.invalidate();
      },
    },
    icon("pen", { small: true }),
    namesWord,
  );
  const help = h("p", { class: "small muted", hidden: true }, t("names.help"));
  const empty = h("p", { class: "class-empty muted", hidden: true });
  const trouble = troubleOf(context, t);
  const all = actionsForAll(context, t);
  const element = h(
    "div",
    { class: "class-tab" },
    h(
      "div",
      { class: "class-head" },
      h("div", { class: "seg", role: "group", "aria-label": t("show") }, ...filters.map(({ button }) => button)),
      h("span", { class: "grow" }),
      names,
    ),
    help,
    tiles.element,
    empty,
    trouble.element,
    all.element,
  );
  return {
    element,
    /** @param {State} state */
    render(state) {
      const members = membersOf(state);
      for (const { name, button, count } of filters) {
        setAttribute(button, "aria-pressed", String(name === filter));
        setText(count, String(members.filter((member) => fits(name, member)).length));
      }
      const shown = members.filter((member) => fits(filter, member));
      tiles.show(shown, Object.keys(state.robots), state.selected);
      empty.hidden = shown.length > 0 || filter === "all";
      setText(empty, empty.hidden ? "" : t(`empty.${filter}`));
      const first = troubles.first(state.selected);
      trouble.render(state, members.find(({ robot }) => robot === first) ?? null, troubles.minutes(first ?? "", performance.now()));
      all.render(state);
    },
  };
}

/**
 * The robot to look at first, and what to do about it.
 *
 * @param {Context} context
 * @param {import("../i18n/index.js").Translate} t
 */
function troubleOf({ language, store, scene, workspace, frame }, t) {
  const dot = h("span", { class: "class-dot class-big num" });
  const title = h("h3", {});
  const detail = h("p", { class: "small muted" });
  /** @type {Member | null} */ let shown = null;
  const select = () => {
    if (shown !== null) store.dispatch({ type: "select", robot: shown.robot });
  };
  const goWord = h("span", {});
  const go = h(
    "button",
    {
      type: "button",
      class: "btn line slim",
      "data-class": "go",
      onclick: () => {
        select();
        scene.setView("follow");
        if (frame.layout === "phone") workspace.select(null);
      },
    },
    goWord,
  );
  const program = h(
    "button",
    {
      type: "button",
      class: "btn line slim",
      "data-class": "program",
      onclick: () => {
        select();
        workspace.select("program");
      },
    },
    icon("eye", { small: true }),
    h("span", {}, t("program")),
  );
  const element = h(
    "section",
    { class: "class-trouble", "aria-label": t("show.look"), hidden: true },
    dot,
    h("div", { class: "grow" }, title, detail),
    go,
    program,
  );
  const kinds = { mistake: "trouble.fault", fell: "trouble.fell", halted: "trouble.halted" };
  return {
    element,
    /** @param {State} state @param {Member | null} member @param {number} minutes */
    render({ robots, programs }, member, minutes) {
      shown = member;
      element.hidden = member === null || !needsLook(member.state);
      if (member === null || element.hidden) return;
      const { robot, number, state, line } = member;
      const name = robotNames.title(robot);
      setText(dot, number);
      setAttribute(dot, "style", `--color: ${robotColor(Object.keys(robots), robot)}`);
      setText(title, t(kinds[/** @type {keyof typeof kinds} */ (state)], { name, line }));
      const values = (programs[robot] ?? programs[""])?.values;
      const why = state === "mistake" && values !== undefined ? ` ${faultMessage(values, language)}` : "";
      setText(detail, `${sinceText(minutes, t)}${why}`);
      setText(goWord, t("goto", { name }));
    },
  };
}

/** @param {number} minutes @param {import("../i18n/index.js").Translate} t */
function sinceText(minutes, t) {
  if (minutes < 1) return t("trouble.now");
  return minutes === 1 ? t("trouble.minute") : t("trouble.since", { count: minutes });
}

/**
 * What all robots get at once: the choice of the robot then shows "all robots".
 *
 * @param {Context} context
 * @param {import("../i18n/index.js").Translate} t
 */
function actionsForAll({ text, store, actions, workspace, announce }, t) {
  const pageText = text("page");
  const examples = text("examples");
  /** @param {() => unknown} act */
  const forAll = (act) => {
    store.dispatch({ type: "address", all: true });
    act();
    announce(t("all.done", { count: Object.keys(store.state.robots).length }));
  };
  const give = h("button", { type: "button", class: "btn you", "data-class": "give" }, icon("give"), h("span", {}, t("all.give")));
  const { element: giveMenu } = menu({
    id: "class-give",
    button: give,
    label: t("all.give"),
    entries: () => [
      {
        label: t("give.own"),
        icon: "text",
        attributes: { "data-give": "" },
        act: () => {
          store.dispatch({ type: "address", all: true });
          workspace.select("program");
        },
      },
      ...store.state.behaviors
        .filter(({ name }) => !NOT_GIVEN.includes(name))
        .map(({ name }) => ({
          label: titleOf(name, examples),
          attributes: { "data-give": name },
          act: () => forAll(() => void actions.loadExample(name)),
        })),
    ],
  });
  /** @param {string} name @param {import("../ui/icons.js").IconName} symbol @param {() => unknown} act */
  const button = (name, symbol, act) =>
    h(
      "button",
      { type: "button", class: "btn line", "data-class": name, onclick: () => forAll(act) },
      icon(symbol),
      h("span", {}, t(`all.${name}`)),
    );
  const stop = button("stop", "stop", () => void actions.program("stop"));
  const start = button("start", "reset", () => void actions.reset());
  return {
    element: h(
      "section",
      { class: "class-all", "aria-label": t("all") },
      h("span", { class: "cap" }, t("all")),
      h("div", { class: "class-row" }, giveMenu, stop, start),
    ),
    /** @param {State} state */
    render(state) {
      for (const each of [give, stop, start]) lock(each, disabledReason(state, pageText));
    },
  };
}
