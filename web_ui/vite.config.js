// Bundles the page into dist/ with relative addresses, so that it can be served from any path.

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

export default defineConfig({
  base: "./",
  plugins: [evaluatedTexts, shippedDocumentation],
  build: {
    outDir: "dist",
    emptyOutDir: true,
    target: "es2022",
    // three.js alone is about 0.6 MB (docs/performance.md, "The page"). It has a chunk of its own, which a browser keeps
    // when only the page changes.
    chunkSizeWarningLimit: 700,
    rolldownOptions: {
      output: { codeSplitting: { groups: [{ name: "three", test: /node_modules[\\/]three[\\/]/ }] } },
    },
  },
});
