// What a measurement says in numbers: motor, certainty, gains and margins of loops side by side, what would get worse.
import { h } from "../../core/dom.js";
import { t } from "../../core/texts.js";
import { sign } from "./plot.js";

const TEXTS = {
  margin: { en: "Phase margin, degrees", de: "Phasenreserve, Grad" },
  crossover: { en: "Crossover, Hz", de: "Durchtritt, Hz" },
  gainMargin: { en: "Gain margin, dB", de: "Amplitudenreserve, dB" },
  bandwidth: { en: "Bandwidth, Hz", de: "Bandbreite, Hz" },
  overshoot: { en: "Overshoot of a step, %", de: "Überschwingen eines Sprungs, %" },
  settling: { en: "Settling of a step, ms", de: "Einschwingen eines Sprungs, ms" },
  error: { en: "RMS error of the sweep, pulses", de: "Effektiver Fehler des Sweeps, Pulse" },
  swing: { en: "Load swings after a step, pulses", de: "Last schwingt nach einem Sprung, Pulse" },
  notch: { en: "NOTCH, Hz", de: "NOTCH, Hz" },
  width: { en: "NOTCH width, Hz", de: "NOTCH, Breite, Hz" },
  lopass: { en: "LOPASS, Hz", de: "LOPASS, Hz" },
  swept: { en: "Measured for {time} s", de: "{time} s lang gemessen" },
  facts: {
    en: "Motor: {accel} pulses/s² per V, rate {rate} /s, friction {friction} V, offset {offset} V, delay {delay} servo periods",
    de: "Motor: {accel} Pulse/s² je V, Rate {rate} /s, Reibung {friction} V, Versatz {offset} V, Verzug {delay} Servotakte",
  },
  sure: {
    en: "{error} % of the response is unexplained, coherence {coherence}",
    de: "{error} % der Antwort sind nicht erklärt, Kohärenz {coherence}",
  },
  unsure: {
    en: "Not sure: {error} % of the response is unexplained, coherence {coherence}",
    de: "Nicht sicher: {error} % der Antwort sind nicht erklärt, Kohärenz {coherence}",
  },
  limited: { en: "Faster is barred: {why}", de: "Schneller geht es nicht: {why}" },
  resonance: {
    en: "Resonance: {hz} Hz ± {spread}, antiresonance {anti} Hz, damping {damping}, load {ratio} of the motor",
    de: "Resonanz: {hz} Hz ± {spread}, Antiresonanz {anti} Hz, Dämpfung {damping}, Last das {ratio}-fache des Motors",
  },
  rigid: { en: "Resonance: {why}", de: "Resonanz: {why}" },
  worse: {
    en: "Worse than with the present gains: {name} {after} instead of {before} ({by})",
    de: "Schlechter als mit den jetzigen Werten: {name} {after} statt {before} ({by})",
  },
  excited: { en: "Sweep", de: "Sweep" },
  excitedAs: { en: "{amplitude} pulses, {low} to {high} Hz", de: "{amplitude} Pulse, {low} bis {high} Hz" },
};
export const GAINS = ["PGAIN", "IGAIN", "ILIMIT", "IDELAY", "DGAIN", "DWIDTH", "FFVEL", "FFACC"];
const LONGEST_S = 1.5; // of a sweep without a given time
const FILTERS = /** @type {const} */ ([
  [TEXTS.lopass, "lopass_hz"],
  [TEXTS.notch, "notch_hz"],
  [TEXTS.width, "notch_width_hz"],
]);

/**
 * A column of the table: a loop with its title, and how it was excited.
 * @typedef {{ title: string, ink?: string, loop: any, about?: { amplitude_cnt: number, band_hz: number[] } }} Column
 */

/**
 * The rows of a table of loops: name, and a text for each.
 * @param {Column[]} columns
 * @returns {[string, string[]][]}
 */
export function rowsOf(columns) {
  const loops = columns.map(({ loop }) => loop);
  /** @type {(text: import("../../core/texts.js").Said, cell: (loop: any) => string) => [string, string[]]} */
  const row = (text, cell) => [t(text), loops.map(cell)];
  const gains = GAINS.filter((word) => loops.some((loop) => loop.gains[word]));
  const filters = FILTERS.filter(([, key]) => loops.some((loop) => loop.filters?.[key]));
  const swings = loops.some((loop) => (loop.figures.vibration_cnt ?? null) !== null);
  return [
    ...gains.map((word) => /** @type {[string, string[]]} */ ([word, loops.map((loop) => shown(loop.gains[word]))])),
    ...filters.map(([text, key]) => row(text, (loop) => shown(loop.filters?.[key] ?? null))),
    row(TEXTS.crossover, (loop) => shown(loop.margins.crossover_hz)),
    row(TEXTS.margin, (loop) => shown(loop.margins.phase_deg)),
    row(TEXTS.gainMargin, (loop) => shown(loop.margins.gain_db)),
    row(TEXTS.bandwidth, (loop) => shown(loop.margins.bandwidth_hz)),
    row(TEXTS.overshoot, (loop) => shown(loop.figures.overshoot_percent)),
    row(TEXTS.settling, (loop) => inMs(loop.figures.settling_s)),
    row(TEXTS.error, (loop) => shown(loop.rms_error_cnt)),
    ...(swings ? [row(TEXTS.swing, (loop) => shown(loop.figures.vibration_cnt ?? null))] : []),
    ...(columns.some(({ about }) => about)
      ? [/** @type {[string, string[]]} */ ([t(TEXTS.excited), columns.map(excitedAs)])]
      : []),
  ];
}

/** @param {Column} column */
function excitedAs({ about }) {
  if (!about) return "";
  const [low, high] = about.band_hz;
  return t(TEXTS.excitedAs, { amplitude: shown(about.amplitude_cnt), low: shown(low), high: shown(high) });
}

/**
 * Loops side by side.
 * @param {Column[]} columns
 */
export function tableOf(columns) {
  const title = (/** @type {Column} */ { title: text, ink }) => h("th.number", {}, ink ? sign(ink) : "", text);
  return h(
    "table.grid.tune-table",
    {},
    h("thead", {}, h("tr", {}, h("th", {}), ...columns.map(title))),
    h(
      "tbody",
      {},
      ...rowsOf(columns).map(([name, cells]) =>
        h("tr", {}, h("th", { scope: "row" }, name), ...cells.map((cell) => h("td.number", {}, cell))),
      ),
    ),
  );
}

/**
 * The columns of an answer of `tune.measure`: present, and proposed.
 * @param {any} advice
 * @returns {Column[]}
 */
export function columnsOf(advice) {
  if (!advice) return [];
  const about = { amplitude_cnt: advice.amplitude_cnt, band_hz: advice.band_hz };
  return [
    { title: t("tune.present"), loop: advice.present, about },
    ...(advice.proposed ? [{ title: t("tune.proposed"), loop: advice.proposed, about }] : []),
  ];
}

/**
 * Motor, certainty, what would get worse, and both loops.
 * @param {any} advice
 */
export function factsOf(advice) {
  const { motor } = advice;
  return [
    h(
      "p.tune-motor",
      {},
      t(TEXTS.facts, {
        accel: shown(motor.accel_per_volt),
        rate: shown(motor.rate_per_s),
        friction: shown(motor.coulomb_accel / motor.accel_per_volt),
        offset: shown(motor.offset_v),
        delay: shown(motor.delay_tk),
      }),
    ),
    h("p.tune-resonance", {}, resonance(advice.resonance)),
    h(
      "p",
      { className: advice.is_sure ? "hint" : "notice" },
      t(advice.is_sure ? TEXTS.sure : TEXTS.unsure, {
        error: shown(advice.error_percent),
        coherence: shown(advice.coherence),
      }),
    ),
    ...worseOf(advice).map(([name, said]) => h("p.notice", { data: { worse: name } }, said)),
    advice.time_s < LONGEST_S ? h("p.hint", {}, t(TEXTS.swept, { time: advice.time_s })) : null,
    advice.refusal || advice.limited_by
      ? h("p.hint", {}, advice.refusal || t(TEXTS.limited, { why: advice.limited_by }))
      : null,
    tableOf(columnsOf(advice).map(({ title, loop }) => ({ title, loop }))),
  ];
}

/**
 * What is predicted to become worse with the proposed gains: the name of each figure, and the sentence.
 * @param {any} advice
 * @returns {[string, string][]}
 */
export function worseOf(advice) {
  return Object.entries(advice.worse).map(([name, [before, after]]) => {
    const text = name.endsWith("_s") ? inMs : shown;
    const by = before === null || after === null ? "\u221e" : text(after - before);
    return [
      name,
      t(TEXTS.worse, {
        name: t(/** @type {any} */ (`tune.worse.${name}`)),
        before: text(before),
        after: text(after),
        by: by.startsWith("-") ? by.replace("-", "\u2212") : `+${by}`,
      }),
    ];
  });
}

/** The filters of a loop as they are written in a question. @param {any} loop */
export function filterText({ filters }) {
  if (!filters) return "";
  const notch = filters.notch_hz ? `, NOTCH (${shown(filters.notch_hz)},${shown(filters.notch_width_hz)})` : "";
  return `${filters.lopass_hz ? `, LOPASS ${shown(filters.lopass_hz)}` : ""}${notch}`;
}

/**
 * The resonance that was found, or up to where there is none.
 * @param {any} found
 */
function resonance({
  resonance_hz: hz,
  antiresonance_hz: anti,
  damping_ratio: damping,
  inertia_ratio: ratio,
  deviations,
  reason,
}) {
  if (hz === null) return t(TEXTS.rigid, { why: reason });
  return t(TEXTS.resonance, {
    hz: shown(hz),
    spread: Number(deviations.resonance_hz.toPrecision(1)),
    anti: shown(anti),
    damping: Number(damping.toPrecision(2)),
    ratio: Number(ratio.toPrecision(2)),
  });
}

/** @param {number | null} seconds */
export function inMs(seconds) {
  return shown(seconds === null ? null : 1000 * seconds);
}

/** @param {number | null} value */
export function shown(value) {
  return value === null || value === undefined ? "\u2013" : String(Number(value.toPrecision(4)));
}
