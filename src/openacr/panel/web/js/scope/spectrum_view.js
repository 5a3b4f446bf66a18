// Spectra of the traces over the frequency.
import { fill, h } from "../core/dom.js";
import { plain } from "../core/format.js";
import { t } from "../core/texts.js";
import { uPlot } from "../../vendor/uplot.js";
import { fullLabel } from "./channels.js";
import { decibels, peaks, spectrum } from "./spectrum.js";

const LEGEND_PX = 34;
const PEAKS = 6;

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 */
export function createSpectrum(host, endings) {
  /** @type {any} */
  let plot = null;
  let kind = "";
  const size = () => ({ width: Math.max(200, host.clientWidth), height: Math.max(120, host.clientHeight - LEGEND_PX) });
  const sizes = new ResizeObserver(() => host.clientWidth && plot?.setSize(size()));
  sizes.observe(host);
  endings.add(
    () => sizes.disconnect(),
    () => plot?.destroy(),
  );

  /**
   * @param {import("./screen.js").Trace[]} traces
   * @param {boolean} isDecibel
   */
  function create(traces, isDecibel) {
    const wanted = JSON.stringify([isDecibel, traces.map(({ label, color }) => [label, color])]);
    if (wanted === kind) return;
    kind = wanted;
    plot?.destroy();
    const style = getComputedStyle(host);
    const axis = {
      stroke: () => style.color,
      grid: { stroke: () => style.borderColor, width: 1 },
      ticks: { stroke: () => style.borderColor },
    };
    plot = new uPlot(
      {
        ...size(),
        scales: { x: { time: false } },
        axes: [
          { ...axis, label: "Hz" },
          { ...axis, label: isDecibel ? "dB" : t("scope.amplitude"), size: 64 },
        ],
        series: [
          { label: "Hz" },
          ...traces.map(({ label, color }) => ({
            label,
            stroke: color,
            width: 1.4,
            value: (/** @type {any} */ _plot, /** @type {any} */ value) =>
              value === null ? "\u2013" : plain(value, 4),
          })),
        ],
      },
      /** @type {any} */ ([[], ...traces.map(() => [])]),
      host,
    );
  }

  return {
    canvas: () => plot?.ctx.canvas ?? null,
    /**
     * Draw; returns the spectra by trace, null where a trace has a gap.
     * @param {import("./screen.js").Trace[]} traces
     * @param {number} period s
     * @param {{ window: string, isDecibel: boolean }} options
     */
    draw(traces, period, { window, isDecibel }) {
      create(traces, isDecibel);
      const found = traces.map(({ values }) => spectrum(values, period, window));
      const whole = found.find((each) => each !== null);
      const bins = Array.from({ length: whole?.amplitudes.length ?? 0 }, (_each, n) => n * (whole?.step ?? 0));
      const rows = found.map((each) =>
        each ? Array.from(each.amplitudes, isDecibel ? decibels : (value) => value) : bins.map(() => null),
      );
      plot.setData([bins, ...rows]);
      return found;
    },
  };
}

/**
 * The highest peaks of a spectrum, a cell of a table each.
 * @param {ReturnType<typeof spectrum>} found
 * @param {string} unit
 */
function peaksOf(found, unit) {
  if (!found) return [h("td", {}, t("scope.spectrum.gap"))];
  const digits = (/** @type {number} */ value) => String(Number(value.toPrecision(5)));
  return peaks(found.amplitudes, PEAKS).map((n) =>
    h("td.number", {}, `${digits(n * found.step)} Hz: ${digits(found.amplitudes[n])} ${unit}`.trim()),
  );
}

/**
 * Fill the table with the peaks of every trace.
 * @param {HTMLTableElement} table
 * @param {import("./channels.js").Channel[]} traces
 * @param {Parameters<typeof peaksOf>[0][]} found
 */
export function showPeaks(table, traces, found) {
  const rows = traces.map((each, n) =>
    h(
      "tr",
      { data: { trace: each.label } },
      h("th", { attr: { scope: "row" } }, fullLabel(each)),
      ...peaksOf(found[n], each.unit),
    ),
  );
  fill(table, h("tbody", {}, ...rows));
}
