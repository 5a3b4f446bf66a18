// The samples of the scope, and which of them are on its screen.

const KEPT = 3; // sweeps: the one that is shown is among them until its last sample has come

/**
 * @typedef {{ running: boolean, trigger?: number | null }} Capture
 * @typedef {{ first: number, period: number, channels: (number | null)[][] }} Window
 */

/** One capture: samples by channel, each at its number, so that a frame that was left out is a gap. */
export class Recording {
  constructor() {
    /** Rings by channel: a sample is at its number modulo their size. @type {Float64Array[]} */
    this.data = [];
    this.size = 1;
    this.samples = 1; // of a sweep
    /** @type {{ before: number, mode: string } | null} */
    this.trigger = null;
    this.isOnce = false;
    this.period = 0;
    this.count = 0;
    this.shown = 0; // first sample on the screen
    this.triggered = false;
  }

  /**
   * @param {number} channels
   * @param {number} samples of one sweep
   * @param {{ before: number, mode: string } | null} trigger
   * @param {boolean} isOnce whether only the first sweep is shown: the record of a move
   */
  begin(channels, samples, trigger, isOnce) {
    this.size = KEPT * samples;
    this.data = Array.from({ length: channels }, () => new Float64Array(this.size).fill(Number.NaN));
    this.samples = samples;
    this.trigger = trigger;
    this.isOnce = isOnce;
    this.period = 0;
    this.count = 0;
    this.shown = 0;
    this.triggered = false;
  }

  /** @param {{ first: number, period: number, channels: Float64Array[] }} piece */
  add(piece) {
    if (piece.channels.length !== this.data.length) return; // of the capture before
    this.period = piece.period;
    for (const ring of this.data) for (let n = this.count; n < Math.min(piece.first, this.count + this.size); n++) ring[n % this.size] = Number.NaN;
    piece.channels.forEach((values, channel) => values.forEach((value, n) => { this.data[channel][(piece.first + n) % this.size] = value; }));
    this.count = Math.max(this.count, piece.first + piece.channels[0].length);
    if (!this.isOnce && !this.triggered && this.trigger?.mode !== "normal" && this.trigger?.mode !== "single") {
      this.shown = Math.floor(Math.max(0, this.count - 1) / this.samples) * this.samples;
    }
  }

  /**
   * A trigger has come: the screen begins the share `before` of a sweep ahead of it.
   * @param {Capture} capture
   */
  note(capture) {
    if (!this.trigger || typeof capture.trigger !== "number") return;
    this.triggered = true;
    this.shown = Math.max(0, capture.trigger - Math.round(this.trigger.before * this.samples));
  }

  /** @returns {Window} */
  window() {
    const length = Math.max(0, Math.min(this.samples, this.count - this.shown));
    const part = (/** @type {Float64Array} */ ring) => Array.from({ length }, (_each, n) => {
      const value = ring[(this.shown + n) % this.size];
      return Number.isNaN(value) ? null : value;
    });
    return { first: this.shown, period: this.period, channels: this.data.map(part) };
  }
}
