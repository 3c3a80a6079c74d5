// The texts of index.html itself.

/**
 * @param {(selector: string) => HTMLElement} element
 * @param {Pick<import("./context.js").Context, "text" | "language" | "workspace">} context
 */
export function fillTexts(element, { text, language, workspace }) {
  const t = text("stage");
  const pageText = text("page");
  document.documentElement.lang = language;
  element("#title").textContent = pageText("app.title");
  element("#drop").textContent = pageText("app.drop");
  const skip = element("#skip");
  skip.textContent = pageText("app.skip");
  skip.onclick = (event) => {
    event.preventDefault();
    workspace.select("program");
    element("#work").focus();
  };
  element("#view").setAttribute("aria-label", t("view.canvas"));
  element("#stage").setAttribute("aria-label", t("stage"));
  element("#work").setAttribute("aria-label", t("work"));
  element("#grip").setAttribute("aria-label", t("work.width"));
  element("#time").setAttribute("aria-label", t("time"));
}
