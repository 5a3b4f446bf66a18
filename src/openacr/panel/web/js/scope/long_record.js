// A long record: the server keeps its samples, the browser has the columns of what it shows.
import { address, call, get, latest } from "../core/api.js";
import { refuse } from "../core/app.js";
import { columnsOf, curveOf } from "./columns.js";
import { DIVISIONS } from "./scales.js";
import { within, zoomed } from "./view.js";

const MARGIN = 1; // screens on either side that are asked for besides: a pan shows them at once
const MOST = { screen: 8192, computed: 50_000 }; // columns that are asked for
const REST_MS = 250; // from one look at a record that grows to the next

/**
 * @typedef {{ number: number, running: boolean, channels?: string[], period_s?: number, owner?: string | null }} State
 * @typedef {import("./columns.js").Columns} Columns
 * @typedef {{ count: number, min: number | null, max: number | null, mean: number | null, rms: number | null }} Measures
 * @typedef {{ measures: Measures[], at: Record<string, number | null>[] }} Found
 */

export class LongRecord {
  /**
   * @param {() => void} changed
   * @param {import("../core/signal.js").Endings} endings
   */
  constructor(changed, endings) {
    this.changed = changed;
    /** @type {State} */
    this.state = { number: 0, running: false };
    /** The first sample that is kept, and the one after the last. @type {[number, number]} */
    this.ends = [0, 0];
    /** @type {import("./view.js").View} */
    this.view = { from: 0, step: 1000 };
    this.isFollowing = true; // the end of a record that grows stays on the screen
    /** @type {Columns | null} */
    this.shown = null;
    /** @type {Columns | null} */
    this.whole = null;
    /** @type {Found | null} */
    this.found = null;
    this.width = 800; // of the screen, pixels
    this.newest = { shown: latest(endings), whole: latest(endings), found: latest(endings) };
    this.isAsking = false;
    this.isWanted = false; // asked again meanwhile
    /** @type {[number, number] | null} */
    this.cursors = null;
    const timer = setInterval(() => this.state.running && this.isOn && this.ask(), REST_MS);
    endings.add(() => clearInterval(timer));
    this.isOn = false; // it is on the screen
    this.isComputed = false; // every sample is asked for, where the part has few enough
  }

  /** Samples on the screen. */
  get size() {
    return Math.round((DIVISIONS * this.view.step) / this.ms);
  }

  /** Why nothing is computed of what is shown: its samples, and how many may be; null where they may. */
  get why() {
    return this.isEnvelope && this.size > MOST.computed
      ? { count: this.size, most: MOST.computed, seconds: (MOST.computed * this.ms) / 1000 }
      : null;
  }

  /** ms of a sample. */
  get ms() {
    return 1000 * (this.state.period_s ?? 0.001);
  }

  /** Times of both ends, ms. @returns {[number, number]} */
  get times() {
    return [this.ends[0] * this.ms, this.ends[1] * this.ms];
  }

  /** Whether columns of several samples are shown. */
  get isEnvelope() {
    return (this.shown?.width ?? 1) > 1;
  }

  /**
   * The server says what record there is.
   * @param {State} state
   */
  note(state) {
    if (state.number !== this.state.number)
      [this.ends, this.shown, this.whole, this.found] = [[0, 0], null, null, null];
    if (state.number !== this.state.number) this.isFollowing = true;
    this.state = state;
    if (this.isOn) this.ask();
  }

  /**
   * What the screen shows: curves of the channels with ms of their first point and s between two.
   */
  curves() {
    const { shown } = this;
    const channels = shown ? curveOf(shown) : (this.state.channels ?? []).map(() => new Float64Array(0));
    const each = ((shown?.width ?? 1) * this.ms) / (this.isEnvelope ? 2 : 1);
    const start = (shown?.first ?? 0) * this.ms;
    const { from, step } = this.view;
    // What is kept beside the screen is not measured, but for the point before it and the one after.
    const first = Math.max(0, Math.ceil((from - start) / each - 1e-6) - 1);
    const last = Math.floor((from + DIVISIONS * step - start) / each + 1e-6) + 1;
    return {
      channels: channels.map((values) => values.subarray(first, Math.max(first, last + 1))),
      period: each / 1000,
      start: start + first * each,
      ...this.view,
    };
  }

  /**
   * Show a part; the end is followed again where it is in it.
   * @param {import("./view.js").View} view
   */
  show(view) {
    this.view = within(view, this.times);
    this.isFollowing = this.view.from + DIVISIONS * this.view.step >= this.times[1] - this.ms;
    this.changed();
    this.ask();
  }

  /**
   * @param {boolean} isFiner
   * @param {number} at ms
   */
  zoom(isFiner, at) {
    this.show(zoomed(this.view, isFiner, at, this.times, this.ms));
  }

  /** @param {number} by ms */
  pan(by) {
    this.show({ ...this.view, from: this.view.from + by });
  }

  /** The whole record on the screen. */
  all() {
    const [first, last] = this.times;
    this.show({ from: first, step: Math.max(this.ms, (last - first) / DIVISIONS) });
  }

  /** Samples between the cursors, else on the screen. @returns {[number, number]} */
  part() {
    const [from, to] = this.cursors
      ? [Math.min(...this.cursors), Math.max(...this.cursors)]
      : [this.view.from, this.view.from + DIVISIONS * this.view.step];
    const at = (/** @type {number} */ time) => Math.round(time / this.ms);
    return [Math.max(this.ends[0], at(from)), Math.min(this.ends[1], at(to) + (this.cursors ? 1 : 0))];
  }

  /** Ask for what is shown; one question at a time. */
  ask() {
    if (!this.state.number) return;
    this.isWanted = true;
    if (!this.isAsking) void this.answer().catch(refuse);
  }

  async answer() {
    this.isAsking = true;
    try {
      while (this.isWanted) {
        this.isWanted = false;
        await this.look();
      }
    } finally {
      this.isAsking = false;
    }
  }

  async look() {
    const { from, step } = this.view;
    const span = DIVISIONS * step;
    const at = (/** @type {number} */ time) => Math.max(0, Math.round(time / this.ms));
    const isWhole = this.isComputed && this.size <= MOST.computed;
    const margin = isWhole && 3 * this.size > MOST.screen ? 0 : MARGIN;
    const ends = [at(from - margin * span), at(from + (1 + margin) * span) + 1];
    const [shown, found] = await Promise.all([
      this.columns(ends[0], ends[1], 1 + 2 * margin, isWhole),
      this.measures().catch(() => null), // of a part that was dropped meanwhile: asked again below
    ]);
    if (!shown) return;
    const isLonger = shown.ends.join() !== this.ends.join();
    [this.shown, this.ends, this.found] = [shown, shown.ends, found];
    if (this.isFollowing && this.state.running)
      this.view = within({ from: Math.max(this.times[0], this.times[1] - span), step }, this.times);
    this.changed(); // one picture for both answers: it is what costs
    if (!isLonger && this.whole) return;
    this.whole = (await this.columns(...this.ends, 0.5)) ?? this.whole;
    if (!found) this.found = await this.measures();
    this.changed();
  }

  /** Measures of the part and values at the cursors; null where nothing of it is known yet. @returns {Promise<Found | null>} */
  async measures() {
    const [first, last] = this.part();
    const at = (this.cursors ?? []).map((time) => Math.max(0, Math.round(time / this.ms))).join(",");
    return last > first ? get("record/measures", { number: this.state.number, first, last, at }) : null;
  }

  /**
   * @param {number} first
   * @param {number} last
   * @param {number} screens
   * @param {boolean} [isWhole] every sample is wanted
   */
  async columns(first, last, screens, isWhole = false) {
    const { number } = this.state;
    const most = isWhole ? last - first + 1 : Math.max(2, Math.min(MOST.screen, Math.round(screens * this.width)));
    const reply = await call(address("record/view", { number, first, last, most }));
    const found = columnsOf(await reply.arrayBuffer());
    return number === this.state.number ? found : null;
  }

  /**
   * The address of the part as a file.
   * @param {"csv" | "parquet"} kind
   * @param {string[]} names of the columns
   */
  file(kind, names) {
    const [first, last] = this.part();
    return address(`record/${kind}`, { number: this.state.number, first, last, names: JSON.stringify(names) });
  }
}
