// Zoom and pan of a record: the part of it that the screen shows, in ms.
import { DIVISIONS, stepAbove, stepBelow } from "./scales.js";

/**
 * @typedef {{ from: number, step: number }} View the left edge of the screen and the time of a division
 * @typedef {[number, number]} Ends of the record
 */

/**
 * A view within a record; one that is longer begins with it.
 * @param {View} view
 * @param {Ends} ends
 * @returns {View}
 */
export function within({ from, step }, [first, last]) {
  return { from: Math.max(first, Math.min(from, last - DIVISIONS * step)), step };
}

/**
 * The next finer or coarser view; what is at a time stays where it is. No coarser one than the whole record, no finer
 * one than a sample in a division.
 * @param {View} view
 * @param {boolean} isFiner
 * @param {number} at
 * @param {Ends} ends
 * @param {number} period ms
 */
export function zoomed(view, isFiner, at, ends, period) {
  const coarsest = Math.max(view.step, stepAbove(Math.max(period, ends[1] - ends[0]) / DIVISIONS));
  const step = isFiner
    ? Math.max(Math.min(period, view.step), stepBelow(view.step))
    : Math.min(coarsest, stepAbove(view.step * 1.001));
  return within({ from: at - ((at - view.from) * step) / view.step, step }, ends);
}
