// Where the reason of a rejected playground is shown: at the place where the file was dropped, else in the tab of
// playgrounds, with a notice while another tab is open.

import { uploadCause } from "../state/index.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { partsOf } from "./reasons.js";

/** @typedef {import("./reasons.js").Reason} Reason */

export class RefusalBox {
  /** @param {import("../shell/context.js").Context} context */
  constructor(context) {
    this.context = context;
    this.element = h("div", { class: "fault", role: "alert", hidden: true });
    /** Called when the user closes it. */
    this.closed = () => {};
    /** Number of messages shown so far: an outdated one is not shown. */
    this.count = 0;
  }

  hide() {
    this.count += 1;
    this.element.hidden = true;
    this.context.messageAt.hide();
  }

  /** Why a file was rejected by the simulator. @param {import("../state/index.js").Upload} upload */
  async showUpload({ name, fault }) {
    const { text, opened, messageAt, announce, creator, workspace, store } = this.context;
    const { file = null, place = null } = opened.of(name) ?? {};
    const count = ++this.count;
    const content = await opened.textOf(name);
    const parts = file === null || fault === null ? [] : partsOf(fault.text);
    const headline = text("playground")("refused", { name });
    const { children, words } =
      file !== null && parts.length > 0
        ? this.#choice(file, parts)
        : await this.#view(headline, (module) => (fault === null ? null : module.reasonOfMessage(fault, content)));
    if (count !== this.count) return;
    opened.forget();
    if (place !== null) return messageAt.show(place, children, text("page")("notice.dismiss"));
    if (creator.isOpen) return; // it shows what it tried itself
    this.#show(children);
    announce(words);
    if (workspace.tab === "playground") return;
    store.dispatch({ type: "notice", level: "error", text: words, cause: uploadCause("playground") });
  }

  /**
   * What the page's reader found.
   *
   * @param {string} headline
   * @param {import("../playground/rules.js").Fault} fault
   * @param {string} content
   */
  async showFault(headline, fault, content) {
    const count = ++this.count;
    const { children } = await this.#view(headline, (module) => module.reasonOfFault(fault, content));
    if (count === this.count) this.#show(children);
  }

  /** The playgrounds of an archive, each as a button. @param {File} file @param {readonly string[]} parts */
  #choice(file, parts) {
    const { text, actions } = this.context;
    const words = text("playground")("parts", { name: file.name, count: parts.length });
    /** @param {string} part */
    const choose = async (part) =>
      actions.loadPlayground(file.name, new Uint8Array(await file.arrayBuffer()), part);
    const buttons = parts.map((part) =>
      h("li", {}, h("button", { type: "button", class: "btn line", "data-part": part, onclick: () => void choose(part) }, part)),
    );
    return { children: [h("p", { class: "headline" }, words), h("ul", { class: "parts" }, ...buttons)], words };
  }

  /** @param {readonly Node[]} children */
  #show(children) {
    const label = this.context.text("page")("notice.dismiss");
    const close = h(
      "button",
      {
        type: "button",
        class: "btn icon",
        title: label,
        "aria-label": label,
        onclick: () => {
          this.hide();
          this.closed();
        },
      },
      icon("close"),
    );
    this.element.hidden = false;
    this.element.replaceChildren(h("div", { class: "grow" }, ...children), close);
    this.element.scrollIntoView({ block: "nearest" });
  }

  /**
   * The message and its words; without its reason if the page's server is gone.
   *
   * @param {string} headline
   * @param {(module: typeof import("./refusal.js")) => Reason | null} findReason
   */
  async #view(headline, findReason) {
    const { language } = this.context;
    const module = await import("./refusal.js").catch(() => null);
    if (module === null) return { children: [h("p", { class: "headline" }, headline)], words: headline };
    const reason = findReason(module);
    const words = reason === null ? headline : `${headline} ${module.refusalText(language, reason)}`;
    return { children: module.refusalView(language, headline, reason), words };
  }
}
