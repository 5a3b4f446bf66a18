// Names in texts of programs, as the cross reference has them.

/**
 * The name at a place of a line; "" where there is none.
 * @param {string} line
 * @param {number} column
 */
export function nameAt(line, column) {
  for (const found of line.matchAll(/[A-Za-z$#][\w$#]*|\d+/g))
    if (found.index <= column && column <= found.index + found[0].length) return found[0];
  return "";
}
