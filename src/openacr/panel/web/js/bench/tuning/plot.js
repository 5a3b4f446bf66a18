// One chart of curves: a title with the values at the pointer, marks of margins.
import { h, setText } from "../../core/dom.js";
import { plain } from "../../core/format.js";
import { uPlot } from "../../../vendor/uplot.js";

/** Colours of the curves of the present measurement. @type {Record<string, string>} */
export const INK = {
  measured: "#1f77b4",
  modelled: "#d62758",
  setpoint: "#8a8a8a",
  present: "#e07b00",
  proposed: "#2ca02c",
};
const LOWEST = 60; // pixels
const SPACE = 22; // pixels from one line of the grid to the next, at least

/**
 * @typedef {{ label: string, ink: string, x: number[], y: number[], isDots?: boolean, dash?: number[] }} Curve `ink` is
 *   a name of INK, or a colour
 * @typedef {{ at: number, from: number, to: number, ink: string }} Mark
 *
 * @typedef {object} Looks
 * @property {[number, number]} [log] x is a logarithmic scale with these ends
 * @property {[number, number]} [range] of y
 * @property {number[]} [incrs] what lines of the grid may be apart in y
 * @property {number} [level] a line across, from which margins are read
 * @property {Mark[]} [marks]
 */

/**
 * The sign of a curve beside its name.
 * @param {string} ink
 * @param {"solid" | "dashed" | "dotted" | "full"} look full: a square
 */
export function sign(ink, look = "full") {
  const found = h(look === "full" ? "span.tune-ink" : "span.tune-line", {});
  if (look === "full") found.style.background = ink;
  else found.style.borderTop = `${look === "dotted" ? 3 : 2}px ${look} ${ink}`;
  return found;
}

/**
 * One chart; the function that ends it.
 * @param {HTMLElement} host
 * @param {string} title
 * @param {string} unit of x
 * @param {Curve[]} curves
 * @param {Looks} [looks]
 */
export function chart(host, title, unit, curves, { log, range, incrs, level, marks = [] } = {}) {
  const values = h("span.quiet", {});
  const caption = h("figcaption", {}, title, values);
  const labels = curves.map(({ label }) => label).join(", ");
  const place = h(
    "figure.tune-chart",
    { role: "img", ariaLabel: `${title}: ${labels}`, data: { chart: title } },
    caption,
  );
  host.append(place);
  const size = () => ({
    width: Math.max(LOWEST, place.clientWidth),
    height: Math.max(LOWEST, place.clientHeight - caption.offsetHeight),
  });
  const style = getComputedStyle(place);
  const axis = {
    stroke: style.color,
    grid: { stroke: style.borderColor, width: 1 },
    ticks: { stroke: style.borderColor },
  };
  const series = curves.map(({ label, ink, isDots, dash }) => ({
    label,
    stroke: INK[ink] ?? ink,
    width: isDots ? 0 : 1.6,
    dash,
    spanGaps: true,
    points: { show: Boolean(isDots), size: 4, fill: INK[ink] ?? ink },
  }));
  const data = /** @type {any} */ (uPlot).join(curves.map(({ x, y }) => [x, y]));
  const ends = [data[0][0], data[0].at(-1)];
  const whole = (/** @type {any} */ _plot, /** @type {number} */ min, /** @type {number} */ max) =>
    min === ends[0] && max === ends[1] ? log : [min, max]; // else dragged over
  const plot = new uPlot(
    /** @type {any} */ ({
      ...size(),
      cursor: { drag: { x: true, y: false } },
      legend: { show: false },
      scales: { x: { time: false, distr: log ? 3 : 1, range: log && whole }, y: { range } },
      axes: [
        { ...axis, size: 26, values: (/** @type {any} */ _plot, /** @type {any[]} */ ticks) => withUnit(ticks, unit) },
        { ...axis, size: 46, space: SPACE, incrs },
      ],
      series: [{}, ...series],
      hooks: {
        setCursor: [(/** @type {any} */ one) => setText(values, valuesAt(one, unit))],
        drawAxes: [
          (/** @type {any} */ one) => {
            if (level !== undefined) drawLevel(one, level, style.color);
          },
        ],
        draw: [(/** @type {any} */ one) => marks.forEach((mark) => drawMark(one, mark))],
      },
    }),
    data,
    place,
  );
  const sizes = new ResizeObserver(() => plot.setSize(size()));
  sizes.observe(place);
  return () => {
    sizes.disconnect();
    plot.destroy();
    place.remove();
  };
}

/**
 * The marks of an axis, the last one with its unit.
 * @param {(number | null)[]} ticks
 * @param {string} unit
 */
function withUnit(ticks, unit) {
  const last = ticks.map((tick) => tick !== null).lastIndexOf(true);
  return ticks.map((tick, n) => (tick === null ? "" : `${tick}${n === last ? ` ${unit}` : ""}`));
}

/**
 * The values at the pointer, with the names of their curves.
 * @param {any} plot
 * @param {string} unit
 */
function valuesAt({ cursor, data, series }, unit) {
  const { idx } = cursor;
  if (idx === null || idx === undefined) return "";
  const parts = data.slice(1).flatMap((/** @type {any[]} */ values, /** @type {number} */ n) => {
    const value = values[idx];
    return value === null || value === undefined ? [] : [`${series[n + 1].label} ${plain(value, 2)}`];
  });
  return [` ${plain(data[0][idx], 3)} ${unit}`, ...parts].join(" \u00b7 ");
}

/**
 * A line across the chart.
 * @param {any} plot
 * @param {number} level
 * @param {string} ink
 */
function drawLevel({ ctx, bbox, valToPos }, level, ink) {
  const y = valToPos(level, "y", true);
  if (y < bbox.top || y > bbox.top + bbox.height) return;
  ctx.save();
  ctx.strokeStyle = ink;
  ctx.lineWidth = devicePixelRatio;
  ctx.beginPath();
  ctx.moveTo(bbox.left, y);
  ctx.lineTo(bbox.left + bbox.width, y);
  ctx.stroke();
  ctx.restore();
}

/**
 * A margin as an upright line with ends.
 * @param {any} plot
 * @param {Mark} mark
 */
function drawMark(plot, { at, from, to, ink }) {
  const [x, y0, y1] = [plot.valToPos(at, "x", true), plot.valToPos(from, "y", true), plot.valToPos(to, "y", true)];
  const pen = plot.ctx;
  pen.save();
  pen.strokeStyle = INK[ink] ?? ink;
  pen.lineWidth = 2.5 * devicePixelRatio;
  pen.beginPath();
  for (const y of [y0, y1]) {
    pen.moveTo(x - 5 * devicePixelRatio, y);
    pen.lineTo(x + 5 * devicePixelRatio, y);
  }
  pen.moveTo(x, y0);
  pen.lineTo(x, y1);
  pen.stroke();
  pen.restore();
}
