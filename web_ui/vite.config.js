// Bundles the page into dist/ with relative addresses, so that it can be served from any path.

import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  build: {
    outDir: "dist",
    emptyOutDir: true,
    target: "es2022",
    // three.js alone is about 0.6 MB (docs/performance.md, "The page"); warn only beyond the page's budget.
    chunkSizeWarningLimit: 800,
  },
});
