// Sums in the number pad: + - * / and parentheses, decimal point or comma.
import { t } from "./texts.js";

const TOKEN = /\s*(?:(\d+(?:\.\d*)?|\.\d+)|([-+*/()]))/y;

/**
 * The value of an expression such as "25.4*3/8"; null if it is none.
 * @param {string} text
 * @returns {number | null}
 */
export function evaluate(text) {
  const tokens = split(text.replace(/,/g, ".").replace(/[\u2212\u2013]/g, "-").replace(/\u00d7/g, "*").replace(/\u00f7/g, "/"));
  if (!tokens || tokens.length === 0) return null;
  let at = 0;
  /** @returns {number} */
  const sum = () => {
    let value = product();
    while (tokens[at] === "+" || tokens[at] === "-") value = tokens[at++] === "+" ? value + product() : value - product();
    return value;
  };
  const product = () => {
    let value = factor();
    while (tokens[at] === "*" || tokens[at] === "/") value = tokens[at++] === "*" ? value * factor() : value / factor();
    return value;
  };
  /** @returns {number} */
  const factor = () => {
    const token = tokens[at++];
    if (token === "-") return -factor();
    if (token === "+") return factor();
    if (token === "(") {
      const value = sum();
      return tokens[at++] === ")" ? value : Number.NaN;
    }
    return token === undefined || token === ")" || token === "*" || token === "/" ? Number.NaN : Number(token);
  };
  const value = sum();
  return at === tokens.length && Number.isFinite(value) ? Number(tidy(value)) : null;
}

/** @param {string} text */
function split(text) {
  const tokens = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < text.trimEnd().length) {
    const found = TOKEN.exec(text);
    if (!found) return null;
    tokens.push(found[1] ?? found[2]);
  }
  return tokens;
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
