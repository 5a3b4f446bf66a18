// Measurements between two cursors; samples that are missing (NaN) do not count.

/**
 * @typedef {{ count: number, min: number, max: number, mean: number, rms: number, span: number }} Measures `span` is
 *   peak to peak
 */

/**
 * Measures of the samples `from` to `to`, both included; null without samples.
 * @param {ArrayLike<number>} values
 * @param {number} from
 * @param {number} to
 * @returns {Measures | null}
 */
export function measured(values, from, to) {
  let [count, sum, squares, min, max] = [0, 0, 0, Infinity, -Infinity];
  for (let n = Math.max(0, from); n <= Math.min(values.length - 1, to); n++) {
    const value = values[n];
    if (Number.isNaN(value)) continue;
    count++;
    sum += value;
    squares += value * value;
    min = Math.min(min, value);
    max = Math.max(max, value);
  }
  return count ? { count, min, max, mean: sum / count, rms: Math.sqrt(squares / count), span: max - min } : null;
}

/**
 * The largest difference of two records, sample by sample; null where they share none.
 * @param {ArrayLike<number>} values
 * @param {ArrayLike<number>} others
 */
export function deviation(values, others) {
  let most = -1;
  for (let n = 0; n < Math.min(values.length, others.length); n++) {
    const difference = Math.abs(values[n] - others[n]);
    if (difference > most) most = difference;
  }
  return most < 0 ? null : most;
}
