// Draws time series on a canvas. Lines differ by color and by dash pattern.

/** @typedef {import("./history.js").Series} Series */

export const STYLES = [
  { color: "#1259b8", dashes: [], mark: "━━" },
  { color: "#b3201a", dashes: [7, 3], mark: "╍╍" },
  { color: "#14703c", dashes: [2, 3], mark: "┅┅" },
  { color: "#7a1fa2", dashes: [10, 3, 2, 3], mark: "━╍" },
  { color: "#8a4b00", dashes: [4, 4], mark: "╌╌" },
  { color: "#0b6b75", dashes: [12, 4], mark: "─ ─" },
];
const MARGIN = { left: 52, right: 10, top: 10, bottom: 22 }; // pixels

/** A round step that gives about `count` lines over a range. @param {number} range @param {number} count */
export function roundStep(range, count) {
  const rough = Math.max(range, 1e-9) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= rough) ?? power;
}

/** @param {HTMLCanvasElement} canvas @param {Series[]} series @param {number} span  seconds before the newest point */
export function drawPlot(canvas, series, span) {
  const context = canvas.getContext("2d");
  if (context === null || canvas.clientWidth === 0) return;
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  context.scale(ratio, ratio);
  context.clearRect(0, 0, width, height);
  if (series.length === 0) return;
  const end = Math.max(...series.map(({ times }) => times.at(-1) ?? 0));
  const visible = series.map(({ times, values }) => {
    const first = Math.max(times.findIndex((time) => time >= end - span) - 1, 0);
    return { times: times.slice(first), values: values.slice(first) };
  });
  const all = visible.flatMap(({ values }) => values);
  const step = roundStep(Math.max(...all) - Math.min(...all) || 1, 4);
  const low = Math.floor(Math.min(...all) / step) * step;
  const high = Math.max(Math.ceil(Math.max(...all) / step) * step, low + step);
  const inner = { width: width - MARGIN.left - MARGIN.right, height: height - MARGIN.top - MARGIN.bottom };
  /** @param {number} time */
  const x = (time) => MARGIN.left + (1 - (end - time) / span) * inner.width;
  /** @param {number} value */
  const y = (value) => MARGIN.top + (1 - (value - low) / (high - low)) * inner.height;

  context.font = "11px system-ui, sans-serif";
  context.fillStyle = "#4d5d70";
  context.strokeStyle = "#d5dee8";
  context.textAlign = "right";
  for (let value = low; value <= high + step / 2; value += step) {
    context.beginPath();
    context.moveTo(MARGIN.left, y(value));
    context.lineTo(width - MARGIN.right, y(value));
    context.stroke();
    context.fillText(String(Math.round(value * 100) / 100), MARGIN.left - 5, y(value) + 4);
  }
  context.textAlign = "center";
  const tick = roundStep(span, 5);
  for (let back = 0; back <= span; back += tick) {
    context.fillText(back === 0 ? "0 s" : `−${back}`, Math.max(x(end - back), MARGIN.left), height - 6);
  }
  context.save();
  context.beginPath();
  context.rect(MARGIN.left, 0, inner.width, height);
  context.clip();
  context.lineWidth = 1.8;
  visible.forEach(({ times, values }, index) => {
    const { color, dashes } = STYLES[index % STYLES.length];
    context.strokeStyle = color;
    context.setLineDash(dashes);
    context.beginPath();
    times.forEach((time, at) =>
      at === 0 ? context.moveTo(x(time), y(values[at])) : context.lineTo(x(time), y(values[at])),
    );
    context.lineTo(x(end), y(values.at(-1) ?? low));
    context.stroke();
  });
  context.restore();
}
