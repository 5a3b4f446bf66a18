// The table under the screen: values at the cursors and measures between them, trace by trace.
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { numberText } from "../frame/card_value.js";
import { deviation, measured } from "./measures.js";

const COLUMNS = ["min", "max", "mean", "rms", "span", "deviation"];

/**
 * Sample numbers of two times, the earlier first.
 * @param {[number, number]} times ms
 * @param {number} period s
 * @returns {[number, number]}
 */
export function samplesAt(times, period) {
  const [a, b] = times.map((time) => Math.round(time / (1000 * period)));
  return a <= b ? [a, b] : [b, a];
}

/**
 * Times of the cursors, their distance and its reciprocal.
 * @param {[number, number]} times ms
 */
export function distanceText([t1, t2]) {
  const distance = t2 - t1;
  const digits = (/** @type {number} */ value) => String(Number(value.toPrecision(6)));
  return t("scope.between", { t1: digits(t1), t2: digits(t2), dt: digits(distance), f: distance ? digits(1000 / Math.abs(distance)) : "\u221e" });
}

/**
 * Fill the table; without cursors the measures are those of the whole screen.
 * @param {HTMLTableElement} table
 * @param {import("./channels.js").Channel[]} traces
 * @param {number} period s
 * @param {[number, number] | null} times
 * @param {Map<string, ArrayLike<number>>} reference by label
 */
export function showMeasures(table, traces, period, times, reference) {
  const [from, to] = times && period ? samplesAt(times, period) : [0, Infinity];
  const at = times && period ? times.map((time) => Math.round(time / (1000 * period))) : [];
  const heads = ["", ...at.map((_each, n) => `t${n + 1}`), ...COLUMNS.map((each) => t(/** @type {any} */ (`scope.measure.${each}`)))];
  fill(table, h("thead", {}, h("tr", {}, ...heads.map((each) => (each ? h("th.number", {}, each) : h("td", {}))))), h("tbody", {}, ...traces.map((trace) => {
    const text = (/** @type {number | null | undefined} */ value, format = trace.format) => (value === null || value === undefined || !Number.isFinite(value) ? "\u2013" : numberText(value, format));
    const found = measured(trace.values, from, to);
    const other = reference.get(trace.label);
    const values = [found?.min, found?.max, found?.mean, found?.rms, found?.span, other && deviation(trace.values, other)];
    return h("tr", { data: { trace: trace.label } }, h("th", { attr: { scope: "row" } }, h("span.scope-key", { style: `--channel: ${trace.color}` }), `${trace.label} ${trace.unit}`.trim()),
      ...at.map((n) => h("td.number", {}, text(trace.values[n]))), ...values.map((value) => h("td.number", {}, text(value, trace.format === "fixed" ? "fixed" : "plain"))));
  })));
}
