// The browser may take the graphics context away, and often gives it back.

/** If it does not within this time, the context is gone. */
const GONE_MS = 4000;

/**
 * @param {HTMLCanvasElement} canvas
 * @param {(trouble: "lost" | "gone" | null) => void} report   null: it is back, and everything must be drawn anew
 */
export function watchContextLoss(canvas, report) {
  let timer = 0;
  canvas.addEventListener("webglcontextlost", () => {
    report("lost");
    timer = window.setTimeout(() => report("gone"), GONE_MS);
  });
  canvas.addEventListener("webglcontextrestored", () => {
    window.clearTimeout(timer);
    report(null);
  });
}
