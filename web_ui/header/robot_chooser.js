// The choice of the robot: the one whose values are shown and that the user acts on, or all robots for actions.

import { robotNames } from "../browser/robot_names.js";
import { robotColor } from "../state/robot_colors.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";

/** The entry "all robots"; no robot has this name. */
const ALL = "*";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function robotChooserPanel({ text, store, announce }) {
  const t = text("page");
  const swatch = h("span", { class: "swatch", "aria-hidden": "true" });
  const name = h("span", { class: "name" });
  const button = h(
    "button",
    { type: "button", class: "select quiet", id: "robot-chooser", title: t("app.chooseRobot") },
    swatch,
    name,
    icon("caretDown", { small: true }),
  );

  /** @param {string} robot */
  const titleOf = (robot) => robotNames.title(robot) || t("app.robot");
  const entries = () => {
    const { robots, selected, toAll } = store.state;
    const names = Object.keys(robots);
    const single = names.map((robot) => ({
      label: titleOf(robot),
      chosen: !toAll && robot === selected,
      swatch: true,
      attributes: { "data-robot": robot, style: `--color: ${robotColor(names, robot)}` },
      act: () => store.dispatch({ type: "select", robot }),
    }));
    const all = {
      label: t("app.allRobots", { count: names.length }),
      chosen: toAll,
      swatch: false,
      attributes: { "data-robot": ALL },
      act: () => {
        store.dispatch({ type: "address", all: true });
        announce(t("app.toAll", { count: names.length }));
      },
    };
    return names.length < 2 ? single : [...single, all];
  };
  const { element, refresh } = menu({ id: "robot-menu", button, label: t("app.chooseRobot"), isChoice: true, entries });
  let listed = "";
  return {
    slot: "header",
    element,
    render({ robots, selected, toAll }) {
      const names = Object.keys(robots);
      const hasChoice = names.length > 1;
      element.dataset.choice = String(hasChoice);
      if (button.disabled !== !hasChoice) button.disabled = !hasChoice;
      setText(name, toAll ? t("app.allRobots", { count: names.length }) : titleOf(selected));
      setAttribute(button, "aria-label", `${t("app.chooseRobot")}: ${name.textContent}`);
      setAttribute(swatch, "style", toAll || !hasChoice ? "" : `--color: ${robotColor(names, selected)}`);
      const list = names.join();
      if (list === listed) return;
      listed = list;
      refresh();
    },
  };
}
