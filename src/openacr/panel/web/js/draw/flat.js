// The path in a two-dimensional canvas: on machines without a GPU six times as fast as WebGL.
import { KIND, endOf } from "./path.js";

const THIN = 20000; // points drawn while the view is being moved

/**
 * @typedef {object} Painter draws a path into its canvas
 * @property {(path: import("./path.js").ToolPath | null) => void} setPath
 * @property {(camera: import("./camera.js").Camera, colors: Record<string, string>, byPart: ((color: number) => string) | null, isMoving: boolean) => void} paint
 * @property {(from: number, to: number) => void} paintCut
 * @property {() => void} close
 */

/**
 * @param {HTMLCanvasElement} canvas
 * @returns {Painter}
 */
export function flatPainter(canvas) {
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  /** @type {import("./path.js").ToolPath | null} */
  let drawn = null;
  let matrix = [0, 0, 0, 0, 0, 0, 0, 0];
  let cutColor = "";

  /**
   * @param {number} first
   * @param {number} last one after the last point
   * @param {number} step
   */
  function trace(first, last, step) {
    const { points } = /** @type {import("./path.js").ToolPath} */ (drawn);
    const [a, b, c, d, e, f, g, i] = matrix;
    for (let at = first; at < last; at += step) {
      const k = 3 * at;
      const [x, y] = [a * points[k] + b * points[k + 1] + c * points[k + 2] + d, e * points[k] + f * points[k + 1] + g * points[k + 2] + i];
      if (at === first) pen.moveTo(x, y);
      else pen.lineTo(x, y);
    }
    if (step > 1 && last > first) {
      const k = 3 * (last - 1);
      pen.lineTo(a * points[k] + b * points[k + 1] + c * points[k + 2] + d, e * points[k] + f * points[k + 1] + g * points[k + 2] + i);
    }
  }

  return {
    setPath(path) {
      drawn = path;
    },
    paint(camera, colors, byPart, isMoving) {
      const ratio = canvas.width / Math.max(1, camera.width);
      matrix = camera.matrix(ratio);
      cutColor = colors.cut;
      pen.clearRect(0, 0, canvas.width, canvas.height);
      if (!drawn) return;
      const step = isMoving ? Math.max(1, Math.ceil(drawn.lines.length / THIN)) : 1;
      /** @type {Map<string, number[]>} */
      const groups = new Map();
      drawn.kinds.forEach((kind, n) => {
        const color = byPart && kind !== KIND.rapid ? byPart(drawn?.colors[n] ?? 0) : "";
        const name = kind === KIND.rapid || kind === KIND.inserted || kind === KIND.compensated ? `${kind}|${color}` : `${KIND.feed}|${color}`;
        groups.set(name, [...(groups.get(name) ?? []), n]);
      });
      for (const [name, parts] of groups) {
        const [kind, color] = name.split("|");
        const isRapid = Number(kind) === KIND.rapid;
        pen.strokeStyle = isRapid ? colors.rapid : color || colors.feed;
        pen.lineWidth = ratio * (isRapid ? 0.8 : 1.25);
        pen.setLineDash(isMoving ? [] : isRapid ? [4 * ratio, 4 * ratio] : Number(kind) === KIND.compensated ? [8 * ratio, 3 * ratio] : []);
        pen.beginPath();
        for (const n of parts) trace(drawn.starts[n], endOf(drawn, n), step);
        pen.stroke();
      }
      pen.setLineDash([]);
    },
    paintCut(from, to) {
      if (!drawn || to <= from) return;
      pen.strokeStyle = cutColor;
      pen.lineWidth = (canvas.width / Math.max(1, canvas.clientWidth)) * 2;
      pen.beginPath();
      trace(from, to + 1, 1);
      pen.stroke();
    },
    close() {},
  };
}
