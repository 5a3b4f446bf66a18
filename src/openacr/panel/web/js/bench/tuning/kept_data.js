// Kept measurements as data: what is kept of one, the curves and colours of those that are shown. No element is touched.

/**
 * @typedef {{ time_s: number[], setpoint_cnt: number[], actual_cnt: number[] }} Curve
 * @typedef {{ magnitude_db: number[], phase_deg: number[], frequency_hz?: number[], coherence?: number[] }} Response
 * @typedef {{ gains: Record<string, number>, filters: Record<string, number> | null, margins: Record<string, any>,
 *   figures: Record<string, number | null>, rms_error_cnt: number | null, step: Curve }} Loop
 * @typedef {{ figures: Record<string, number | null>, measured: Curve }} Trial
 * @typedef {{ axis: string, at: string, time_s: number, amplitude_cnt: number, band_hz: number[], present: Loop,
 *   bode: { frequency_hz: number[], present: Response, measured: Response }, trial: Trial | null }} Tuning
 */

/** Colours of kept measurements, each apart from those of the present one. */
export const INKS = ["#8e5bd0", "#00a0a8", "#b0772a", "#d6489a", "#6b8e00", "#5a7bd8"];

/**
 * What is kept of an answer of `tune.measure`: the loop as it was measured. A step that the axis has made counts where
 * it was made with the same set of gains.
 * @param {any} found
 * @param {{ axis: string, at: string, set: number, trial: (Trial & { set: number }) | null }} about
 * @returns {Tuning}
 */
export function keptOf(found, { axis, at, set, trial }) {
  const { gains, filters, margins, figures, rms_error_cnt, step } = found.present;
  const { frequency_hz, present, measured } = found.bode;
  const { time_s, amplitude_cnt, band_hz } = found;
  const curve = (/** @type {Curve} */ each) => ({
    time_s: each.time_s,
    setpoint_cnt: each.setpoint_cnt,
    actual_cnt: each.actual_cnt,
  });
  return {
    axis,
    at,
    time_s,
    amplitude_cnt,
    band_hz,
    present: { gains, filters, margins, figures, rms_error_cnt, step: curve(step) },
    bode: { frequency_hz, present, measured },
    trial: trial?.set === set ? { figures: trial.figures, measured: curve(trial.measured) } : null,
  };
}

/**
 * The colours of what is shown: one keeps its own as long as it is, another gets the first that is free.
 * @param {readonly string[]} shown names of kept measurements
 * @param {Map<string, string>} before
 * @returns {Map<string, string>} without those for which no colour is left
 */
export function inksOf(shown, before) {
  const found = new Map([...before].filter(([name]) => shown.includes(name)));
  for (const name of shown) {
    const free = INKS.find((ink) => ![...found.values()].includes(ink));
    if (!found.has(name) && free) found.set(name, free);
  }
  return found;
}

/**
 * A name for a measurement of an axis that is not taken: the axis with a number.
 * @param {string} axis
 * @param {readonly string[]} taken
 */
export function freeName(axis, taken) {
  let n = 1;
  while (taken.includes(`${axis} ${n}`)) n++;
  return `${axis} ${n}`;
}
