// A parallel projection: which way is right and up, what is in the middle, how large.

/** @typedef {[number, number, number]} Vector */

const SIN = Math.sin(Math.PI / 6);
const ROOT = Math.SQRT1_2;
/** @type {Record<string, { right: Vector, up: Vector, isFlat: boolean }>} */
export const VIEWS = {
  top: { right: [1, 0, 0], up: [0, 1, 0], isFlat: true },
  front: { right: [1, 0, 0], up: [0, 0, 1], isFlat: true },
  side: { right: [0, 1, 0], up: [0, 0, 1], isFlat: true },
  iso: { right: [ROOT, ROOT, 0], up: [-ROOT * SIN, ROOT * SIN, Math.cos(Math.PI / 6)], isFlat: false },
};
const FILL = 0.86; // share of the window that a fitted box takes

/** What is seen. Screen coordinates in CSS pixels, y downwards. */
export class Camera {
  constructor() {
    /** @type {Vector} */
    this.right = [1, 0, 0];
    /** @type {Vector} */
    this.up = [0, 1, 0];
    /** @type {Vector} */
    this.middle = [0, 0, 0];
    this.scale = 1; // pixels per unit
    this.width = 1;
    this.height = 1;
    this.isFlat = true;
    this.inset = 0; // pixels on the right that keys cover
    /** Signs and exchange of the DISPLAY tab; they act on the picture only. */
    this.flip = { x: 1, y: 1, exchange: false };
  }

  /** @param {string} name */
  look(name) {
    const view = VIEWS[name];
    const turn = (/** @type {Vector} */ [x, y, z]) =>
      /** @type {Vector} */ (
        this.flip.exchange ? [y * this.flip.x, x * this.flip.y, z] : [x * this.flip.x, y * this.flip.y, z]
      );
    this.right = turn(view.right);
    this.up = turn(view.up);
    this.isFlat = view.isFlat;
  }

  /**
   * @param {number} x
   * @param {number} y
   * @param {number} z
   * @returns {[number, number]}
   */
  project(x, y, z) {
    const [dx, dy, dz] = [x - this.middle[0], y - this.middle[1], z - this.middle[2]];
    return [
      this.width / 2 + this.scale * (dx * this.right[0] + dy * this.right[1] + dz * this.right[2]),
      this.height / 2 - this.scale * (dx * this.up[0] + dy * this.up[1] + dz * this.up[2]),
    ];
  }

  /**
   * The row of numbers that maps points to pixels: a x + b y + c z + d, first right, then down.
   * @param {number} ratio device pixels per CSS pixel
   */
  matrix(ratio) {
    const s = this.scale * ratio;
    const [r, u, m] = [this.right, this.up, this.middle];
    return [
      s * r[0],
      s * r[1],
      s * r[2],
      (this.width * ratio) / 2 - s * dot(r, m),
      -s * u[0],
      -s * u[1],
      -s * u[2],
      (this.height * ratio) / 2 + s * dot(u, m),
    ];
  }

  /**
   * Fit a box: min x y z, max x y z.
   * @param {number[]} box
   */
  fit(box) {
    this.middle = /** @type {Vector} */ ([0, 1, 2].map((n) => (box[n] + box[n + 3]) / 2));
    const extent = (/** @type {Vector} */ way) =>
      [0, 1, 2].reduce((sum, n) => sum + Math.abs(way[n]) * (box[n + 3] - box[n]), 0);
    const [wide, high] = [Math.max(extent(this.right), 1e-6), Math.max(extent(this.up), 1e-6)];
    this.scale = FILL * Math.min(Math.max(1, this.width - this.inset) / wide, this.height / high, 1e6);
    this.pan(-this.inset / 2, 0);
  }

  /**
   * Fit points of space.
   * @param {Vector[]} points
   */
  fitPoints(points) {
    const [[left, right], [low, high]] = [this.right, this.up].map((way) =>
      ends(points.map((point) => dot(point, way))),
    );
    const out = cross(this.right, this.up);
    const [x, y, z] = [(left + right) / 2, (low + high) / 2, dot(this.middle, out)];
    this.middle = /** @type {Vector} */ ([0, 1, 2].map((n) => x * this.right[n] + y * this.up[n] + z * out[n]));
    this.scale =
      FILL *
      Math.min(
        Math.max(1, this.width - this.inset) / Math.max(right - left, 1e-6),
        this.height / Math.max(high - low, 1e-6),
        1e6,
      );
    this.pan(-this.inset / 2, 0);
  }

  /**
   * Whether all of some points of space are in the picture, beside its keys.
   * @param {Vector[]} points
   */
  shows(points) {
    return points.every((point) => {
      const [x, y] = this.project(...point);
      return x >= 0 && x <= this.width - this.inset && y >= 0 && y <= this.height;
    });
  }

  /**
   * Move what is seen by pixels.
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    this.middle = /** @type {Vector} */ (
      this.middle.map((value, n) => value - (dx * this.right[n] - dy * this.up[n]) / this.scale)
    );
  }

  /**
   * Zoom about a point of the screen.
   * @param {number} factor
   * @param {number} x
   * @param {number} y
   */
  zoom(factor, x, y) {
    const [dx, dy] = [x - this.width / 2, y - this.height / 2];
    this.pan(-dx, -dy);
    this.scale = Math.min(1e6, Math.max(1e-5, this.scale * factor));
    this.pan(dx, dy);
  }

  /**
   * Turn about the vertical axis of the machine and about the right of the screen.
   * @param {number} yaw radians
   * @param {number} pitch radians
   */
  turn(yaw, pitch) {
    const [s, c] = [Math.sin(yaw), Math.cos(yaw)];
    const about = (/** @type {Vector} */ [x, y, z]) => /** @type {Vector} */ ([c * x - s * y, s * x + c * y, z]);
    this.right = about(this.right);
    this.up = about(this.up);
    const out = cross(this.right, this.up);
    const [sp, cp] = [Math.sin(pitch), Math.cos(pitch)];
    this.up = /** @type {Vector} */ (this.up.map((value, n) => value * cp + out[n] * sp));
    this.isFlat = false;
  }
}

/** @param {number[]} values @returns {[number, number]} */
const ends = (values) => [Math.min(...values), Math.max(...values)];

/**
 * @param {Vector} a
 * @param {Vector} b
 */
export function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/**
 * @param {Vector} a
 * @param {Vector} b
 * @returns {Vector}
 */
export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
