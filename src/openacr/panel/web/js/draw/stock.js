// What stock removal leaves of the blank: fetched while it is computed, painted with a depth buffer.
import { address } from "../core/api.js";
import { cross, dot } from "./camera.js";

const AGAIN_MS = 300;
const MARK = "OAS1";
const HEAD = 48;
const FULL = 65535;
const RAPID = 1;
const BELOW = 2;
const WHILE_MOVING = 160; // cells along the longer side while the view is being moved
const FINEST_PX = 0.8; // smaller cells are drawn together
/** Light comes from the left, from the back and from above. @type {[number, number, number]} */
const LIGHT = [-0.4, 0.45, 0.8];

/**
 * @typedef {object} Stock heights of the material at the middles of square cells, row by row of Y
 * @property {number} columns
 * @property {number} rows
 * @property {number} x low corner
 * @property {number} y
 * @property {number} cell
 * @property {number} bottom
 * @property {number} top
 * @property {Uint16Array} heights 0: the bottom, 65535: the top
 * @property {Uint8Array} marks 1: touched by a rapid, 2: cut below the bottom
 * @property {Uint32Array} rapidLines lines whose rapids touch material
 * @property {Uint32Array} belowLines lines that cut below the blank
 */

/**
 * @param {ArrayBuffer} data
 * @returns {Stock}
 */
function readStock(data) {
  const view = new DataView(data);
  const mark = String.fromCharCode(...new Uint8Array(data, 0, 4));
  if (mark !== MARK) throw new Error(`a stock begins with ${MARK}, not with ${mark}`);
  const [columns, rows, rapids, belows] = [4, 8, 36, 40].map((at) => view.getUint32(at, true));
  const [x, y, cell, bottom, top] = [16, 20, 24, 28, 32].map((at) => view.getFloat32(at, true));
  const after = HEAD + 4 * (rapids + belows);
  return {
    columns,
    rows,
    x,
    y,
    cell,
    bottom,
    top,
    rapidLines: new Uint32Array(data, HEAD, rapids),
    belowLines: new Uint32Array(data, HEAD + 4 * rapids, belows),
    heights: new Uint16Array(data, after, columns * rows),
    marks: new Uint8Array(data, after + 2 * columns * rows, columns * rows),
  };
}

/**
 * Fetch the stock of the loaded program; `note` gets the share that is computed. Throws the server's reason.
 * @param {(share: number) => void} note
 * @param {AbortSignal} signal
 */
export async function fetchStock(note, signal) {
  for (;;) {
    const response = await fetch(address("stock"), { signal });
    if (response.status === 200) return readStock(await response.arrayBuffer());
    const answer = await response.json();
    if (response.status !== 202) throw new Error(answer.error?.text ?? response.statusText);
    note(answer.done);
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
    signal.throwIfAborted();
  }
}

/** The box of a stock: min x y z, max x y z. @param {Stock} stock */
export function stockBox(stock) {
  const { x, y, cell, columns, rows, bottom, top } = stock;
  return [x, y, bottom, x + cell * columns, y + cell * rows, top];
}

/**
 * Paints a stock; the shades of its cells are computed once.
 * @param {HTMLCanvasElement} canvas
 */
export function stockPainter(canvas) {
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  /** @type {Stock | null} */
  let stock = null;
  let shades = new Uint8Array(0);
  let depths = new Float32Array(0);
  let image = new ImageData(1, 1);

  return {
    /** @param {Stock | null} next */
    setStock(next) {
      stock = next;
      shades = next ? shadesOf(next) : new Uint8Array(0);
    },
    /**
     * @param {import("./camera.js").Camera} camera
     * @param {Record<string, string>} colors
     * @param {boolean} isMoving
     */
    paint(camera, colors, isMoving) {
      pen.clearRect(0, 0, canvas.width, canvas.height);
      if (!stock || canvas.width < 2 || canvas.height < 2) return;
      if (image.width !== canvas.width || image.height !== canvas.height) {
        image = pen.createImageData(canvas.width, canvas.height);
        depths = new Float32Array(canvas.width * canvas.height);
      }
      image.data.fill(0);
      depths.fill(-Infinity);
      const palette = [colors.stock, colors.dip, colors.below].map(rgb);
      fill(stock, shades, camera, canvas.width / Math.max(1, camera.width), palette, isMoving, image, depths);
      pen.putImageData(image, 0, 0);
    },
  };
}

/**
 * Brightness of each cell, 0 to 255, by its slope.
 * @param {Stock} stock
 */
function shadesOf(stock) {
  const { columns, rows, heights, cell, bottom, top } = stock;
  const scale = (top - bottom) / FULL / (2 * cell);
  const shades = new Uint8Array(columns * rows);
  const [lx, ly, lz] = LIGHT;
  for (let row = 0; row < rows; row++) {
    const [before, after] = [Math.max(0, row - 1) * columns, Math.min(rows - 1, row + 1) * columns];
    for (let column = 0; column < columns; column++) {
      const at = row * columns + column;
      const dx =
        (heights[row * columns + Math.min(columns - 1, column + 1)] -
          heights[row * columns + Math.max(0, column - 1)]) *
        scale;
      const dy = (heights[after + column] - heights[before + column]) * scale;
      const light = (-dx * lx - dy * ly + lz) / Math.sqrt(dx * dx + dy * dy + 1);
      const depth = heights[at] / FULL; // deeper is darker, so that floors differ in the view from above
      shades[at] = Math.round(255 * Math.min(1, Math.max(0.4, light)) * (0.6 + 0.4 * depth));
    }
  }
  return shades;
}

/**
 * Fill all cells into an image, the nearest one in front.
 * @param {Stock} stock
 * @param {Uint8Array} shades
 * @param {import("./camera.js").Camera} camera
 * @param {number} ratio
 * @param {number[][]} palette
 * @param {boolean} isMoving
 * @param {ImageData} image
 * @param {Float32Array} depths
 */
function fill(stock, shades, camera, ratio, palette, isMoving, image, depths) {
  const { columns, rows, heights, marks, cell, bottom } = stock;
  const fine = Math.floor(FINEST_PX / (cell * camera.scale * ratio));
  const step = Math.max(1, fine, isMoving ? Math.ceil(Math.max(columns, rows) / WHILE_MOVING) : 1);
  const out = cross(camera.right, camera.up);
  const [a, b, c, d, e, f, g, i] = camera.matrix(ratio);
  const rise = (stock.top - bottom) / FULL;
  /** @type {number[]} */
  const across = [];
  for (let column = 0; column < columns; column += step) across.push(column);
  if (across[across.length - 1] !== columns - 1) across.push(columns - 1);
  const wide = across.length;
  /** Places on the screen and depths of a row of cells. */
  const place = (/** @type {number} */ row, /** @type {Float32Array} */ into, /** @type {boolean} */ isFoot) => {
    const y = stock.y + cell * (row + 0.5);
    for (let n = 0; n < wide; n++) {
      const x = stock.x + cell * (across[n] + 0.5);
      const z = isFoot ? bottom : bottom + rise * heights[row * columns + across[n]];
      into[3 * n] = a * x + b * y + c * z + d;
      into[3 * n + 1] = e * x + f * y + g * z + i;
      into[3 * n + 2] = out[0] * x + out[1] * y + out[2] * z;
    }
  };
  const pixels = new Uint32Array(image.data.buffer);
  const triangle = filler(pixels, depths, image.width, image.height);
  const quad = (
    /** @type {Float32Array} */ one,
    /** @type {Float32Array} */ two,
    /** @type {number} */ n,
    /** @type {number} */ m,
    /** @type {number} */ color,
  ) => {
    triangle(one, 3 * n, one, 3 * m, two, 3 * n, color);
    triangle(one, 3 * m, two, 3 * m, two, 3 * n, color);
  };
  const side = (/** @type {[number, number, number]} */ normal) =>
    tint(palette[0], Math.round(210 * Math.max(0.45, dot(normal, LIGHT))));
  let [behind, ahead] = [new Float32Array(3 * wide), new Float32Array(3 * wide)];
  const [footBehind, footAhead] = [new Float32Array(3 * wide), new Float32Array(3 * wide)];
  place(0, behind, false);
  place(0, footBehind, true);
  for (let n = 0; n + 1 < wide; n++) quad(behind, footBehind, n, n + 1, side([0, -1, 0]));
  for (let row = 0; row < rows - 1;) {
    const next = Math.min(rows - 1, row + step);
    place(next, ahead, false);
    place(next, footAhead, true);
    for (let n = 0; n + 1 < wide; n++) {
      const at = row * columns + across[n];
      const mark = marks[at] || marks[next * columns + across[n]] || marks[at + across[n + 1] - across[n]];
      quad(behind, ahead, n, n + 1, tint(palette[mark & RAPID ? 1 : mark & BELOW ? 2 : 0], mark ? 255 : shades[at]));
    }
    for (const n of [0, wide - 1])
      wall(triangle, behind, ahead, footBehind, footAhead, 3 * n, side([n ? 1 : -1, 0, 0]));
    [behind, ahead] = [ahead, behind];
    footBehind.set(footAhead);
    row = next;
  }
  for (let n = 0; n + 1 < wide; n++) quad(behind, footBehind, n, n + 1, side([0, 1, 0]));
}

/**
 * A piece of the left or right side of the blank.
 * @param {ReturnType<typeof filler>} triangle
 * @param {Float32Array} behind
 * @param {Float32Array} ahead
 * @param {Float32Array} footBehind
 * @param {Float32Array} footAhead
 * @param {number} at
 * @param {number} color
 */
function wall(triangle, behind, ahead, footBehind, footAhead, at, color) {
  triangle(behind, at, ahead, at, footBehind, at, color);
  triangle(ahead, at, footAhead, at, footBehind, at, color);
}

/**
 * Fills triangles of one colour where they are nearest.
 * @param {Uint32Array} pixels
 * @param {Float32Array} depths
 * @param {number} width
 * @param {number} height
 */
function filler(pixels, depths, width, height) {
  /**
   * @param {Float32Array} A
   * @param {number} a
   * @param {Float32Array} B
   * @param {number} b
   * @param {Float32Array} C
   * @param {number} c
   * @param {number} color
   */
  return (A, a, B, b, C, c, color) => {
    const x0 = A[a],
      y0 = A[a + 1],
      z0 = A[a + 2];
    const x1 = B[b],
      y1 = B[b + 1],
      z1 = B[b + 2];
    const x2 = C[c],
      y2 = C[c + 1],
      z2 = C[c + 2];
    const area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
    if (area === 0) return;
    const left = Math.max(0, Math.floor(Math.min(x0, x1, x2)));
    const right = Math.min(width - 1, Math.ceil(Math.max(x0, x1, x2)));
    const top = Math.max(0, Math.floor(Math.min(y0, y1, y2)));
    const foot = Math.min(height - 1, Math.ceil(Math.max(y0, y1, y2)));
    for (let y = top; y <= foot; y++) {
      for (let x = left; x <= right; x++) {
        const px = x + 0.5 - x0,
          py = y + 0.5 - y0;
        const v = (px * (y2 - y0) - py * (x2 - x0)) / area;
        const w = (py * (x1 - x0) - px * (y1 - y0)) / area;
        if (v < -1e-4 || w < -1e-4 || v + w > 1.0001) continue;
        const depth = z0 + v * (z1 - z0) + w * (z2 - z0);
        const at = y * width + x;
        if (depth <= depths[at]) continue;
        depths[at] = depth;
        pixels[at] = color;
      }
    }
  };
}

/**
 * A colour as a pixel, little endian: alpha, blue, green, red.
 * @param {number[]} color
 * @param {number} light 0 to 255
 */
function tint([red, green, blue], light) {
  const part = (/** @type {number} */ value) => Math.round((value * light) / 255);
  return ((255 << 24) | (part(blue) << 16) | (part(green) << 8) | part(red)) >>> 0;
}

/** @param {string} text a colour as `getComputedStyle` writes it */
function rgb(text) {
  return (text.match(/[\d.]+/g) ?? ["0", "0", "0"]).slice(0, 3).map(Number);
}
