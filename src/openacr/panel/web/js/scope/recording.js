// The samples of the scope, and which of them are on its screen.

const KEPT = 3; // sweeps: the one that is shown is among them until its last sample has come
const LEAST = 20000; // samples kept besides: a trigger is known up to a second after its sample

/**
 * @typedef {{ running: boolean, trigger?: number | null }} Capture
 * @typedef {{ first: number, samples: number, period_s: number, channels?: string[], tick?: number | null }} Armed what the server says of a new capture
 * @typedef {{ before: number, mode: string } | null} Trigger
 * @typedef {{ first: number, period: number, channels: Float64Array[] }} Window samples that are missing are NaN
 * @typedef {"sweep" | "roll" | "once"} Run without a trigger: one sweep after the other, the latest, or the first only
 */

/** One capture: samples by channel, each at its number, so that a frame that was left out is a gap. */
export class Recording {
  constructor() {
    /** Rings by channel: a sample is at its number modulo their size. @type {Float64Array[]} */
    this.data = [];
    this.size = 1;
    this.begun = 0; // number of the first sample
    this.samples = 1; // of a sweep
    /** @type {Trigger} */
    this.trigger = null;
    /** @type {Run} */
    this.run = "sweep";
    this.period = 0;
    this.next = 0; // number of the sample that follows
    this.shown = 0; // first sample on the screen
    this.triggered = false;
    /** What is sampled. @type {string[]} */
    this.names = [];
    /** Tick of the card at the first sample, where each one has its tick. @type {number | null} */
    this.tick = null;
  }

  /** Samples so far. */
  get count() {
    return this.next - this.begun;
  }

  /**
   * @param {number} channels
   * @param {Armed} armed
   * @param {Trigger} trigger
   * @param {Run} [run]
   */
  begin(channels, armed, trigger, run = "sweep") {
    this.size = KEPT * armed.samples + LEAST;
    this.data = Array.from({ length: channels }, () => new Float64Array(this.size).fill(Number.NaN));
    this.begun = this.next = this.shown = armed.first;
    this.samples = armed.samples;
    this.period = armed.period_s;
    this.names = armed.channels ?? [];
    this.tick = armed.tick ?? null;
    this.trigger = trigger;
    this.run = run;
    this.triggered = false;
  }

  /** @param {{ first: number, period: number, channels: Float64Array[] }} piece */
  add(piece) {
    if (piece.first < this.begun || piece.channels.length !== this.data.length) return; // of the capture before
    for (const ring of this.data) for (let n = this.next; n < Math.min(piece.first, this.next + this.size); n++) ring[n % this.size] = Number.NaN;
    piece.channels.forEach((values, channel) => values.forEach((value, n) => { this.data[channel][(piece.first + n) % this.size] = value; }));
    this.next = Math.max(this.next, piece.first + piece.channels[0].length);
    if (this.trigger?.mode === "auto" && this.triggered && this.next > this.shown + 2 * this.samples) this.triggered = false;
    if (!this.triggered && (!this.trigger || this.trigger.mode === "auto")) this.shown = this.free();
  }

  /** The first sample on the screen without a trigger. */
  free() {
    const latest = Math.max(0, this.count - 1);
    if (this.run === "once") return this.begun;
    if (this.run === "roll") return Math.max(this.begun, this.next - this.samples);
    return this.begun + Math.floor(latest / this.samples) * this.samples;
  }

  /**
   * A trigger has come: the screen begins the share `before` of a sweep ahead of it.
   * @param {Capture} capture
   */
  note(capture) {
    if (!this.trigger || typeof capture.trigger !== "number" || capture.trigger < this.begun) return;
    this.triggered = true;
    this.shown = Math.max(this.begun, capture.trigger - Math.round(this.trigger.before * this.samples));
  }

  /** @returns {Window} */
  window() {
    const length = Math.max(0, Math.min(this.samples, this.next - this.shown));
    const part = (/** @type {Float64Array} */ ring) => Float64Array.from({ length }, (_each, n) => ring[(this.shown + n) % this.size]);
    return { first: this.shown, period: this.period, channels: this.data.map(part) };
  }
}
