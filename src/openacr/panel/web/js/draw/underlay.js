// What lies under and over the path: grid, origin, limits of the machine, blank, the chosen line.
import { endOf } from "./path.js";

const WISHED_PX = 56; // between lines of the grid

/**
 * @param {CanvasRenderingContext2D} pen in CSS pixels
 * @param {import("./camera.js").Camera} camera
 * @param {Record<string, string>} colors
 * @param {{ limits: number[] | null, blank: number[] | null, zero: number[] }} places boxes (min x y z, max x y z) of
 *   the machine and of the material, and the zero of the work coordinates
 */
export function paintGround(pen, camera, colors, { limits, blank, zero }) {
  pen.clearRect(0, 0, camera.width, camera.height);
  if (camera.isFlat) paintGrid(pen, camera, colors, zero);
  paintOrigin(pen, camera, colors, zero);
  if (limits) paintBox(pen, camera, limits, { color: colors.limit, width: 1.2, dashes: [6, 5] });
  if (blank) paintBox(pen, camera, blank, { color: colors.blank, width: 2, dashes: [] });
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {import("./camera.js").Camera} camera
 * @param {Record<string, string>} colors
 * @param {number[]} zero
 */
function paintGrid(pen, camera, colors, zero) {
  const step = niceStep(WISHED_PX / camera.scale);
  const [x0, y0] = camera.project(zero[0], zero[1], zero[2]);
  const gap = step * camera.scale;
  pen.strokeStyle = colors.grid;
  pen.lineWidth = 1;
  pen.beginPath();
  for (let x = ((x0 % gap) + gap) % gap; x < camera.width; x += gap)
    line(pen, Math.round(x) + 0.5, 0, Math.round(x) + 0.5, camera.height);
  for (let y = ((y0 % gap) + gap) % gap; y < camera.height; y += gap)
    line(pen, 0, Math.round(y) + 0.5, camera.width, Math.round(y) + 0.5);
  pen.stroke();
  pen.fillStyle = colors.text;
  pen.font = "12px system-ui, sans-serif";
  pen.fillText(`\u25a6 ${step}`, 8, camera.height - 8);
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {import("./camera.js").Camera} camera
 * @param {Record<string, string>} colors
 * @param {number[]} zero
 */
function paintOrigin(pen, camera, colors, zero) {
  const arm = 34 / camera.scale;
  const from = camera.project(zero[0], zero[1], zero[2]);
  const arms = /** @type {[string, [number, number, number]][]} */ ([
    ["X", [arm, 0, 0]],
    ["Y", [0, arm, 0]],
    ["Z", [0, 0, arm]],
  ]);
  pen.strokeStyle = pen.fillStyle = colors.text;
  pen.lineWidth = 1.5;
  pen.font = "600 12px system-ui, sans-serif";
  for (const [name, [x, y, z]] of arms) {
    const to = camera.project(zero[0] + x, zero[1] + y, zero[2] + z);
    if (Math.hypot(to[0] - from[0], to[1] - from[1]) < 6) continue;
    pen.beginPath();
    line(pen, ...from, ...to);
    pen.stroke();
    pen.fillText(name, to[0] + 3, to[1] - 3);
  }
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {import("./camera.js").Camera} camera
 * @param {number[]} box
 * @param {import("./flat.js").Look} look
 */
function paintBox(pen, camera, box, { color, width, dashes }) {
  pen.strokeStyle = color;
  pen.setLineDash(dashes);
  pen.lineWidth = width;
  pen.beginPath();
  for (let corner = 0; corner < 8; corner++) {
    for (const bit of [1, 2, 4]) {
      if (corner & bit) continue;
      const at = (/** @type {number} */ which) =>
        camera.project(box[which & 1 ? 3 : 0], box[which & 2 ? 4 : 1], box[which & 4 ? 5 : 2]);
      line(pen, ...at(corner), ...at(corner | bit));
    }
  }
  pen.stroke();
  pen.setLineDash([]);
}

/**
 * Mark what one line of the program draws.
 * @param {CanvasRenderingContext2D} pen
 * @param {import("./camera.js").Camera} camera
 * @param {string} color
 * @param {import("./path.js").ToolPath} path
 * @param {number} chosen
 */
export function paintChosen(pen, camera, color, path, chosen) {
  pen.strokeStyle = color;
  pen.lineWidth = 4;
  pen.lineCap = "round";
  pen.beginPath();
  for (let at = path.lines.indexOf(chosen); at > 0 && at < path.lines.length; at = path.lines.indexOf(chosen, at + 1)) {
    const place = (/** @type {number} */ n) =>
      camera.project(path.points[3 * n], path.points[3 * n + 1], path.points[3 * n + 2]);
    line(pen, ...place(at - 1), ...place(at));
  }
  pen.stroke();
}

/**
 * The line of the program whose stroke is nearest to a point of the screen; 0 if none is near.
 * @param {import("./camera.js").Camera} camera
 * @param {import("./path.js").ToolPath} path
 * @param {number} x
 * @param {number} y
 */
export function lineAt(camera, path, x, y) {
  const [a, b, c, d, e, f, g, i] = camera.matrix(1);
  const { points, lines } = path;
  let [best, found] = [14, 0];
  for (let part = 0; part < path.starts.length; part++) {
    for (let at = path.starts[part] + 1; at < endOf(path, part); at++) {
      const [j, k] = [3 * at - 3, 3 * at];
      const [x0, y0] = [
        a * points[j] + b * points[j + 1] + c * points[j + 2] + d,
        e * points[j] + f * points[j + 1] + g * points[j + 2] + i,
      ];
      const [dx, dy] = [
        a * points[k] + b * points[k + 1] + c * points[k + 2] + d - x0,
        e * points[k] + f * points[k + 1] + g * points[k + 2] + i - y0,
      ];
      const along = Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy || 1)));
      const away = Math.hypot(x - x0 - along * dx, y - y0 - along * dy);
      if (away < best) [best, found] = [away, lines[at]];
    }
  }
  return found;
}

/** @param {number} wished */
function niceStep(wished) {
  const power = 10 ** Math.floor(Math.log10(wished));
  const step = [1, 2, 5, 10].find((each) => each * power >= wished) ?? 10;
  return Number((step * power).toPrecision(3));
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {number} x0
 * @param {number} y0
 * @param {number} x1
 * @param {number} y1
 */
function line(pen, x0, y0, x1, y1) {
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
}
