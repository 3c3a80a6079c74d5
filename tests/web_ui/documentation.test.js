// The documentation that ships with the page: Markdown as HTML, and links between the shipped pages.

import assert from "node:assert/strict";
import { test } from "node:test";

import { slug, toHtml } from "../../web_ui/documentation/markdown.js";
import { addressOf, documentation } from "../../web_ui/documentation/pages.js";

/** @param {string} text */
const html = (text) => toHtml(text, (target) => (target === "none" ? null : target)).trim();

test("blocks: headings with ids, paragraphs, code, quotations", () => {
  assert.equal(html("# A `b` c\n\ntext\nmore\n"), '<h1 id="a-b-c">A <code>b</code> c</h1>\n<p>text\nmore</p>');
  assert.match(html("```sh\na < b  # *no*\n\n  c\n```"), /^<pre><code[^>]*>a &lt; b {2}# \*no\*\n\n {2}c\n<\/code><\/pre>$/);
  assert.match(html("> quoted\n> text"), /^<blockquote>\s*<p>quoted\ntext<\/p>\s*<\/blockquote>$/);
  assert.equal(html("<!-- hidden\nlines -->\n\ntext"), "<p>text</p>");
  assert.equal(html("![picture](page.png)"), "");
});

test("lists have items of several lines, and lists inside", () => {
  const lists = html("- a\n  more\n- b\n  - c\n\nend").replace(/>\s+</g, "><");
  assert.equal(lists, "<ul><li>a\nmore</li><li>b<ul><li>c</li></ul></li></ul><p>end</p>");
  assert.equal(html("1. a\n2. b").replace(/>\s+</g, "><"), "<ol><li>a</li><li>b</li></ol>");
});

test("tables have a head, rows, and bars inside cells; they scroll in a frame that has the focus", () => {
  const found = html("| a | b |\n|---|---|\n| `x \\| y` | |\n").replace(/>\s+</g, "><");
  assert.match(found, /^<div class="table" tabindex="0"><table>/);
  assert.match(found, /<th>a<\/th><th>b<\/th>/);
  assert.match(found, /<td><code>x \| y<\/code><\/td><td><\/td>/);
});

test("inside a block: bold, emphasis, code, links, escapes; nothing becomes a tag", () => {
  assert.equal(html("**a** *b* `<i>` <i>"), "<p><strong>a</strong> <em>b</em> <code>&lt;i&gt;</code> &lt;i&gt;</p>");
  assert.equal(html("<script>a</script>"), "&lt;script&gt;a&lt;/script&gt;");
  assert.equal(html("[a](b.md#c) [d](none) <https://e.org>"), '<p><a href="b.md#c">a</a> d <a href="https://e.org">https://e.org</a></p>');
  assert.equal(html("[`a`](b) https://host:port"), '<p><a href="b"><code>a</code></a> https://host:port</p>');
  assert.equal(html("2 * 3 * 4, a_b_c, \\*"), "<p>2 * 3 * 4, a_b_c, *</p>");
  assert.equal(html("**two\nlines**"), "<p><strong>two\nlines</strong></p>");
  assert.equal(slug("Names of `/tf`, and more"), "names-of-tf-and-more");
});

test("links lead to shipped pages and to the web; others are text", () => {
  assert.equal(addressOf("ros.md#time", "docs/web-ui.md"), "ros.html#time");
  assert.equal(addressOf("../playgrounds/README.md", "docs/web-ui.md"), "playgrounds.html");
  assert.equal(addressOf("../docs/robot.md", "playgrounds/README.md"), "robot.html");
  assert.equal(addressOf("spec/thymio-robot.md", "docs/robot.md"), null);
  assert.equal(addressOf("https://a.org/b", "docs/robot.md"), "https://a.org/b");
});

test("every shipped page has its title and text, and every link between them leads somewhere", () => {
  const pages = new Map(documentation().map(({ fileName, source }) => [fileName.replace("docs/", ""), source]));
  assert.ok(pages.size > 10);
  const broken = [...pages].flatMap(([name, source]) =>
    [...source.matchAll(/<a href="([^":]*)"/g)]
      .map(([, target]) => target)
      .filter((target) => !target.startsWith("../index.html"))
      .filter((target) => {
        const [file, id = ""] = target.split("#");
        const found = pages.get(file === "" ? name : file);
        return found === undefined || (id !== "" && !found.includes(`id="${id}"`));
      })
      .map((target) => `${name}: ${target}`),
  );
  assert.deepEqual(broken, []);
  for (const [name, source] of pages) {
    if (name.endsWith(".html")) assert.match(source, /<h1[ >]/, name);
  }
});
