// What the scope is asked for: time base, trigger, what XY and the spectrum show.
import { model } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { CHANNELS } from "./channels.js";
import { numberField, numberOf, selectField } from "./fields.js";
import { DIVISIONS } from "./scales.js";
import { WINDOWS } from "./spectrum.js";

const TEXTS = { unknown: { en: "{name} has no {value}", de: "{name}: {value} gibt es nicht" } };
const SLOPES = /** @type {Record<string, number>} */ ({ rising: 1, falling: -1, either: 0 });
const MODES = ["free", "roll", "auto", "normal", "single", "record"];

export class Settings {
  /**
   * @param {Record<string, any>} kept
   * @param {() => void} changed
   */
  constructor(kept, changed) {
    const values = kept.settings ?? {};
    const number = (/** @type {string} */ name, /** @type {string} */ value) =>
      numberField(t(/** @type {any} */ (`scope.${name}`)), values[name] ?? value, changed);
    const choice = (
      /** @type {string} */ name,
      /** @type {readonly string[]} */ options,
      /** @type {string} */ value,
      prefix = "scope.",
    ) =>
      selectField(
        t(/** @type {any} */ (`scope.${name}`)),
        options.map((each) => [each, prefix ? t(/** @type {any} */ (`${prefix}${each}`)) : each]),
        values[name] ?? value,
        changed,
      );
    const channels = Array.from({ length: CHANNELS }, (_each, n) => `CH${n + 1}`);
    /** @type {Record<string, HTMLInputElement | HTMLSelectElement>} */
    this.fields = {
      sweep: number("sweep", "100"),
      period: number("period", "0"),
      mode: choice("mode", MODES, "free"),
      slope: choice("slope", Object.keys(SLOPES), "rising"),
      trigger: choice("trigger", channels, "CH1", ""),
      level: number("level", "0"),
      before: number("before", "10"),
      axes: choice("axes", ["divisions", "own", "unit"], "divisions", "scope.axes."),
      flags: choice("flags", ["lanes", "curves"], "lanes", "scope.flags."),
      x: choice("x", [...channels, "M"], "CH1", ""),
      y: choice("y", [...channels, "M"], "CH2", ""),
      aspect: choice("aspect", ["free", "equal"], "free", "scope.aspect."),
      program: number("program", ""),
      window: choice("window", WINDOWS, "hann", "scope.window."),
      amplitude: choice("amplitude", ["unit", "decibel"], "unit", "scope.amplitude."),
    };
  }

  kept() {
    return { settings: Object.fromEntries(Object.entries(this.fields).map(([name, field]) => [name, field.value])) };
  }

  /**
   * Show other values; Error for one that a setting does not have, before anything is changed.
   * @param {Record<string, string>} values
   */
  set(values) {
    const known = Object.entries(this.fields).filter(([name]) => name in values);
    for (const [name, field] of known)
      if (field instanceof HTMLSelectElement && ![...field.options].some(({ value }) => value === values[name]))
        throw new Error(t(TEXTS.unknown, { name: field.ariaLabel ?? name, value: values[name] }));
    for (const [name, field] of known) field.value = values[name];
  }

  element() {
    // The engine of a virtual card records: there are no arrays to name.
    const isHidden = (/** @type {string} */ name) => name === "program" && model.hello.value.machine.is_virtual;
    return h(
      "div.scope-settings",
      {},
      ...Object.entries(this.fields).map(([name, field]) =>
        h("label.row", { hidden: isHidden(name) }, h("span.grow", {}, t(/** @type {any} */ (`scope.${name}`))), field),
      ),
    );
  }

  /** @param {string} name */
  number(name) {
    return numberOf(/** @type {HTMLInputElement} */ (this.fields[name]));
  }

  /** Time of a division, ms. */
  get sweepMs() {
    return this.number("sweep");
  }

  /**
   * The trace that one of the axes of XY shows.
   * @param {import("./channels.js").Channel[]} traces
   * @param {"x" | "y"} axis
   */
  traceOf(traces, axis) {
    return traces.find(({ label }) => label === this.fields[axis].value);
  }

  /** The channel that triggers and its level; null where none does. */
  get trigger() {
    const mode = this.fields.mode.value;
    return ["free", "roll", "record"].includes(mode)
      ? null
      : {
          channel: this.fields.trigger.value,
          level: this.number("level"),
          slope: this.fields.slope.value,
          mode,
          before: this.number("before"),
        };
  }

  /** @param {number} level in the unit of the channel that triggers */
  setLevel(level) {
    this.fields.level.value = String(level);
  }

  get spectrum() {
    return { window: this.fields.window.value, isDecibel: this.fields.amplitude.value === "decibel" };
  }

  /** Whether a long record is made and shown. */
  get isRecord() {
    return this.fields.mode.value === "record";
  }

  /** @returns {import("./recording.js").Run} */
  get run() {
    return this.fields.mode.value === "roll" ? "roll" : "sweep";
  }

  /**
   * Arguments of the command that arms; Error where the channel of the trigger has no source.
   * @param {number[]} places of the channels that are sampled
   */
  asked(places) {
    const chosen = this.trigger;
    const channel = chosen ? places.indexOf(Number(chosen.channel.slice(2)) - 1) : 0;
    if (channel < 0) throw new Error(t("scope.trigger.none", { channel: chosen?.channel ?? "" }));
    const trigger = chosen && { ...chosen, channel, slope: SLOPES[chosen.slope], before: chosen.before / 100 };
    const program = this.fields.program.value.trim() ? this.number("program") : null;
    return { period_ms: this.number("period"), sweep_ms: DIVISIONS * this.sweepMs, trigger, program };
  }
}
