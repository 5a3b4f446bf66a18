// Columns of a long record, as the server sends them: the lowest and the highest value of each.

const HEAD = 6; // numbers before the columns

/**
 * @typedef {{ first: number, width: number, low: Float64Array[], high: Float64Array[], ends: [number, number] }} Columns
 *   `first`: number of the first sample, `width`: samples of a column, `ends`: of what is kept
 */

/**
 * The columns of an answer.
 * @param {ArrayBuffer} data
 * @returns {Columns}
 */
export function columnsOf(data) {
  const numbers = new Float64Array(data);
  const [first, width, count, channels, oldest, next] = numbers;
  const block = (/** @type {number} */ n) =>
    Array.from({ length: channels }, (_each, channel) => {
      const begin = HEAD + (n * channels + channel) * count;
      return numbers.subarray(begin, begin + count);
    });
  const low = block(0);
  return { first, width, low, high: width === 1 ? low : block(1), ends: [oldest, next] };
}

/**
 * Columns as a curve: the lowest and the highest value of each, one after the other.
 * @param {Columns} columns
 */
export function curveOf({ width, low, high }) {
  return low.map((values, channel) =>
    width === 1
      ? values
      : Float64Array.from({ length: 2 * values.length }, (_each, n) => (n % 2 ? high[channel] : values)[n >> 1]),
  );
}
