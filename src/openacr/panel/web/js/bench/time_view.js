// The part of the history that the timeline shows, in ticks, and what its picture is made of. No element is touched.
import { stepAbove } from "../scope/scales.js";

const FINEST = 20; // ticks that are shown at least
const FACTOR = 1.6; // of a turn of the wheel

/** @typedef {[number, number]} Part first and last tick */

/**
 * A part of a whole: no longer than it, and within it.
 * @param {Part} part
 * @param {Part} whole
 * @returns {Part}
 */
export function within([first, last], whole) {
  const length = Math.min(last - first, whole[1] - whole[0]);
  const begin = Math.max(whole[0], Math.min(first, whole[1] - length));
  return [Math.round(begin), Math.round(begin + length)];
}

/**
 * A finer or coarser part; what is at a tick stays where it is.
 * @param {Part} part
 * @param {boolean} isFiner
 * @param {number} at
 * @param {Part} whole
 */
export function zoomed([first, last], isFiner, at, whole) {
  const wanted = (last - first) * (isFiner ? 1 / FACTOR : FACTOR);
  const length = Math.max(Math.min(FINEST, last - first), wanted);
  // Ends are whole ticks: what only they keep from being the whole is the whole.
  if (!isFiner && wanted + FACTOR >= whole[1] - whole[0]) return whole;
  const share = last > first ? (at - first) / (last - first) : 0;
  return within([at - share * length, at + (1 - share) * length], whole);
}

/**
 * Where a tick is in a part, percent.
 * @param {number} tick
 * @param {Part} part
 */
export function placeOf(tick, [first, last]) {
  return last > first ? (100 * (tick - first)) / (last - first) : 0;
}

/**
 * Times for the ruler, s: multiples of 1, 2 or 5.
 * @param {Part} part
 * @param {number} period s of a tick
 * @param {number} most
 */
export function rulerOf([first, last], period, most) {
  if (last <= first) return [];
  const step = stepAbove(((last - first) * period) / most);
  const begin = Math.ceil((first * period) / step - 1e-9);
  const count = Math.floor((last * period) / step + 1e-9) - begin + 1;
  return Array.from({ length: Math.max(0, count) }, (_each, n) => Number(((begin + n) * step).toPrecision(12)));
}

/**
 * A typed time in seconds: "885.8", "885,8", "14:45.8", "1:00:00"; null for any other text.
 * @param {string} text
 */
export function secondsOf(text) {
  const found = /^(?:(?:(\d+):)?(\d+):)?(\d+(?:[.,]\d*)?)$/.exec(text.trim());
  if (!found) return null;
  const [, hours = "0", minutes = "0", seconds] = found;
  return 3600 * Number(hours) + 60 * Number(minutes) + Number(seconds.replace(",", "."));
}

/**
 * The next of some ticks after a tick, or the previous one before it; undefined where there is none.
 * @param {number[]} ticks in their order
 * @param {number} tick
 * @param {boolean} back
 */
export function neighbour(ticks, tick, back) {
  return back ? ticks.filter((each) => each < tick).at(-1) : ticks.find((each) => each > tick);
}

/**
 * What a key does with the shown part, as in Perfetto: W and S zoom, A and D move along; null for any other key.
 * @param {string} key
 * @param {Part} part
 * @param {number} at tick that stays where it is
 * @param {Part} whole
 */
export function keyed(key, part, at, whole) {
  const by = 0.2 * (part[1] - part[0]);
  const keys = {
    w: () => zoomed(part, true, at, whole),
    s: () => zoomed(part, false, at, whole),
    a: () => within([part[0] - by, part[1] - by], whole),
    d: () => within([part[0] + by, part[1] + by], whole),
  };
  return /** @type {Record<string, () => Part>} */ (keys)[key.toLowerCase()]?.() ?? null;
}
