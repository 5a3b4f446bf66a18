// What the charts of two branches need: which axis a chart has, texts of its values. No element is touched.

const LETTER = 7.5; // pixels
const MARGIN = 18;

/**
 * The width of an axis whose labels are shown whole, in pixels.
 * @param {readonly string[] | null} labels
 */
export function axisSize(labels) {
  return Math.ceil(Math.max(0, ...(labels ?? []).map(({ length }) => length)) * LETTER + MARGIN);
}

/** @param {number | null | undefined} value */
export function valueText(value) {
  return value === null || value === undefined || !Number.isFinite(value)
    ? "\u2013"
    : String(Number(value.toPrecision(9))).replace("-", "\u2212");
}

/**
 * The ends of the scale of a chart: both curves with some room, and never no height.
 * @param {readonly (readonly number[])[]} curves
 * @returns {[number, number]}
 */
export function endsOf(curves) {
  const all = curves.flat().filter(Number.isFinite);
  const [low, high] = [Math.min(...all), Math.max(...all)];
  if (!all.length) return [0, 1];
  const room = high > low ? 0.08 * (high - low) : Math.max(0.5, 0.001 * Math.abs(high));
  return [low - room, high + room];
}
