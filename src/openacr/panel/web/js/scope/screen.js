// The screen of the scope: ten by ten divisions, each channel in its own scale.
import { plain } from "../core/format.js";
import { Signal } from "../core/signal.js";
import { t } from "../core/texts.js";
import { uPlot } from "../../vendor/uplot.js";

const COLORS = ["#1f77b4", "#e07b00", "#2ca02c", "#d62758"];
const DIVISIONS = 10;
const HALF = DIVISIONS / 2;
const LEGEND_PX = 34;

/** What is drawn: ends of both scales, times in ms, channels in divisions. */
export const shown = new Signal({ x: [0, DIVISIONS], y: [-HALF, HALF], times: /** @type {number[]} */ ([]), channels: /** @type {(number | null)[][]} */ ([]) });

/**
 * @param {HTMLElement} chart
 * @param {import("../core/signal.js").Endings} endings
 */
export function createScreen(chart, endings) {
  /** @type {{ scale: number, offset: number }[]} */
  let scales = [];
  let sweepMs = 1;
  const style = getComputedStyle(chart);
  const axis = { stroke: style.color, grid: { stroke: style.borderColor, width: 1 }, ticks: { stroke: style.borderColor } };
  const steps = (/** @type {number} */ from, /** @type {number} */ step) => Array.from({ length: DIVISIONS + 1 }, (_each, n) => from + n * step);
  const plot = new uPlot({
    width: Math.max(200, chart.clientWidth), height: 240, cursor: { drag: { x: false, y: false } },
    scales: { x: { time: false, range: () => [0, DIVISIONS * sweepMs] }, y: { range: () => [-HALF, HALF] } },
    axes: [{ ...axis, label: "ms", splits: () => steps(0, sweepMs) }, { ...axis, label: t("scope.divisions"), splits: () => steps(-HALF, 1), size: 44 }],
    series: [{ label: "ms", value: (/** @type {any} */ _plot, /** @type {any} */ value) => (value === null ? "\u2013" : plain(value, 1)) }],
  }, /** @type {any} */ ([[]]), chart);
  const sizes = new ResizeObserver(() => plot.setSize({ width: chart.clientWidth, height: Math.max(120, chart.clientHeight - LEGEND_PX) }));
  sizes.observe(chart);
  endings.add(() => sizes.disconnect(), () => plot.destroy());

  /** @param {number} count */
  function setSeries(count) {
    if (plot.series.length === count + 1) return;
    while (plot.series.length > 1) plot.delSeries(1);
    for (let n = 0; n < count; n++) {
      const value = (/** @type {any} */ _plot, /** @type {any} */ divisions) => (divisions === null ? "\u2013" : plain(divisions * scales[n].scale + scales[n].offset, 4));
      plot.addSeries({ label: String(n + 1), stroke: COLORS[n], width: 1.6, value });
    }
  }

  return {
    /**
     * @param {import("./recording.js").Recording} recording
     * @param {{ scale: number, offset: number }[]} chosen
     * @param {number} sweep ms of a division
     */
    draw(recording, chosen, sweep) {
      [scales, sweepMs] = [chosen, sweep > 0 ? sweep : 1];
      const { channels, period } = recording.window();
      setSeries(channels.length);
      const times = Array.from({ length: channels[0]?.length ?? 0 }, (_each, n) => n * period * 1000);
      const divisions = channels.map((values, n) => values.map((value) => (value === null ? null : (value - scales[n].offset) / scales[n].scale)));
      plot.setData(/** @type {any} */ ([times, ...divisions]));
      const [x, y] = [plot.scales.x, plot.scales.y];
      shown.set({ x: [x.min ?? 0, x.max ?? 0], y: [y.min ?? 0, y.max ?? 0], times, channels: divisions });
    },
  };
}
