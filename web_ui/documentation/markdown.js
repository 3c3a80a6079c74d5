// The Markdown of docs/ as HTML: headings, paragraphs, lists, tables, code, quotations, links. Pictures are left out.
// Used when the page is built; pure.

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

/** Text inside a block. @param {string} text @param {Resolve} resolve @returns {string} */
export function inline(text, resolve) {
  /** @type {string[]} */ const codes = [];
  const kept = text.replace(/(`+)(.+?)\1(?!`)/g, (_all, _ticks, code) => `\u0001${codes.push(code.trim()) - 1}\u0001`);
  return escapeHtml(kept)
    .replace(/\\([\\`*_{}[\]()#+.!|~<>-])/g, (_all, mark) => `&#${mark.codePointAt(0)};`)
    .replace(/!\[[^\]]*\]\([^)]*\)/g, "")
    .replace(/\[((?:[^\][]|\[[^\]]*\])*)\]\(([^)\s]+)\)/g, (_all, label, target) => {
      const address = resolve(target);
      return address === null ? label : `<a href="${address}">${label}</a>`;
    })
    .replace(/&lt;(https?:[^\s&]+)&gt;/g, '<a href="$1">$1</a>')
    .replace(/\*\*(.+?)\*\*/g, "<strong>$1</strong>")
    .replace(/(?<![\w*])\*(?!\s)(.+?)(?<!\s)\*(?![\w*])/g, "<em>$1</em>")
    .replace(/\u0001(\d+)\u0001/g, (_all, at) => `<code>${escapeHtml(codes[Number(at)])}</code>`);
}

const FENCE = /^(\s*)(```+|~~~+)/;
const ITEM = /^(\s*)([-*]|\d+[.)])\s+(.*)$/;
const HEADING = /^(#{1,6})\s+(.*)$/;
const TABLE_RULE = /^\s*\|?\s*:?-+:?\s*(\|\s*:?-+:?\s*)*\|?\s*$/;

/** @param {string} text @param {Resolve} resolve @returns {string} */
export function toHtml(text, resolve) {
  return blocks(text.replace(/<!--[^]*?-->/g, "").split("\n"), resolve).join("\n");
}

/** @param {readonly string[]} lines @param {Resolve} resolve @returns {string[]} */
function blocks(lines, resolve) {
  /** @type {string[]} */ const out = [];
  let at = 0;
  /** @param {(line: string) => boolean} belongs */
  const take = (belongs) => {
    const start = at;
    while (at < lines.length && belongs(lines[at])) at++;
    return lines.slice(start, at);
  };
  while (at < lines.length) {
    const line = lines[at];
    const heading = HEADING.exec(line);
    const fence = FENCE.exec(line);
    if (line.trim() === "") at++;
    else if (fence !== null) {
      at++;
      const code = take((each) => !each.trim().startsWith(fence[2]));
      at++;
      out.push(`<pre><code>${escapeHtml(code.map((each) => each.slice(Math.min(fence[1].length, indentOf(each)))).join("\n"))}</code></pre>`);
    } else if (heading !== null) {
      const { length } = heading[1];
      out.push(`<h${length} id="${slug(heading[2])}">${inline(heading[2], resolve)}</h${length}>`);
      at++;
    } else if (line.includes("|") && TABLE_RULE.test(lines[at + 1] ?? "") && lines[at + 1].includes("-")) {
      out.push(table(take((each) => each.includes("|")), resolve));
    } else if (line.startsWith(">")) {
      const inner = take((each) => each.startsWith(">")).map((each) => each.replace(/^> ?/, ""));
      out.push(`<blockquote>${blocks(inner, resolve).join("\n")}</blockquote>`);
    } else if (ITEM.test(line)) {
      const indent = indentOf(line);
      out.push(list(take((each) => each.trim() === "" || indentOf(each) > indent || ITEM.test(each)), resolve));
    } else {
      const paragraph = take((each) => each.trim() !== "" && !HEADING.test(each) && !FENCE.test(each) && !ITEM.test(each));
      const html = inline(paragraph.join("\n"), resolve).trim();
      if (html !== "") out.push(`<p>${html}</p>`);
    }
  }
  return out;
}

/** @param {string} line */
function indentOf(line) {
  return line.length - line.trimStart().length;
}

/** A list; lines that are indented further belong to the item before them. @param {readonly string[]} lines @param {Resolve} resolve */
function list(lines, resolve) {
  const first = /** @type {RegExpExecArray} */ (ITEM.exec(lines[0]));
  const indent = first[1].length;
  /** @type {string[][]} */ const items = [];
  for (const line of lines) {
    const item = ITEM.exec(line);
    if (item !== null && item[1].length <= indent) items.push([item[3]]);
    else items.at(-1)?.push(line.slice(Math.min(indentOf(line), indent + 2)));
  }
  const tag = /\d/.test(first[2]) ? "ol" : "ul";
  const html = items.map((item) => {
    const [only, ...more] = blocks(item, resolve);
    return `<li>${[(only ?? "").replace(/^<p>([^]*)<\/p>$/, "$1"), ...more].join("\n")}</li>`;
  });
  return `<${tag}>${html.join("\n")}</${tag}>`;
}

/** @param {readonly string[]} lines @param {Resolve} resolve */
function table([head, , ...rows], resolve) {
  /** @param {string} row @param {string} tag */
  const cells = (row, tag) =>
    row
      .trim()
      .replace(/^\||(?<!\\)\|$/g, "")
      .split(/(?<!\\)\|/)
      .map((cell) => `<${tag}>${inline(cell.trim().replaceAll("\\|", "|"), resolve)}</${tag}>`)
      .join("");
  const body = rows.map((row) => `<tr>${cells(row, "td")}</tr>`).join("\n");
  return `<div class="table" tabindex="0"><table><thead><tr>${cells(head, "th")}</tr></thead><tbody>${body}</tbody></table></div>`;
}
