// The screen of the scope: ten by ten divisions, each trace in its own scale.
import { plain } from "../core/format.js";
import { Signal } from "../core/signal.js";
import { t } from "../core/texts.js";
import { onTheme } from "../core/theme.js";
import { uPlot } from "../../vendor/uplot.js";
import { DIVISIONS, gridOf, HALF, labelsOf, valuesOf } from "./scales.js";

export const COLORS = Object.freeze([
  "#1f77b4",
  "#e07b00",
  "#2ca02c",
  "#d62758",
  "#9467bd",
  "#8c564b",
  "#c71fb0",
  "#108a9c",
]);
const LEGEND_PX = 34;
const DASH = [6, 4];
const MOST_AXES = 6; // of values, left and right in turn
const AXIS_PX = 46;
const SECONDS_MS = 1000; // of a division: times are in s from here on
const FAINT = "70"; // opacity of what comes of the next sweep

/**
 * @typedef {{ label: string, color: string, values: ArrayLike<number>, scale: number, offset: number, isFlag?: boolean,
 *   isReference?: boolean, isFaint?: boolean }} Trace `scale`: units of a division
 * @typedef {{ label: string, color: string, scale: number, offset: number }} Axis shows values of curves
 * @typedef {{ start: number, period: number, from: number, step: number, axes?: Axis[] }} Frame ms of the first sample, s between two,
 *   ms of the left edge and of a division
 */

/** What is drawn: ends of both scales, times in ms, traces in divisions, names of the axes of values. */
export const shown = new Signal({
  x: [0, DIVISIONS],
  y: [-HALF, HALF],
  times: /** @type {number[]} */ ([]),
  channels: /** @type {(number | null)[][]} */ ([]),
  axes: /** @type {string[]} */ ([]),
});

/**
 * @param {HTMLElement} chart
 * @param {import("../core/signal.js").Endings} endings
 * @param {any[]} [plugins] of uPlot
 */
export function createScreen(chart, endings, plugins = []) {
  /** @type {Trace[]} */
  let drawn = [];
  let [from, step] = [0, 1];
  /** @type {Axis[]} */
  let axes = [];
  const style = getComputedStyle(chart);
  const stepped = uPlot.paths.stepped?.({ align: 1 });
  const axis = {
    stroke: () => style.color,
    grid: { stroke: () => style.borderColor, width: 1 },
    ticks: { stroke: () => style.borderColor },
  };
  const times = (/** @type {any} */ self, /** @type {number[]} */ splits) =>
    step < SECONDS_MS
      ? labelsOf(splits, step, self.bbox.width / devicePixelRatio / DIVISIONS)
      : labelsOf(
          splits.map((each) => each / 1000),
          step / 1000,
          self.bbox.width / devicePixelRatio / DIVISIONS,
        );
  const room = (/** @type {any} */ self) => self.bbox.height / devicePixelRatio / DIVISIONS;
  const ofValues = Array.from({ length: MOST_AXES }, (_each, n) => ({
    scale: "y",
    side: n % 2 ? 1 : 3,
    stroke: () => axes[n]?.color ?? style.color,
    grid: { show: false },
    ticks: { show: false },
    labelSize: 16,
    labelGap: 0,
    size: () => (axes[n] ? AXIS_PX : 0),
    splits: () => (axes[n] ? gridOf(-HALF, 1) : []),
    values: (/** @type {any} */ self, /** @type {number[]} */ splits) =>
      axes[n] ? valuesOf(axes[n], splits, room(self)) : [],
  }));
  const plot = new uPlot(
    {
      width: Math.max(200, chart.clientWidth),
      height: 240,
      cursor: { drag: { x: false, y: false } },
      plugins: [...plugins, { hooks: { draw: noteDrawn } }],
      scales: { x: { time: false, range: () => [from, from + DIVISIONS * step] }, y: { range: () => [-HALF, HALF] } },
      axes: [
        {
          ...axis,
          label: "ms",
          labelSize: 20,
          size: 34,
          splits: () => gridOf(from, step),
          values: /** @type {any} */ (times),
        },
        {
          ...axis,
          label: t("scope.divisions"),
          labelSize: 20,
          splits: () => gridOf(-HALF, 1),
          values: (/** @type {any} */ self, /** @type {number[]} */ splits) =>
            axes.length ? [] : labelsOf(splits, 1, room(self), 6),
          size: () => (axes.length ? 6 : 34),
        },
        .../** @type {any[]} */ (ofValues),
      ],
      series: [
        {
          label: "ms",
          value: (/** @type {any} */ _plot, /** @type {any} */ value) => (value === null ? "\u2013" : plain(value, 1)),
        },
      ],
    },
    /** @type {any} */ ([[]]),
    chart,
  );
  const sizes = new ResizeObserver(
    () =>
      chart.clientWidth &&
      plot.setSize({
        width: chart.clientWidth,
        height: Math.max(120, chart.clientHeight - (chart.querySelector(".u-legend")?.clientHeight ? LEGEND_PX : 0)),
      }),
  );
  sizes.observe(chart);
  endings.add(
    onTheme(() => plot.redraw(false)),
    () => sizes.disconnect(),
    () => plot.destroy(),
  );

  /** @param {any} self */
  function noteDrawn({ scales: { x, y }, data: [drawnTimes, ...channels] }) {
    shown.set({
      x: [x.min ?? 0, x.max ?? 0],
      y: [y.min ?? 0, y.max ?? 0],
      times: drawnTimes,
      channels,
      axes: axes.map(({ label }) => label),
    });
  }

  /** Name the axes. @param {Axis[]} chosen */
  function setAxes(chosen) {
    axes = chosen.slice(0, MOST_AXES);
    plot.axes[0].label = step < SECONDS_MS ? "ms" : "s";
    plot.axes[1].label = /** @type {any} */ (axes.length ? null : t("scope.divisions"));
    ofValues.forEach((_each, n) => {
      plot.axes[n + 2].label = /** @type {any} */ (axes[n] ? axes[n].label : null);
    });
  }

  /** Have one series for each trace; those there are stay as they are. */
  function setSeries() {
    const kinds = drawn.map(({ label, color, isFlag, isReference, isFaint }) =>
      [label, color, isFlag, isReference, isFaint].join(),
    );
    if (
      kinds.join() ===
      plot.series
        .slice(1)
        .map((each) => Reflect.get(each, "kind"))
        .join()
    )
      return;
    while (plot.series.length > 1) plot.delSeries(1);
    drawn.forEach(({ label, color, isFlag, isReference, isFaint }, n) => {
      const value = (/** @type {any} */ _plot, /** @type {any} */ divisions) =>
        divisions === null || !drawn[n] ? "\u2013" : plain(divisions * drawn[n].scale + drawn[n].offset, 4);
      const line = isFaint ? { stroke: color + FAINT, width: 1, label: "" } : { stroke: color, width: 1.6, label };
      plot.addSeries(
        /** @type {any} */ ({
          ...line,
          ...(isFlag && stepped ? { paths: stepped } : {}),
          dash: isReference ? DASH : undefined,
          value,
          kind: kinds[n],
        }),
      );
    });
  }

  return {
    canvas: plot.ctx.canvas,
    redraw: () => plot.redraw(false),
    /**
     * @param {Trace[]} traces
     * @param {Frame} frame
     */
    draw(traces, frame) {
      [drawn, from, step] = [traces, frame.from, frame.step > 0 ? frame.step : 1];
      setSeries();
      setAxes(frame.axes ?? []);
      const length = Math.max(0, ...traces.map(({ values }) => values.length));
      const samples = Array.from({ length }, (_each, n) => frame.start + n * frame.period * 1000);
      const divisions = traces.map(({ values, scale, offset }) =>
        Array.from({ length }, (_each, n) => (Number.isFinite(values[n]) ? (values[n] - offset) / scale : null)),
      );
      plot.setData(/** @type {any} */ ([samples, ...divisions]));
    },
  };
}
