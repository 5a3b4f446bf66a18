// The reference of the scope: traces that are drawn dashed beside the present ones.
import { keyOf } from "../core/keys.js";
import { placed } from "./recording.js";

const REFERENCE = { en: "REFER\u00adENCE", de: "REFE\u00adRENZ" };
export const SHORT = { en: "ref", de: "Ref" };

/**
 * @typedef {import("./channels.js").Channel} Channel
 * @typedef {{ traces: Channel[], period: number, start: number, from: number }} Kept s between two samples, ms of the
 *   first one and of the left edge of the screen
 */

export class Reference {
  /**
   * @param {() => void} changed
   * @param {() => Kept} shown what is on the screen
   */
  constructor(changed, shown) {
    this.changed = changed;
    this.shown = shown;
    /** @type {Kept | null} */
    this.kept = null;
    this.key = keyOf(REFERENCE, () => this.toggle());
  }

  /** What is on the screen is kept beside what comes; a reference that is there is dropped. */
  toggle() {
    const { traces, ...times } = this.shown();
    const copied = traces.map((each) => ({ ...each, values: Float64Array.from(each.values) }));
    this.set(this.kept || !traces.length ? null : { ...times, traces: copied });
  }

  /** @param {Kept | null} kept */
  set(kept) {
    this.kept = kept;
    this.key.ariaPressed = String(kept !== null);
    this.changed();
  }

  /**
   * The reference with what was at the left edge of the screen at a time, at the times of the points of the screen.
   * @param {number} begin ms
   * @param {{ start: number, period: number }} times of the points of the screen
   * @param {number} length
   * @param {boolean} [isEnvelope]
   * @returns {Channel[]}
   */
  over(begin, times, length, isEnvelope = false) {
    const { traces = [], period = 1, start = 0, from = 0 } = this.kept ?? {};
    return traces.map((each) => ({
      ...each,
      values: placed(each.values, { start: begin + start - from, period }, times, length, isEnvelope),
    }));
  }
}
