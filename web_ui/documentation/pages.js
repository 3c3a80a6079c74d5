// The pages of docs/ that ship with the page, as /docs/NAME.html: what teachers, pupils and ROS users look up.
// Runs in Node only, when the page is built.

import { existsSync, readFileSync } from "node:fs";

import { escapeHtml, toHtml } from "./markdown.js";

const ROOT = new URL("../../", import.meta.url);
const SHEETS = ["../styles/tokens.css", "./documentation.css"];

/** Name of the shipped page → its source, in the order of the index. */
export const SOURCES = {
  "web-ui": "docs/web-ui.md",
  "from-blocks-to-ros": "docs/from-blocks-to-ros.md",
  blockly: "docs/blockly.md",
  behaviors: "docs/behaviors.md",
  playgrounds: "playgrounds/README.md",
  vpl: "docs/vpl.md",
  robot: "docs/robot.md",
  ros: "docs/ros.md",
  "ros2-tools": "docs/ros2-tools.md",
  aseba_ros: "docs/aseba_ros.md",
  foxglove: "docs/foxglove.md",
  tf: "docs/tf.md",
  world: "docs/world.md",
  plugins: "docs/plugins.md",
  classroom: "docs/classroom.md",
  grading: "docs/grading.md",
  glossary: "docs/glossary.md",
};

/** @typedef {{ fileName: string, source: string }} Page */

/**
 * The address of a link between shipped pages, or to the web; null for what does not ship.
 *
 * @param {string} target
 * @param {string} source   the page with the link
 */
export function addressOf(target, source) {
  if (/^https?:/.test(target) || target.startsWith("#")) return target;
  const { pathname, hash } = new URL(target, `file:///${source}`);
  const found = Object.entries(SOURCES).find(([, path]) => pathname === `/${path}`);
  return found === undefined ? null : `${found[0]}.html${hash}`;
}

/** The shipped pages, their index and their sheet; pages without a source are left out. @returns {Page[]} */
export function documentation() {
  const pages = Object.entries(SOURCES)
    .filter(([, path]) => existsSync(new URL(path, ROOT)))
    .map(([name, path]) => {
      const text = readFileSync(new URL(path, ROOT), "utf8");
      const title = /^#\s+(.*)$/m.exec(text)?.[1] ?? name;
      return { name, title, html: toHtml(text, (target) => addressOf(target, path)) };
    });
  const index = pages.map(({ name, title }) => `<li><a href="${name}.html">${escapeHtml(title)}</a></li>`).join("\n");
  const css = SHEETS.map((path) => readFileSync(new URL(path, import.meta.url), "utf8")).join("\n");
  return [
    { fileName: "docs/documentation.css", source: css },
    { fileName: "docs/index.html", source: frame("Documentation", `<h1>Documentation</h1>\n<ul>\n${index}\n</ul>`) },
    ...pages.map(({ name, title, html }) => ({ fileName: `docs/${name}.html`, source: frame(title, html) })),
  ];
}

/** @param {string} title @param {string} html */
function frame(title, html) {
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'self'; img-src 'self'">
<meta name="color-scheme" content="light dark">
<title>${escapeHtml(title)} – Thymio Sim</title>
<link rel="icon" href="../favicon.svg" type="image/svg+xml">
<link rel="stylesheet" href="documentation.css">
</head>
<body>
<nav><a href="../index.html">Thymio Sim</a> <a href="index.html">Documentation</a></nav>
<main>
${html}
</main>
</body>
</html>
`;
}
