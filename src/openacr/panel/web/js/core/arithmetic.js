// Sums in the number pad: + - * / and parentheses, decimal point or comma.
import { ExpressionError, parse } from "./expression.js";
import { t } from "./texts.js";

/** @type {Record<string, (...args: number[]) => number>} */
const OPERATORS = {
  "+": (a, b) => a + b,
  "-": (a, b) => a - b,
  "*": (a, b) => a * b,
  "/": (a, b) => a / b,
  neg: (a) => -a,
};

/**
 * The value of an expression such as "25.4*3/8"; null if it is none.
 * @param {string} text
 * @returns {number | null}
 */
export function evaluate(text) {
  const plain = text
    .replace(/,/g, ".")
    .replace(/[\u2212\u2013]/g, "-")
    .replace(/\u00d7/g, "*")
    .replace(/\u00f7/g, "/");
  try {
    const value = compute(parse(plain));
    return Number.isFinite(value) ? Number(tidy(value)) : null;
  } catch (error) {
    if (error instanceof ExpressionError) return null;
    throw error;
  }
}

/**
 * @param {import("./expression.js").Node} node
 * @returns {number}
 */
function compute(node) {
  if (node.kind === "number") return node.value;
  return node.kind === "call" ? OPERATORS[node.name](...node.args.map(compute)) : Number.NaN;
}

/**
 * A number without the tail of binary fractions: 0.1+0.2 is 0.3.
 * @param {number} value
 */
export function tidy(value) {
  return String(Number(value.toPrecision(12)));
}

/**
 * The number in a field, null where it is empty; an error that names the field for any other text.
 * @param {HTMLInputElement} field
 * @param {string} label
 */
export function numberIn(field, label) {
  if (!field.value.trim()) return null;
  const value = evaluate(field.value);
  if (value === null) throw new Error(`${label}: ${t("pad.none")}`);
  return value;
}
