// Where the links of a machine are: transforms of its axes at given positions.

/**
 * What an axis moves, as the server describes it; lengths in mm, angles in degrees.
 * @typedef {object} Link
 * @property {number} axis
 * @property {string} name
 * @property {string} units
 * @property {boolean} is_rotary
 * @property {[number, number, number]} direction of length 1
 * @property {number | null} parent place of the link that carries it, before it in the list
 * @property {[number, number, number]} origin
 * @property {number} per_unit mm or degrees in a unit of the axis
 * @property {number} low
 * @property {number} high
 * @property {boolean} has_ends
 * @property {number} rail
 * @property {[number, number, number]} size
 * @property {[number, number, number]} at
 * @property {string} colour
 * @property {string} file
 * @property {{ input: number, key: string, contact: "open" | "closed", low: number, high: number }[]} switches
 *
 * @typedef {number[]} Matrix 4 x 4, column after column
 */

/** @type {Matrix} */
const GROUND = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/**
 * The frames of links: `fixed` does not follow its own axis (rails and switches), `moving` does (bodies, carried
 * links).
 * @param {Link[]} links
 * @param {number[]} positions in units, in the order of the links
 */
export function frames(links, positions) {
  /** @type {{ fixed: Matrix, moving: Matrix }[]} */
  const found = [];
  links.forEach((link, n) => {
    const carrier = link.parent === null ? GROUND : found[link.parent].moving;
    const fixed = times(carrier, shift(link.origin));
    const value = (positions[n] ?? 0) * link.per_unit;
    const own = link.is_rotary ? turn(link.direction, (value * Math.PI) / 180) : shift(along(link.direction, value));
    found.push({ fixed, moving: times(fixed, own) });
  });
  return found;
}

/**
 * @param {[number, number, number]} direction
 * @param {number} length
 * @returns {[number, number, number]}
 */
export function along(direction, length) {
  return [direction[0] * length, direction[1] * length, direction[2] * length];
}

/**
 * @param {[number, number, number]} by
 * @returns {Matrix}
 */
function shift([x, y, z]) {
  return [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1];
}

/**
 * A rotation about an axis through the origin, by the right hand.
 * @param {[number, number, number]} axis of length 1
 * @param {number} angle radians
 * @returns {Matrix}
 */
function turn([x, y, z], angle) {
  const [s, c] = [Math.sin(angle), Math.cos(angle)];
  const k = 1 - c;
  return [
    c + k * x * x,
    k * x * y + s * z,
    k * x * z - s * y,
    0,
    k * x * y - s * z,
    c + k * y * y,
    k * y * z + s * x,
    0,
    k * x * z + s * y,
    k * y * z - s * x,
    c + k * z * z,
    0,
    0,
    0,
    0,
    1,
  ];
}

/**
 * @param {Matrix} a
 * @param {Matrix} b
 * @returns {Matrix}
 */
function times(a, b) {
  return a.map((_each, n) => {
    const [row, column] = [n % 4, 4 * Math.floor(n / 4)];
    return [0, 1, 2, 3].reduce((sum, k) => sum + a[row + 4 * k] * b[column + k], 0);
  });
}
