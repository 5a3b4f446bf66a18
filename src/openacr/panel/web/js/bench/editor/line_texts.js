// The texts of values beside lines, and from where each comes. Without a document: tested in tests/panel/web.

const MOST = 60; // variables of one question
const LONGEST = 24; // characters of a value in the line

/**
 * @typedef {import("../../edit/line_values.js").Named} Named
 * @typedef {(program: string, name: string) => string | undefined} ValueOf undefined: not known
 */

/**
 * What lines name: parameters and flags by number, variables by program.
 * @param {Named[]} lines
 */
export function parted(lines) {
  /** @type {Set<number>} */
  const numbers = new Set();
  /** @type {Set<number>} */
  const flags = new Set();
  /** @type {Record<string, Set<string>>} */
  const locals = {};
  for (const { program, names } of lines)
    for (const [, name] of names) {
      const found = /^(P|BIT)(\d+)$/.exec(name);
      if (found) (found[1] === "P" ? numbers : flags).add(Number(found[2]));
      else if (program.startsWith("PROG")) (locals[program] ??= new Set()).add(name);
    }
  return {
    numbers: [...numbers],
    flags: [...flags],
    locals: Object.fromEntries(Object.entries(locals).map(([program, names]) => [program, [...names].slice(0, MOST)])),
  };
}

/**
 * A line's values as they are shown, and all of them with the names of the card; null without any.
 * @param {Named} named
 * @param {ValueOf} valueOf
 */
export function saidOf({ program, names }, valueOf) {
  const values = names.map(([written, name]) => ({ written, name, value: valueOf(program, name) ?? "\u2013" }));
  if (!values.length) return null;
  return {
    text: values.map(({ written, value }) => `${written} = ${cut(value)}`).join("   "),
    all: values
      .map(({ written, name, value }) => `${written}${written === name ? "" : ` (${name})`} = ${value}`)
      .join("\n"),
  };
}

/** @param {string} value */
function cut(value) {
  return value.length > LONGEST ? `${value.slice(0, LONGEST - 1)}\u2026` : value;
}
