// The screen of the scope: ten by ten divisions, each trace in its own scale.
import { plain } from "../core/format.js";
import { Signal } from "../core/signal.js";
import { t } from "../core/texts.js";
import { uPlot } from "../../vendor/uplot.js";

export const COLORS = Object.freeze(["#1f77b4", "#e07b00", "#2ca02c", "#d62758", "#9467bd", "#8c564b", "#c71fb0", "#108a9c"]);
export const DIVISIONS = 10;
const HALF = DIVISIONS / 2;
const LEGEND_PX = 34;
const DASH = [6, 4];

/**
 * @typedef {{ label: string, color: string, values: ArrayLike<number>, scale: number, offset: number, isReference?: boolean }} Trace `scale`: units of a division
 */

/** What is drawn: ends of both scales, times in ms, traces in divisions. */
export const shown = new Signal({ x: [0, DIVISIONS], y: [-HALF, HALF], times: /** @type {number[]} */ ([]), channels: /** @type {(number | null)[][]} */ ([]) });

/**
 * @param {HTMLElement} chart
 * @param {import("../core/signal.js").Endings} endings
 * @param {any[]} [plugins] of uPlot
 */
export function createScreen(chart, endings, plugins = []) {
  /** @type {Trace[]} */
  let drawn = [];
  let sweepMs = 1;
  const style = getComputedStyle(chart);
  const axis = { stroke: () => style.color, grid: { stroke: () => style.borderColor, width: 1 }, ticks: { stroke: () => style.borderColor } };
  const steps = (/** @type {number} */ from, /** @type {number} */ step) => Array.from({ length: DIVISIONS + 1 }, (_each, n) => from + n * step);
  const plot = new uPlot({
    width: Math.max(200, chart.clientWidth), height: 240, cursor: { drag: { x: false, y: false } }, plugins,
    scales: { x: { time: false, range: () => [0, DIVISIONS * sweepMs] }, y: { range: () => [-HALF, HALF] } },
    axes: [{ ...axis, label: "ms", splits: () => steps(0, sweepMs) }, { ...axis, label: t("scope.divisions"), splits: () => steps(-HALF, 1), size: 44 }],
    series: [{ label: "ms", value: (/** @type {any} */ _plot, /** @type {any} */ value) => (value === null ? "\u2013" : plain(value, 1)) }],
  }, /** @type {any} */ ([[]]), chart);
  const sizes = new ResizeObserver(() => chart.clientWidth && plot.setSize({ width: chart.clientWidth, height: Math.max(120, chart.clientHeight - LEGEND_PX) }));
  sizes.observe(chart);
  endings.add(() => sizes.disconnect(), () => plot.destroy());

  /** Have one series for each trace; those there are stay as they are. */
  function setSeries() {
    const kinds = drawn.map(({ label, color, isReference }) => `${label} ${color} ${Boolean(isReference)}`);
    if (kinds.join() === plot.series.slice(1).map((each) => Reflect.get(each, "kind")).join()) return;
    while (plot.series.length > 1) plot.delSeries(1);
    drawn.forEach(({ label, color, isReference }, n) => {
      const value = (/** @type {any} */ _plot, /** @type {any} */ divisions) => (divisions === null || !drawn[n] ? "\u2013" : plain(divisions * drawn[n].scale + drawn[n].offset, 4));
      plot.addSeries(/** @type {any} */ ({ label, stroke: color, width: 1.6, dash: isReference ? DASH : undefined, value, kind: kinds[n] }));
    });
  }

  return {
    canvas: plot.ctx.canvas,
    redraw: () => plot.redraw(false),
    /**
     * @param {Trace[]} traces
     * @param {number} period s
     * @param {number} sweep ms of a division
     */
    draw(traces, period, sweep) {
      [drawn, sweepMs] = [traces, sweep > 0 ? sweep : 1];
      setSeries();
      const length = Math.max(0, ...traces.map(({ values }) => values.length));
      const times = Array.from({ length }, (_each, n) => n * period * 1000);
      const divisions = traces.map(({ values, scale, offset }) => Array.from({ length }, (_each, n) => (Number.isFinite(values[n]) ? (values[n] - offset) / scale : null)));
      plot.setData(/** @type {any} */ ([times, ...divisions]));
      const [x, y] = [plot.scales.x, plot.scales.y];
      shown.set({ x: [x.min ?? 0, x.max ?? 0], y: [y.min ?? 0, y.max ?? 0], times, channels: divisions });
    },
  };
}

/**
 * A scale of 1, 2 or 5 that shows values whole, and the offset that has their middle in the middle; null without values.
 * @param {ArrayLike<number>} values
 */
export function fitting(values) {
  let [low, high] = [Infinity, -Infinity];
  for (let n = 0; n < values.length; n++) {
    if (values[n] < low) low = values[n];
    if (values[n] > high) high = values[n];
  }
  if (low > high) return null;
  const wanted = high > low ? (high - low) / (DIVISIONS - 2) : 1;
  const decade = 10 ** Math.floor(Math.log10(wanted));
  const scale = Number((decade * ([1, 2, 5].find((each) => each * decade >= wanted) ?? 10)).toPrecision(3));
  return { scale, offset: Number((Math.round((low + high) / 2 / scale) * scale).toPrecision(9)) };
}
