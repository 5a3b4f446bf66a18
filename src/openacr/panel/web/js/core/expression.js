// Expressions as trees: + - * /, parentheses, names and functions. Nothing of a text is ever executed.

const TOKEN = /\s*(?:(\d+(?:\.\d*)?|\.\d+)|([A-Za-z]\w*)|([-+*/(),]))/y;

/**
 * @typedef {{ kind: "number", value: number } | { kind: "name", name: string } | { kind: "call", name: string,
 *   args: Node[] }} Node
 * @typedef {{ names?: readonly string[], functions?: Readonly<Record<string, number>> }} Known functions with the count
 *   of their arguments
 */

/** A text that is no expression; `what` is the word at which that is seen, empty at the end. */
export class ExpressionError extends Error {
  /** @param {string} what */
  constructor(what) {
    super(what);
    this.what = what;
  }
}

/**
 * The tree of an expression: operators are calls of "+", "-", "*", "/" and "neg".
 * @param {string} text
 * @param {Known} [known]
 * @returns {Node}
 */
export function parse(text, { names = [], functions = {} } = {}) {
  const tokens = split(text);
  let at = 0;
  const need = (/** @type {string} */ token) => {
    if (tokens[at] !== token) throw new ExpressionError(tokens[at] ?? "");
    at++;
  };
  /**
   * @param {string[]} operators
   * @param {() => Node} part
   * @returns {Node}
   */
  const chain = (operators, part) => {
    let node = part();
    while (operators.includes(tokens[at])) node = { kind: "call", name: tokens[at++], args: [node, part()] };
    return node;
  };
  /** @returns {Node} */
  const sum = () => chain(["+", "-"], () => chain(["*", "/"], factor));
  /** @returns {Node} */
  const factor = () => {
    const token = tokens[at++] ?? "";
    if (token === "-") return { kind: "call", name: "neg", args: [factor()] };
    if (token === "+") return factor();
    if (token === "(") {
      const node = sum();
      need(")");
      return node;
    }
    if (/^[\d.]/.test(token)) return { kind: "number", value: Number(token) };
    const name = token.toLowerCase();
    if (names.includes(name)) return { kind: "name", name };
    if (Object.hasOwn(functions, name)) return { kind: "call", name, args: argumentsOf(functions[name]) };
    throw new ExpressionError(token);
  };
  /** @param {number} count */
  const argumentsOf = (count) => {
    const args = [];
    for (let n = 0; n < count; n++) {
      need(n ? "," : "(");
      args.push(sum());
    }
    need(")");
    return args;
  };
  const node = sum();
  if (at < tokens.length) throw new ExpressionError(tokens[at]);
  return node;
}

/** @param {string} text */
function split(text) {
  const tokens = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < text.trimEnd().length) {
    const begin = TOKEN.lastIndex;
    const found = TOKEN.exec(text);
    if (!found) throw new ExpressionError(text.slice(begin).trim().charAt(0));
    tokens.push(found[1] ?? found[2] ?? found[3]);
  }
  return tokens;
}
