// The gallery dialog: a thumbnail of every shipped playground, to choose one.

import { FILE } from "../state/index.js";
import { disabledReason } from "../state/disabled_reason.js";
import { buttonOf, fileButton, h, lock, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { faultView } from "./refusal.js";

/** @typedef {import("../state/index.js").PlaygroundInfo} PlaygroundInfo */

/** @param {import("../shell/context.js").Context} context */
export function galleryDialog({ text, language, actions, thumbnails, store, creator, scene }) {
  const t = text("playground");
  const pageText = text("page");
  const fault = h("div", { class: "fault", role: "alert", hidden: true });
  const list = h("ul", { class: "samples" });
  const close = h("button", { type: "button", class: "btn icon", "aria-label": t("gallery.close") }, icon("close"));
  const file = fileButton({
    id: "gallery-file",
    label: t("gallery.file"),
    help: t("playground.openHelp"),
    accept: ".json,.playground,.xml,.zip",
    open: (chosen) => {
      attempt();
      void actions.loadFile(chosen);
    },
  });
  const dialog = h(
    "dialog",
    { class: "gallery", "aria-labelledby": "gallery-title" },
    h("div", { class: "gallery-head" }, h("h2", { id: "gallery-title" }, t("gallery")), close),
    fault,
    list,
    h(
      "div",
      { class: "row" },
      file,
      h("small", {}, t("gallery.formats")),
    ),
  );
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close()); // a click outside
  dialog.addEventListener("close", () => scene.invalidate()); // notices move back to the page
  dialog.addEventListener("keydown", (event) => event.stopPropagation()); // Escape must not stop robots
  /** @type {{ name: string, button: HTMLButtonElement }[]} */ let cards = [];
  let listed = "";
  /** The upload state before the choice that is in progress; undefined: none is in progress. */
  /** @type {import("../state/index.js").Upload | null | undefined} */ let before;
  const attempt = () => {
    before = store.state.uploads.playground;
    forget();
  };
  const forget = () => {
    fault.hidden = true;
    store.dispatch({ type: "solved", cause: FILE });
  };

  /** @param {PlaygroundInfo} info */
  const card = (info) => {
    const { title, description } = info.translations[language] ?? info;
    const picture = h("img", { alt: "", width: 240, height: 160, hidden: true });
    const robots = h("small", { class: "count" });
    const button = h(
      "button",
      { type: "button", class: "sample", "data-playground": info.name, title: description },
      h("span", { class: "frame" }, picture),
      h("strong", {}, title),
      robots,
    );
    button.addEventListener("click", () => {
      attempt();
      void actions.loadPlayground(info.name);
    });
    cards.push({ name: info.name, button });
    const change = h(
      "button",
      {
        type: "button",
        class: "btn icon change",
        hidden: true,
        title: t("gallery.edit"),
        "aria-label": t("gallery.editOf", { title }),
      },
      icon("pen", { small: true }),
    );
    void thumbnails.sample(info.name).then((sample) => {
      if (sample === null) return;
      const count = sample.playground.items.filter(({ kind }) => kind === "robot").length;
      setText(robots, t(count === 1 ? "gallery.robot" : "gallery.robots", { count }));
      picture.src = sample.picture;
      picture.hidden = false;
      change.hidden = false;
      change.addEventListener("click", () => {
        dialog.close();
        void creator.open({ ...sample.playground, ...(info.translations[language] ?? {}), translations: {} });
      });
    });
    return h("li", {}, button, change);
  };

  return {
    element: dialog,
    open: () => {
      listed = "";
      before = undefined;
      forget();
      dialog.showModal();
      scene.invalidate(); // notices are shown inside the dialog from now on
      render(store.state);
      (cards.find(({ button }) => button.ariaCurrent === "true")?.button ?? close).focus();
    },
    render,
  };

  /** @param {import("../state/index.js").State} state */
  function render({ connection, readOnly, playgrounds, simulator, uploads }) {
    if (!dialog.open) return;
    const now = JSON.stringify(playgrounds);
    if (now !== listed) {
      listed = now;
      cards = [];
      list.replaceChildren(...playgrounds.map(card));
    }
    const reason = disabledReason({ connection, readOnly }, pageText);
    lock(buttonOf(file), reason);
    for (const { name, button } of cards) {
      setAttribute(button, "aria-current", String(name === simulator?.playground));
      lock(button, reason);
    }
    const { playground } = uploads;
    if (before === undefined || playground === before || playground === null || playground.phase === "sending") return;
    before = undefined;
    if (playground.phase === "accepted") return dialog.close();
    fault.replaceChildren(...faultView(t, t("playground.refused", { name: playground.name }), playground.fault));
    fault.hidden = false;
    fault.scrollIntoView({ block: "nearest" });
  }
}
