// Why there is no connection, or that this page is older than its server, over the view.

import { h, setText } from "../ui/dom.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function bannerPanel({ text, address }) {
  const pageText = text("page");
  const words = h("span");
  const reload = h("button", { type: "button", class: "btn", onclick: () => location.reload() }, pageText("outdated.reload"));
  const element = h("p", { class: "banner note-box wait", hidden: true }, words, " ", reload);
  return {
    slot: "messages",
    element,
    render({ connection, outdated }) {
      const isConnected = connection === "connected";
      element.hidden = isConnected && !outdated;
      reload.hidden = !isConnected;
      if (isConnected) setText(words, outdated ? pageText("outdated") : "");
      else setText(words, pageText(`connection.${connection}Long`, { address }));
    },
  };
}
