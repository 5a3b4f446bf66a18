// One trace over another, both in divisions: the path of two axes, force over position.
import { DIVISIONS } from "./screen.js";

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 */
export function createXy(host, endings) {
  const canvas = document.createElement("canvas");
  canvas.className = "scope-canvas";
  host.append(canvas);
  /** @type {import("./screen.js").Trace[]} */
  let both = [];
  const sizes = new ResizeObserver(() => paint());
  sizes.observe(host);
  endings.add(() => sizes.disconnect());

  function paint() {
    const style = getComputedStyle(host);
    const size = Math.min(host.clientWidth, host.clientHeight) * devicePixelRatio;
    canvas.width = canvas.height = size;
    canvas.style.width = canvas.style.height = `${size / devicePixelRatio}px`;
    const ctx = canvas.getContext("2d");
    if (!ctx || !size) return;
    const step = size / DIVISIONS;
    ctx.strokeStyle = style.borderColor;
    for (let n = 0; n <= DIVISIONS; n++) {
      ctx.strokeRect(n * step, 0, 0, size);
      ctx.strokeRect(0, n * step, size, 0);
    }
    if (both.length < 2) return;
    const [x, y] = both;
    const place = (/** @type {import("./screen.js").Trace} */ trace, /** @type {number} */ n) => (trace.values[n] - trace.offset) / trace.scale;
    ctx.strokeStyle = y.color;
    ctx.lineWidth = 1.6 * devicePixelRatio;
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
     * @param {import("./screen.js").Trace | undefined} x
     * @param {import("./screen.js").Trace | undefined} y
     */
    draw(x, y) {
      both = x && y ? [x, y] : [];
      paint();
    },
  };
}
