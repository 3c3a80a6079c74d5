// Why there is no connection, over the view.

import { h, setText } from "../ui/dom.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function bannerPanel({ text, address }) {
  const t = text("page");
  const element = h("p", { class: "banner note-box wait", hidden: true });
  return {
    slot: "messages",
    element,
    render({ connection }) {
      const isConnected = connection === "connected";
      element.hidden = isConnected;
      setText(element, isConnected ? "" : t(`connection.${connection}Long`, { address }));
    },
  };
}
