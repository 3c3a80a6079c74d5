// Saves a picture of the view, with playground and time in its name.

import { h } from "../ui/dom.js";

/**
 * @param {Pick<import("../shell/context.js").Context, "text" | "scene" | "store">} context
 * @param {number} [scale]   times the usual size
 */
export async function savePicture({ text, scene, store }, scale = 1) {
  const t = text("stage");
  const png = await scene.picture({ scale });
  if (png === null) return store.dispatch({ type: "notice", level: "error", text: t("view.noPicture") });
  const address = URL.createObjectURL(png);
  const { simulator, timeNs } = store.state;
  const name = `${simulator?.playground || "thymio"}-${(timeNs / 1e9).toFixed(1)}s.png`.replace(/[^\w.-]+/g, "_");
  h("a", { href: address, download: name }).click();
  URL.revokeObjectURL(address);
  store.dispatch({ type: "notice", level: "info", text: t("view.pictureSaved", { name }) });
}
