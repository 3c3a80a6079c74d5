// The "?" of the header: what explains the page, and the file that explains to others what happened.

import { download } from "../browser/download.js";
import { RUN_LOG } from "../input/actions.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";

/** The documentation that ships with the page (web_ui/vite.config.js). */
const DOCUMENTATION = "./docs/index.html";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function helpMenuPanel({ actions, store, text, mission, tour, welcome }) {
  const t = text("page");
  const saveRun = async () => {
    const log = await actions.runLog();
    if (log !== null) download("run.jsonl.gz", log, "application/gzip");
  };
  const button = h(
    "button",
    { type: "button", class: "btn icon", id: "help-open", title: t("help"), "aria-label": t("help") },
    icon("help"),
  );
  const { element } = menu({
    id: "help-menu",
    button,
    label: t("help"),
    entries: () => /** @type {import("../ui/menu.js").Entry[]} */ ([
      { label: t("help.tour"), icon: "idea", attributes: { "data-help": "tour" }, act: () => void tour.open() },
      { label: t("missions"), icon: "flag", attributes: { "data-help": "missions" }, act: () => void mission.openList() },
      { label: t("help.start"), icon: "robot", attributes: { "data-help": "start" }, act: () => welcome.open() },
      { label: t("help.keys"), icon: "keys", attributes: { "data-help": "keys" }, act: () => void welcome.openKeys() },
      {
        label: t("help.docs"),
        icon: "file",
        attributes: { "data-help": "docs", title: t("help.offline") },
        act: () => void window.open(DOCUMENTATION, "_blank", "noopener"),
      },
      ...(!store.state.readOnly && store.state.services.includes(RUN_LOG)
        ? [
            {
              label: t("help.run"),
              icon: "save",
              attributes: { "data-help": "run", title: t("help.run.text") },
              act: () => void saveRun(),
            },
          ]
        : []),
    ]),
  });
  return { slot: "header", element };
}
