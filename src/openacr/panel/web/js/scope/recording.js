// The samples of the scope, and which of them are on its screen.

const KEPT = 3; // sweeps: the one that is shown is among them until its last sample has come
const LEAST = 20000; // samples kept besides: a trigger is known up to a second after its sample
const PATIENCE = 2; // sweeps without a trigger after which an automatic one runs freely

/**
 * @typedef {{ running: boolean, first?: number, trigger?: number | null, swept?: number | null,
 *   owner?: string | null }} Capture
 * @typedef {{ number?: number, first: number, samples: number, period_s: number, channels?: string[], tick?: number | null }} Armed what
 *   the server says of a new capture
 * @typedef {{ before: number, mode: string } | null} Trigger
 * @typedef {{ first: number, zero: number, period: number, channels: Float64Array[] }} Window samples that are missing
 *   are NaN; `zero`: number of the sample with time 0
 * @typedef {"sweep" | "roll" | "once"} Run without a trigger: one sweep after the other, the latest, or the first only
 */

/**
 * Values moved to later places; where there are no values they are missing.
 * @param {ArrayLike<number>} values
 * @param {number} by
 * @param {number} length of what is returned
 */
export function moved(values, by, length) {
  return Float64Array.from({ length }, (_each, n) => values[n - by] ?? Number.NaN);
}

/**
 * Values at the times of other ones: the nearest of each, or of each column (two points) the lowest and the highest.
 * @param {ArrayLike<number>} values
 * @param {{ start: number, period: number }} own ms of the first value, s between two
 * @param {{ start: number, period: number }} times
 * @param {number} length of what is returned
 * @param {boolean} [isEnvelope] the points are lowest and highest values of columns
 */
export function placed(values, own, times, length, isEnvelope = false) {
  const at = (/** @type {number} */ n) => (times.start - own.start + n * 1000 * times.period) / (1000 * own.period);
  return Float64Array.from({ length }, (_each, n) => {
    const [first, last] = isEnvelope ? [Math.ceil(at(n & ~1)), Math.ceil(at((n & ~1) + 2)) - 1] : [0, -1];
    if (first >= last) return values[Math.round(at(n))] ?? Number.NaN;
    let found = Number.NaN;
    for (let k = Math.max(0, first); k <= Math.min(last, values.length - 1); k++)
      if (!(n % 2 ? values[k] <= found : values[k] >= found) && !Number.isNaN(values[k])) found = values[k];
    return found;
  });
}

/** One capture: samples by channel, each at its number, so that a frame that was left out is a gap. */
export class Recording {
  constructor() {
    /** Rings by channel: a sample is at its number modulo their size. @type {Float64Array[]} */
    this.data = [];
    this.size = 1;
    this.number = 0; // of the capture, 0 before the first one
    this.begun = 0; // number of the first sample
    this.samples = 1; // of a sweep
    /** @type {Trigger} */
    this.trigger = null;
    /** @type {Run} */
    this.run = "sweep";
    this.period = 0;
    this.next = 0; // number of the sample that follows
    /** The latest whole sweep: it stays while the next one comes. @type {Window | null} */
    this.whole = null;
    /** Triggers of whole sweeps, the latest last; samples of them may still be on their way. @type {number[]} */
    this.swept = [];
    /** The latest trigger. @type {number | null} */
    this.latest = null;
    this.isTaken = false; // another browser samples now
    /** What is sampled. @type {string[]} */
    this.names = [];
    /** Tick of the card at the first sample, where each one has its tick. @type {number | null} */
    this.tick = null;
  }

  /** Samples so far. */
  get count() {
    return this.next - this.begun;
  }

  /** Samples of a sweep before its trigger. */
  get before() {
    return this.trigger ? Math.round(this.trigger.before * this.samples) : 0;
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
    this.number = armed.number ?? 0;
    this.begun = this.next = armed.first;
    this.samples = armed.samples;
    this.period = armed.period_s;
    this.names = armed.channels ?? [];
    this.tick = armed.tick ?? null;
    this.trigger = trigger;
    this.run = run;
    [this.whole, this.swept, this.latest, this.isTaken] = [null, [], null, false];
  }

  /** @param {{ first: number, period: number, channels: Float64Array[] }} piece */
  add(piece) {
    const isOthers = piece.first < this.begun || piece.channels.length !== this.data.length;
    if (this.isTaken || isOthers) return;
    for (const ring of this.data)
      for (let n = this.next; n < Math.min(piece.first, this.next + this.size); n++) ring[n % this.size] = Number.NaN;
    piece.channels.forEach((values, channel) =>
      values.forEach((value, n) => {
        this.data[channel][(piece.first + n) % this.size] = value;
      }),
    );
    this.next = Math.max(this.next, piece.first + piece.channels[0].length);
    this.settle();
  }

  /**
   * The state of the scope has changed: a trigger, a whole sweep, or a capture of another browser.
   * @param {Capture} capture
   */
  note(capture) {
    if (capture.first === undefined || this.isTaken) return;
    this.isTaken = capture.first !== this.begun;
    if (this.isTaken || !this.trigger) return;
    this.latest = capture.trigger ?? null;
    if (typeof capture.swept === "number" && capture.swept !== this.swept.at(-1)) this.swept.push(capture.swept);
    this.settle();
  }

  /**
   * The sample after the sweep of a trigger.
   * @param {number} trigger
   */
  end(trigger) {
    return trigger - this.before + this.samples;
  }

  /** Keep the latest sweep whose samples have all come. */
  settle() {
    while (this.swept.length > 1 && this.end(this.swept[1]) <= this.next) this.swept.shift();
    const [trigger = null] = this.swept;
    const end = trigger === null || this.end(trigger) > this.next ? null : this.end(trigger);
    const isFree =
      !this.trigger || (this.trigger.mode === "auto" && !(end !== null && this.next <= end + PATIENCE * this.samples));
    if (isFree) {
      const begin = end ?? this.begun;
      const first = begin + (Math.floor((this.next - begin) / this.samples) - 1) * this.samples;
      if (first >= begin) this.keep(first, first);
    } else if (trigger !== null && end !== null) this.keep(end - this.samples, trigger);
  }

  /**
   * @param {number} first sample of the sweep
   * @param {number} zero
   */
  keep(first, zero) {
    if (this.whole?.first === first) return;
    this.whole = {
      first,
      zero,
      period: this.period,
      channels: this.data.map((_each, channel) => this.part(channel, first, first + this.samples)),
    };
  }

  /**
   * Samples of a channel by their numbers; those that are not kept are NaN.
   * @param {number} channel
   * @param {number} from
   * @param {number} to the first one that is not wanted
   */
  part(channel, from, to) {
    const [ring, oldest] = [this.data[channel], Math.max(this.begun, this.next - this.size)];
    const whole = this.whole;
    return Float64Array.from({ length: Math.max(0, to - from) }, (_each, n) => {
      const at = from + n;
      if (at >= oldest && at < this.next) return ring[at % this.size];
      return whole?.channels[channel][at - whole.first] ?? Number.NaN;
    });
  }

  /** Numbers of the first sample that is kept and of the one after the last. */
  get kept() {
    return [Math.min(this.whole?.first ?? Infinity, Math.max(this.begun, this.next - this.size)), this.next];
  }

  /**
   * What the screen shows and measures are taken of: the latest whole sweep, before the first one the part that has
   * come.
   * @returns {Window}
   */
  window() {
    if (this.run === "sweep" && this.whole) return this.whole;
    const { first, zero } =
      this.run === "sweep"
        ? this.beginning()
        : { first: this.run === "roll" ? Math.max(this.begun, this.next - this.samples) : this.begun, zero: null };
    const end = Math.min(first + this.samples, this.next);
    return {
      first,
      zero: zero ?? first,
      period: this.period,
      channels: this.data.map((_each, channel) => this.part(channel, first, end)),
    };
  }

  /** Where the sweep begins that is under way, and its time 0; nothing has come of one whose trigger has not. */
  beginning() {
    const { latest } = this;
    if (this.trigger && latest !== null && (latest !== this.swept.at(-1) || this.end(latest) > this.next))
      return { first: latest - this.before, zero: latest };
    if (this.trigger && this.trigger.mode !== "auto") return { first: this.next, zero: this.next + this.before };
    const first = this.whole ? this.whole.first + this.samples : this.begun;
    return { first, zero: first };
  }

  /**
   * What has come of the sweep after the one that is shown; null where that is the only one.
   * @returns {Window | null}
   */
  underWay() {
    if (this.run !== "sweep" || !this.whole) return null;
    const { first, zero } = this.beginning();
    const end = Math.min(first + this.samples, this.next);
    return {
      first,
      zero,
      period: this.period,
      channels: this.data.map((_each, channel) => this.part(channel, first, end)),
    };
  }
}
