// One trace over another with the scales of both: the path of two axes, force over position.
import { onTheme } from "../core/theme.js";
import { DIVISIONS, HALF } from "./scales.js";

const LETTERS = 12; // pixels
const MARGIN = { left: 74, bottom: 40, top: 10, right: 14 };

/** @typedef {import("./channels.js").Channel} Channel */

/**
 * The value of a trace at a line of the grid.
 * @param {{ scale: number, offset: number }} trace
 * @param {number} divisions from the middle
 */
export function valueAt({ scale, offset }, divisions) {
  return String(Number((divisions * scale + offset).toPrecision(6))).replace("-", "\u2212");
}

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {(trace: Channel) => string} nameOf
 */
export function createXy(host, endings, nameOf) {
  const canvas = document.createElement("canvas");
  canvas.className = "scope-canvas";
  host.append(canvas);
  /** @type {Channel[]} */
  let both = [];
  const sizes = new ResizeObserver(() => paint());
  sizes.observe(host);
  endings.add(
    onTheme(() => paint()),
    () => sizes.disconnect(),
  );

  function paint() {
    const style = getComputedStyle(host);
    const size = Math.floor(
      Math.min(host.clientWidth - MARGIN.left - MARGIN.right, host.clientHeight - MARGIN.top - MARGIN.bottom),
    );
    if (size <= 0) return;
    const [width, height] = [size + MARGIN.left + MARGIN.right, size + MARGIN.top + MARGIN.bottom];
    [canvas.width, canvas.height] = [width * devicePixelRatio, height * devicePixelRatio];
    [canvas.style.width, canvas.style.height] = [`${width}px`, `${height}px`];
    const ctx = canvas.getContext("2d");
    if (!ctx) return;
    ctx.scale(devicePixelRatio, devicePixelRatio);
    ctx.translate(MARGIN.left, MARGIN.top);
    ctx.font = `${LETTERS}px sans-serif`;
    ctx.fillStyle = style.color;
    ctx.strokeStyle = style.borderColor;
    const step = size / DIVISIONS;
    for (let n = 0; n <= DIVISIONS; n++) {
      ctx.strokeRect(n * step, 0, 0, size);
      ctx.strokeRect(0, n * step, size, 0);
    }
    if (both.length < 2) return;
    const [x, y] = both;
    const every = [1, 2, 5].find((each) => each * step > 8 * LETTERS) ?? HALF;
    for (let n = -HALF; n <= HALF; n++) {
      if (n % every) continue;
      ctx.textAlign = "center";
      ctx.fillText(valueAt(x, n), (n + HALF) * step, size + 1.3 * LETTERS);
      ctx.textAlign = "right";
      ctx.fillText(valueAt(y, n), -6, size - (n + HALF) * step + LETTERS / 3);
    }
    ctx.textAlign = "center";
    ctx.fillText(nameOf(x), size / 2, size + 2.8 * LETTERS, size);
    ctx.save();
    ctx.rotate(-Math.PI / 2);
    ctx.fillText(nameOf(y), -size / 2, LETTERS - MARGIN.left, size);
    ctx.restore();
    const place = (/** @type {Channel} */ trace, /** @type {number} */ n) =>
      (trace.values[n] - trace.offset) / trace.scale;
    ctx.beginPath();
    ctx.rect(0, 0, size, size);
    ctx.clip();
    ctx.strokeStyle = y.color;
    ctx.lineWidth = 1.6;
    ctx.beginPath();
    let isDown = false;
    for (let n = 0; n < Math.min(x.values.length, y.values.length); n++) {
      const [right, up] = [place(x, n), place(y, n)];
      const isThere = Number.isFinite(right) && Number.isFinite(up);
      if (isThere) ctx[isDown ? "lineTo" : "moveTo"](size / 2 + right * step, size / 2 - up * step);
      isDown = isThere;
    }
    ctx.stroke();
  }

  return {
    canvas,
    /**
     * @param {Channel | undefined} x
     * @param {Channel | undefined} y
     * @param {boolean} [isEqual] both with the coarser scale: a circle is round
     */
    draw(x, y, isEqual = false) {
      both = x && y ? [x, y] : [];
      if (isEqual && x && y) both = both.map((each) => ({ ...each, scale: Math.max(x.scale, y.scale) }));
      paint();
    },
  };
}
