// The table under the screen: values at the cursors and measures between them, trace by trace.
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { numberText } from "../frame/card_value.js";
import { fullLabel } from "./channels.js";
import { deviation, measured } from "./measures.js";

const COLUMNS = ["min", "max", "mean", "rms", "span", "deviation"];

/**
 * Places of two times among samples, the earlier first.
 * @param {[number, number]} times ms
 * @param {number} period s
 * @param {number} begin s of the first sample
 * @returns {[number, number]}
 */
export function samplesAt(times, period, begin) {
  const [a, b] = times.map((time) => Math.round((time / 1000 - begin) / period));
  return a <= b ? [a, b] : [b, a];
}

/**
 * Times of the cursors, their distance and its reciprocal.
 * @param {[number, number]} times ms
 */
export function distanceText([t1, t2]) {
  const distance = t2 - t1;
  const digits = (/** @type {number} */ value) => String(Number(value.toPrecision(6)));
  return t("scope.between", {
    t1: digits(t1),
    t2: digits(t2),
    dt: digits(distance),
    f: distance ? digits(1000 / Math.abs(distance)) : "\u221e",
  });
}

/**
 * What is at a cursor, in words: its time and the value of each trace.
 * @param {import("./channels.js").Channel[]} traces
 * @param {{ period: number, begin: number }} time s between two samples, s of the first one
 * @param {number} at ms
 * @param {Record<string, number | null>} [known] values by place, where the server has computed them
 */
export function cursorText(traces, { period, begin }, at, known) {
  const place = Math.round((at / 1000 - begin) / period);
  const values = traces.map(({ label, unit, format, values: all }, n) => {
    const value = known ? known[n] : all[place];
    const isThere = value !== null && value !== undefined && Number.isFinite(value);
    return `${label} ${isThere ? numberText(value, format) : "\u2013"} ${unit}`.trim();
  });
  return `${Number(at.toPrecision(6))} ms: ${values.join(", ")}`;
}

/**
 * Fill the table; without cursors the measures are those of the whole screen.
 * @param {HTMLTableElement} table
 * @param {import("./channels.js").Channel[]} traces
 * @param {{ period: number, begin: number }} time s between two samples, s of the first one
 * @param {[number, number] | null} times
 * @param {Map<string, ArrayLike<number>>} reference by label
 * @param {import("./long_record.js").Found | null} [known] measures of the traces and values at the cursors, where the
 *   server has computed them
 */
export function showMeasures(table, traces, { period, begin }, times, reference, known = null) {
  const [from, to] = times && period ? samplesAt(times, period, begin) : [0, Infinity];
  const places = times && period ? times.map((time) => Math.round((time / 1000 - begin) / period)) : [];
  const heads = [
    "",
    ...places.map((_each, n) => `t${n + 1}`),
    ...COLUMNS.map((each) => t(/** @type {any} */ (`scope.measure.${each}`))),
  ];
  fill(
    table,
    h("thead", {}, h("tr", {}, ...heads.map((each) => (each ? h("th.number", {}, each) : h("td", {}))))),
    h(
      "tbody",
      {},
      ...traces.map((trace, place) => {
        const text = (/** @type {number | null | undefined} */ value, format = trace.format) =>
          value === null || value === undefined || !Number.isFinite(value) ? "\u2013" : numberText(value, format);
        const found = known ? spanned(known.measures[place]) : measured(trace.values, from, to);
        const at = known ? known.at.map((each) => each[place]) : places.map((n) => trace.values[n]);
        const other = reference.get(trace.label);
        const values = [
          found?.min,
          found?.max,
          found?.mean,
          found?.rms,
          found?.span,
          other && deviation(trace.values, other),
        ];
        return h(
          "tr",
          { data: { trace: trace.label } },
          h(
            "th",
            { attr: { scope: "row" }, title: fullLabel(trace) },
            h("span.scope-key", { style: `--channel: ${trace.color}` }),
            h("span.scope-name", {}, fullLabel(trace)),
          ),
          ...places.map((_each, n) => h("td.number", {}, text(at[n]))),
          ...values.map((value) => h("td.number", {}, text(value, trace.format === "fixed" ? "fixed" : "plain"))),
        );
      }),
    ),
  );
}

/** @param {import("./long_record.js").Measures | undefined} found */
function spanned(found) {
  if (!found) return null;
  const span = found.max === null || found.min === null ? null : found.max - found.min;
  return { ...found, span };
}
