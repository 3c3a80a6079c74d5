// Bundles the page into dist/ with relative addresses, so that it can be served from any path.

import { readdirSync, readFileSync } from "node:fs";

import { fileURLToPath } from "node:url";

import { defineConfig } from "vite";

import { documentation } from "./documentation/pages.js";

/**
 * Modules `*.texts.js` read files, which a browser cannot: they run here, and the page gets their values.
 *
 * @type {import("vite").Plugin}
 */
const evaluatedTexts = {
  name: "evaluated-texts",
  async load(id) {
    if (!id.endsWith(".texts.js")) return null;
    const { default: texts } = await import(id);
    return `export default ${JSON.stringify(texts)};`;
  },
};

/** The pages of docs/ that ship with the page. @type {import("vite").Plugin} */
const shippedDocumentation = {
  name: "shipped-documentation",
  generateBundle() {
    for (const { fileName, source } of documentation()) this.emitFile({ type: "asset", fileName, source });
  },
};

/** Pictures and cursors that Blockly loads by their names. Its sounds are not used. @type {import("vite").Plugin} */
const blocklyMedia = {
  name: "blockly-media",
  generateBundle() {
    const folder = new URL("node_modules/blockly/media/", import.meta.url);
    for (const name of readdirSync(folder).filter((each) => !each.endsWith(".mp3"))) {
      this.emitFile({ type: "asset", fileName: `blockly/${name}`, source: readFileSync(new URL(name, folder)) });
    }
  },
};

/**
 * Parts that all pages share: `<!-- part: NAME key="value" -->` stands for `parts/NAME.html` with `{key}` replaced.
 *
 * @type {import("vite").Plugin}
 */
const sharedParts = {
  name: "shared-parts",
  transformIndexHtml: {
    order: "pre",
    handler: (html) =>
      html.replace(/^( *)<!-- part: (\w+)((?: \w+="[^"]*")*) -->\n/gm, (_, indent, name, given) => {
        const values = Object.fromEntries([...given.matchAll(/(\w+)="([^"]*)"/g)].map(([, key, value]) => [key, value]));
        const part = readFileSync(here(`parts/${name}.html`), "utf8").replace(/\{(\w+)\}/g, (_, key) => values[key]);
        return part.replace(/^(?=.)/gm, indent);
      }),
  },
};

/** @param {string} file */
function here(file) {
  return fileURLToPath(new URL(file, import.meta.url));
}

/** The command that converts blocks outside of a browser: one file for Node (`vite build --ssr`). @type {import("vite").UserConfig} */
const command = {
  plugins: [evaluatedTexts],
  publicDir: false,
  ssr: { noExternal: true },
  build: {
    outDir: "dist/node",
    target: "node20",
    rolldownOptions: { input: here("blockly/convert.js"), output: { entryFileNames: "[name].mjs" } },
  },
};

/** @type {import("vite").UserConfig} */
const page = {
  base: "./",
  plugins: [evaluatedTexts, sharedParts, shippedDocumentation, blocklyMedia],
  build: {
    outDir: "dist",
    emptyOutDir: true,
    target: "es2022",
    // three.js alone is about 0.6 MB (docs/performance.md, "The page"). It has a chunk of its own, which a browser keeps
    // when only the page changes. So has Blockly (0.85 MB), which is loaded with the first program of blocks.
    chunkSizeWarningLimit: 900,
    rolldownOptions: {
      // the page, that of a teacher, and the first page of a class
      input: { index: here("index.html"), class: here("class.html"), join: here("join.html") },
      output: {
        codeSplitting: {
          groups: [
            { name: "three", test: /node_modules[\\/]three[\\/]/ },
            { name: "blockly", test: /node_modules[\\/](blockly[\\/](?!msg[\\/])|@blockly[\\/])/ },
          ],
        },
      },
    },
  },
};

export default defineConfig(({ isSsrBuild }) => (isSsrBuild ? command : page));
