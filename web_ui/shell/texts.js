// The texts of index.html itself.

/**
 * @param {(selector: string) => HTMLElement} element
 * @param {Pick<import("./context.js").Context, "text" | "language" | "workspace">} context
 */
export function fillTexts(element, { text, language, workspace }) {
  const t = text("page");
  const stage = text("stage");
  document.documentElement.lang = language;
  document.title = t("app.title");
  element("#title").textContent = t("app.title");
  element("#drop").textContent = t("app.drop");
  const skip = element("#skip");
  skip.textContent = t("app.skip");
  skip.onclick = (event) => {
    event.preventDefault();
    workspace.select("program");
    element("#work").focus();
  };
  element("#view").setAttribute("aria-label", stage("view.canvas"));
  element("#stage").setAttribute("aria-label", stage("stage"));
  element("#work").setAttribute("aria-label", stage("work"));
  element("#grip").setAttribute("aria-label", stage("work.width"));
  element("#time").setAttribute("aria-label", stage("time"));
}
