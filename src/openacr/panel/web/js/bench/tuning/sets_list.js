// Which set of gains UNDO, REDO and AS AT THE START lead to. No element is touched.

/**
 * @typedef {{ number: number, before: number, age_s: number, by: "start" | "here" | "elsewhere",
 *   changed: [string, number | string, number | string][] }} Set a set of gains with what it changes of the one that was
 *   in force before it
 * @typedef {{ current: number, sets: Set[], gains: Record<string, number> }} Sets
 */

/**
 * The numbers of those sets; 0 where there is no such set. UNDO leads to what was in force before the present set came,
 * REDO to the latest one that followed it.
 * @param {{ current: number, sets: { number: number, before: number }[] }} found
 */
export function neighbours({ current, sets }) {
  const now = sets.find(({ number }) => number === current);
  const last = (/** @type {(each: { number: number, before: number }) => boolean} */ is) =>
    sets.filter(is).at(-1)?.number ?? 0;
  return {
    undo: now ? last(({ number }) => number === now.before) : 0,
    redo: now ? last(({ before }) => before === current) : 0,
    start: now && now !== sets[0] ? sets[0].number : 0,
  };
}
