// The maths channel: an expression of the channels, computed sample by sample; d() and i() are over time in seconds.
import { parse } from "../core/expression.js";

/** @type {Record<string, (...values: number[]) => number>} */
const OF_SAMPLES = {
  "+": (a, b) => a + b,
  "-": (a, b) => a - b,
  "*": (a, b) => a * b,
  "/": (a, b) => a / b,
  neg: (a) => -a,
  abs: Math.abs,
  sqrt: Math.sqrt,
  sin: Math.sin,
  cos: Math.cos,
  tan: Math.tan,
  atan: Math.atan,
  exp: Math.exp,
  log: Math.log,
  log10: Math.log10,
  min: Math.min,
  max: Math.max,
};

/** @type {Record<string, (values: Float64Array, period: number) => Float64Array>} */
const OF_RECORDS = { d: derivative, i: integral };

/** Functions with the count of their arguments. */
const FUNCTIONS = Object.freeze({
  d: 1,
  i: 1,
  abs: 1,
  sqrt: 1,
  sin: 1,
  cos: 1,
  tan: 1,
  atan: 1,
  exp: 1,
  log: 1,
  log10: 1,
  min: 2,
  max: 2,
});

/**
 * The samples of an expression such as "d(CH1) - CH2 / 2"; ExpressionError for any other text.
 * @param {string} text
 * @param {ArrayLike<number>[]} channels NaN where a sample is missing
 * @param {number} period s
 */
export function computed(text, channels, period) {
  const names = ["pi", ...channels.map((_each, n) => `ch${n + 1}`)];
  const length = channels[0]?.length ?? 0;
  return valuesOf(parse(text, { names, functions: FUNCTIONS }));

  /**
   * @param {import("../core/expression.js").Node} node
   * @returns {Float64Array}
   */
  function valuesOf(node) {
    if (node.kind === "number") return new Float64Array(length).fill(node.value);
    if (node.kind === "name")
      return node.name === "pi"
        ? new Float64Array(length).fill(Math.PI)
        : Float64Array.from(channels[Number(node.name.slice(2)) - 1]);
    const args = node.args.map(valuesOf);
    if (node.name in OF_RECORDS) return OF_RECORDS[node.name](args[0], period);
    return args[0].map((_value, n) => OF_SAMPLES[node.name](...args.map((each) => each[n])));
  }
}

/**
 * Rates per second: central differences, one-sided at both ends.
 * @param {Float64Array} values
 * @param {number} period s
 */
export function derivative(values, period) {
  const last = values.length - 1;
  return values.map((_value, n) => {
    const [from, to] = [Math.max(0, n - 1), Math.min(last, n + 1)];
    return (values[to] - values[from]) / ((to - from) * period);
  });
}

/**
 * The integral over time from the first sample on, by trapezoids.
 * @param {Float64Array} values
 * @param {number} period s
 */
export function integral(values, period) {
  let sum = 0;
  return values.map((value, n) => {
    if (n) sum += ((values[n - 1] + value) / 2) * period;
    return sum;
  });
}
