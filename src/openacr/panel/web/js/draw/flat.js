// Strokes in a two-dimensional canvas: on machines without a GPU six times as fast as WebGL.

const THIN = 16000; // points drawn while the view is being moved
const SAME_PX = 0.4; // a point nearer to the last one drawn is left out

/**
 * @typedef {object} Drawing points with the lines between them
 * @property {Float32Array} points x y z
 * @property {Uint32Array[]} strokes of one look each: first and last point of every run, in pairs
 *
 * @typedef {object} Look how a stroke is drawn; dashes in pixels
 * @property {string} color
 * @property {number} width
 * @property {number[]} dashes
 * @property {boolean} [isHidden]
 *
 * @typedef {object} Painter draws into its canvas
 * @property {(drawing: Drawing | null) => void} setDrawing
 * @property {(camera: import("./camera.js").Camera, looks: Look[], isMoving: boolean, last?: number) => void} paint up
 *   to the point `last`
 * @property {(from: number, to: number, color: string) => void} paintCut the points between, over the rest
 * @property {() => void} close
 */

/**
 * How many points are left out between two that are drawn while the view is being moved.
 * @param {Drawing} drawing
 */
export function thinning(drawing) {
  return Math.max(1, Math.ceil(drawing.points.length / 3 / THIN));
}

/**
 * @param {HTMLCanvasElement} canvas
 * @returns {Painter}
 */
export function flatPainter(canvas) {
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  /** @type {Drawing | null} */
  let drawn = null;
  let matrix = [0, 0, 0, 0, 0, 0, 0, 0];

  /**
   * Lines from point to point, both included.
   * @param {Float32Array} points
   * @param {number} first
   * @param {number} last
   * @param {number} step
   */
  function trace(points, first, last, step) {
    const [a, b, c, d, e, f, g, i] = matrix;
    let px = Infinity;
    let py = Infinity;
    for (let at = first; at <= last; at = at < last ? Math.min(last, at + step) : at + 1) {
      const k = 3 * at;
      const x = a * points[k] + b * points[k + 1] + c * points[k + 2] + d;
      const y = e * points[k] + f * points[k + 1] + g * points[k + 2] + i;
      if (at === first) pen.moveTo(x, y);
      else if (at === last || Math.abs(x - px) + Math.abs(y - py) > SAME_PX) pen.lineTo(x, y);
      else continue;
      px = x;
      py = y;
    }
  }

  return {
    setDrawing(drawing) {
      drawn = drawing;
    },
    paint(camera, looks, isMoving, last = Infinity) {
      const ratio = canvas.width / Math.max(1, camera.width);
      matrix = camera.matrix(ratio);
      pen.clearRect(0, 0, canvas.width, canvas.height);
      if (!drawn) return;
      const step = isMoving ? thinning(drawn) : 1;
      for (const [n, spans] of drawn.strokes.entries()) {
        const { color, width, dashes, isHidden } = looks[n];
        if (isHidden) continue;
        pen.strokeStyle = color;
        pen.lineWidth = ratio * width;
        pen.setLineDash(isMoving ? [] : dashes.map((each) => each * ratio));
        pen.beginPath();
        const apart = isMoving ? 2 * Math.max(1, Math.ceil(spans.length / 2 / THIN)) : 2;
        for (let k = 0; k < spans.length && spans[k] < last; k += apart)
          trace(drawn.points, spans[k], Math.min(spans[k + 1], last), step);
        pen.stroke();
      }
      pen.setLineDash([]);
    },
    paintCut(from, to, color) {
      if (!drawn || to <= from) return;
      pen.strokeStyle = color;
      pen.lineWidth = (canvas.width / Math.max(1, canvas.clientWidth)) * 2;
      pen.beginPath();
      trace(drawn.points, from, to, 1);
      pen.stroke();
    },
    close() {},
  };
}
