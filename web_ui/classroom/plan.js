// A world seen from above on a small canvas: cheap enough for thirty pupils.

/** @typedef {{ name: string, color: string, pose: number[], moves: boolean, points?: number[], radius?: number }} PlanSolid */
/**
 * @typedef {object} Plan   (thymio_sim_ros/classroom/plan.py)
 * @property {string} title
 * @property {Record<string, string>} titles  by language
 * @property {number[]} bounds                left, bottom, right, top in m
 * @property {[string, number[]][]} patches   color, outline
 * @property {PlanSolid[]} solids
 */

/** The robot, in m: half its width, its rear and its front before the middle of its axle (docs/spec/thymio-robot.md). */
const HALF_WIDTH = 0.055;
const REAR = -0.03;
const FRONT = 0.08;
const MARGIN = 0.04;
/** Patches of one line touch: without a rim, the ground would show between them. */
const SEAM = 0.003;
/** Brightness of an LED. */
const FULL = 32;
/** Smallest half width of a robot in pixels: in large playgrounds it is drawn larger than it is. */
const SMALLEST_PX = 7;

/**
 * The scale and origin by which a plan fills a picture. Pure.
 *
 * @param {readonly number[]} bounds
 * @param {number} width  px
 * @param {number} height px
 */
export function fit([left, bottom, right, top], width, height) {
  const scale = Math.min(width / (right - left + 2 * MARGIN), height / (top - bottom + 2 * MARGIN));
  return { scale, x: width / 2 - (scale * (left + right)) / 2, y: height / 2 + (scale * (bottom + top)) / 2 };
}

/**
 * The color of a robot's body with its top LED. Pure.
 *
 * @param {readonly number[]} led  red, green, blue, 0…32
 */
export function bodyColor(led) {
  const brightest = Math.max(0, ...led);
  if (brightest === 0) return "#ffffff";
  const part = 0.35 + (0.65 * brightest) / FULL;
  return `rgb(${led.map((value) => Math.round(255 * (1 - part + (part * value) / brightest))).join(" ")})`;
}

/**
 * @param {HTMLCanvasElement} canvas  its CSS size decides that of the picture
 * @param {Plan} plan
 * @param {import("./api.js").Overview} overview
 */
export function drawPlan(canvas, plan, overview) {
  const ratio = Math.min(2, window.devicePixelRatio || 1);
  const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
  const context = canvas.getContext("2d");
  if (context === null || width === 0) return;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const { scale, x, y } = fit(plan.bounds, width, height);
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, width, height);
  context.setTransform(scale, 0, 0, -scale, x, y);
  for (const [color, points] of plan.patches) fill(context, color, points);
  for (const solid of plan.solids) {
    const pose = solid.moves ? (overview.objects?.[solid.name] ?? (overview.objects ? null : solid.pose)) : solid.pose;
    if (pose !== null) at(context, pose, () => drawSolid(context, solid, 1 / scale));
  }
  const size = Math.max(1, (SMALLEST_PX * ratio) / (HALF_WIDTH * scale));
  for (const pose of Object.values(overview.robots ?? {})) {
    at(context, pose, () => {
      context.scale(size, size);
      drawRobot(context, pose.slice(3));
    });
  }
}

/** @param {CanvasRenderingContext2D} context @param {readonly number[]} pose @param {() => void} draw */
function at(context, [x, y, yaw], draw) {
  context.save();
  context.translate(x, y);
  context.rotate(yaw);
  draw();
  context.restore();
}

/** @param {CanvasRenderingContext2D} context @param {PlanSolid} solid @param {number} thin  width of a line of a pixel */
function drawSolid(context, { color, points, radius }, thin) {
  context.beginPath();
  if (radius !== undefined) context.arc(0, 0, radius, 0, 2 * Math.PI);
  else trace(context, points ?? []);
  context.fillStyle = color;
  context.fill();
  context.lineWidth = thin;
  context.strokeStyle = "rgb(0 0 0 / 45%)";
  context.stroke();
}

/** @param {CanvasRenderingContext2D} context @param {readonly number[]} led */
function drawRobot(context, led) {
  context.beginPath();
  context.moveTo(REAR, -HALF_WIDTH);
  context.lineTo(0.035, -HALF_WIDTH);
  context.quadraticCurveTo(FRONT + 0.012, 0, 0.035, HALF_WIDTH);
  context.lineTo(REAR, HALF_WIDTH);
  context.closePath();
  context.fillStyle = bodyColor(led);
  context.fill();
  context.lineWidth = 0.006;
  context.strokeStyle = "#25232b";
  context.stroke();
  context.beginPath();
  context.arc(0.028, 0, 0.013, 0, 2 * Math.PI);
  context.fillStyle = "#25232b";
  context.fill();
}

/** @param {CanvasRenderingContext2D} context @param {string} color @param {readonly number[]} points */
function fill(context, color, points) {
  context.beginPath();
  trace(context, points);
  context.fillStyle = context.strokeStyle = color;
  context.fill();
  context.lineWidth = SEAM;
  context.stroke();
}

/** @param {CanvasRenderingContext2D} context @param {readonly number[]} points */
function trace(context, points) {
  for (let index = 0; index < points.length; index += 2) context.lineTo(points[index], points[index + 1]);
  context.closePath();
}
