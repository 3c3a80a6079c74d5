// The Markdown of docs/ as HTML. Pictures are left out, and nothing in a page becomes a tag. Used when the page is built; pure.

import { Marked, Renderer } from "marked";

/** @typedef {(target: string) => string | null} Resolve   address of a link; null: its text only */

/** @param {string} text */
export function escapeHtml(text) {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");
}

/** The id of a heading, as other pages link to it. @param {string} heading  Markdown */
export function slug(heading) {
  return heading
    .toLowerCase()
    .replace(/\[([^\]]*)\]\([^)]*\)/g, "$1")
    .replace(/[^\p{L}\p{N}\s_-]/gu, "")
    .replace(/\s/g, "-");
}

/** @param {string} text @param {Resolve} resolve @returns {string} */
export function toHtml(text, resolve) {
  const marked = new Marked({
    renderer: {
      heading({ tokens, depth, text: heading }) {
        return `<h${depth} id="${slug(heading)}">${this.parser.parseInline(tokens)}</h${depth}>\n`;
      },
      paragraph({ tokens }) {
        const html = this.parser.parseInline(tokens);
        return html === "" ? "" : `<p>${html}</p>\n`; // of a picture
      },
      link({ href, tokens }) {
        const address = resolve(href);
        const label = this.parser.parseInline(tokens);
        return address === null ? label : `<a href="${escapeHtml(address)}">${label}</a>`;
      },
      table(token) {
        return `<div class="table" tabindex="0">${Renderer.prototype.table.call(this, token)}</div>\n`;
      },
      html: ({ text: html }) => (html.startsWith("<!--") ? "" : escapeHtml(html)),
      image: () => "",
    },
    tokenizer: { url: () => undefined }, // an address without brackets may be an example
  });
  return marked.parse(text, { async: false });
}
