// The channels of the scope as rows of fields: source, colour, scale, offset, unit and format, and the maths channel.
import { get } from "../core/api.js";
import { refuse, report } from "../core/app.js";
import { h } from "../core/dom.js";
import { ownNames } from "../core/own_names.js";
import { ExpressionError } from "../core/expression.js";
import { t } from "../core/texts.js";
import { FORMATS, fullName, isFlag } from "../frame/card_value.js";
import { numberField, numberOf, selectField, textField } from "./fields.js";
import { computed } from "./maths.js";
import { extremes, laidOut, laneOf } from "./scales.js";
import { COLORS } from "./screen.js";

const TEXTS = {
  taken: { en: "{name} is {channel}", de: "{name} ist {channel}" },
  full: {
    en: "All eight channels have a source: empty one for {name}",
    de: "Alle acht Kan\u00e4le haben eine Quelle: einen leeren f\u00fcr {name}",
  },
};
export const CHANNELS = 8;
const MATHS = CHANNELS; // place of the maths channel
const FIRST = ["P12291", "P12290", "P12295"];
const MATHS_COLOR = "#7f7f7f";

/**
 * @typedef {import("./screen.js").Trace & { unit: string, format: string, id: string, name: string,
 *   isFlag: boolean }} Channel `id`: P12290, BIT516, or the expression; `name`: of the
 *   parameter or flag, with its alias before it
 * @typedef {{ source: string, color: string, scale: string, offset: string, unit: string, format: string }} Kept
 * @typedef {Record<"source" | "color" | "scale" | "offset" | "unit", HTMLInputElement> &
 *   { format: HTMLSelectElement }} Fields
 */

export class Channels {
  /**
   * @param {Kept[]} kept
   * @param {() => void} changed
   */
  constructor(kept, changed) {
    /** @type {Fields[]} */
    this.rows = Array.from({ length: CHANNELS + 1 }, (_each, n) =>
      fieldsOf(n, kept[n] ?? { source: FIRST[n] ?? "" }, changed),
    );
    this.changed = changed;
    /** Aliases, and names of the machine, by P12290 and BIT516. @type {Record<string, string>} */
    this.own = {};
    /** Places of the channels of the present capture. @type {number[]} */
    this.asked = [];
    /** What they are, by place. @type {import("../frame/card_value.js").Item[]} */
    this.items = [];
    this.hasLanes = true; // flags are drawn in lanes, whatever their scales
    this.isShared = false; // curves of a unit have the scale of the first one
    this.maths = ""; // the expression that is wrong, whose error has been shown
  }

  /** @returns {Kept[]} */
  kept() {
    return this.rows.map(
      (row) =>
        /** @type {Kept} */ (Object.fromEntries(Object.entries(row).map(([name, field]) => [name, field.value]))),
    );
  }

  /** Show other fields. @param {Partial<Kept>[]} kept */
  set(kept) {
    this.rows.forEach((row, n) => {
      const values = kept[n] ?? {};
      row.source.value = values.source ?? "";
      row.scale.value = values.scale ?? "1";
      row.offset.value = values.offset ?? "0";
      row.unit.value = values.unit ?? "";
      row.color.value = values.color ?? COLORS[n] ?? MATHS_COLOR;
      row.format.value = FORMATS.find((each) => each === values.format) ?? FORMATS[0];
    });
    this.title();
  }

  /** The element of all rows. */
  element() {
    const heads = ["source", "color", "scale", "offset", "unit", "format"].map((each) =>
      h("span.hint", {}, t(/** @type {any} */ (`scope.head.${each}`))),
    );
    return h(
      "div.scope-rows",
      {},
      h("span.hint", {}, ""),
      ...heads,
      ...this.rows.flatMap((row, n) => [
        h("strong", {}, nameOf(n)),
        row.source,
        row.color,
        row.scale,
        row.offset,
        row.unit,
        row.format,
      ]),
    );
  }

  /** Sources to be sampled; the place of each is noted. */
  sources() {
    this.asked = this.rows.flatMap((row, n) => (n !== MATHS && row.source.value.trim() ? [n] : []));
    return this.asked.map((n) => this.rows[n].source.value.trim());
  }

  /**
   * Give parameters and flags a channel each, and say which.
   * @param {string[]} ids
   */
  takeAll(ids) {
    for (const name of ids) {
      const channel = this.take(name);
      if (channel) report(t(TEXTS.taken, { name, channel }));
      else refuse(t(TEXTS.full, { name }));
    }
  }

  /**
   * Give a parameter or flag the first channel without a source; returns its label, "" where there is none. One that has
   * a channel keeps it.
   * @param {string} id
   */
  take(id) {
    const sources = this.rows.slice(0, MATHS).map((row) => row.source.value.trim().toUpperCase());
    const has = sources.indexOf(id.toUpperCase());
    const place = has < 0 ? sources.indexOf("") : has;
    if (place < 0) return "";
    this.rows[place].source.value = id;
    this.title();
    return nameOf(place);
  }

  /**
   * Have these sources, in this order, unless they are what was asked for: a record may be another browser's.
   * @param {string[]} ids
   */
  async have(ids) {
    if (this.asked.map((place) => this.items[place]?.id).join() === ids.join()) return;
    this.rows.slice(0, MATHS).forEach((row, n) => {
      row.source.value = ids[n] ?? "";
    });
    await this.nameUnits();
  }

  /** Aliases come later, and are read anew with every change of a source. */
  async readOwn() {
    const before = this.items.map((item) => item && this.own[item.id]).join();
    this.own = await ownNames();
    if (this.items.map((item) => item && this.own[item.id]).join() !== before) this.changed();
  }

  /** Names and units of the sources. */
  async nameUnits() {
    const names = this.sources();
    const { items } = names.length ? await get("card/named", { names: names.join(";") }) : { items: [] };
    this.items = [];
    this.asked.forEach((place, n) => {
      this.items[place] = items[n];
      this.rows[place].unit.placeholder = items[n]?.unit ?? "";
    });
    void this.readOwn();
  }

  /**
   * The channels with their samples, and the maths channel where it has an expression.
   * @param {Float64Array[]} records in the order of `sources`
   * @param {number} period s
   * @returns {Channel[]}
   */
  traces(records, period) {
    if (records.length !== this.asked.length) return [];
    const found = this.asked.map((place, n) => this.trace(place, records[n]));
    const text = this.rows[MATHS].source.value.trim();
    if (!text || !found.length) return found;
    const missing = new Float64Array(records[0].length).fill(Number.NaN);
    const all = Array.from({ length: CHANNELS }, (_each, n) => records[this.asked.indexOf(n)] ?? missing);
    try {
      found.push(this.trace(MATHS, computed(text, all, period)));
      this.maths = "";
    } catch (error) {
      if (!(error instanceof ExpressionError)) throw error;
      if (this.maths !== text) refuse(error.what ? t("scope.maths.wrong", { what: error.what }) : t("scope.maths.end"));
      this.maths = text;
    }
    return found;
  }

  /**
   * @param {number} place
   * @param {Float64Array} values
   * @returns {Channel}
   */
  trace(place, values) {
    const row = this.rows[place];
    const unit = this.unitOf(place);
    const item = this.items[place];
    const own = item && this.own[item.id];
    const named = item && (own ? `${own} (${fullName(item)})` : fullName(item));
    const [id, name] = item ? [item.id, named] : [row.source.value.trim(), ""];
    return {
      label: nameOf(place),
      id,
      name,
      isFlag: this.isFlag(place),
      color: row.color.value,
      values,
      ...this.scaling(place),
      unit,
      format: row.format.value,
    };
  }

  /** @param {number} place */
  isFlag(place) {
    const item = this.items[place];
    return Boolean(item && isFlag(item));
  }

  /** @param {number} place */
  unitOf(place) {
    const { unit } = this.rows[place];
    return unit.value.trim() || unit.placeholder;
  }

  /**
   * How a channel is drawn: a flag in its lane, a curve in its scale or in that of its unit.
   * @param {number} place
   */
  scaling(place) {
    const flags = this.asked.filter((each) => this.isFlag(each));
    if (this.hasLanes && this.isFlag(place))
      return laneOf(flags.indexOf(place), flags.length, flags.length === this.asked.length);
    const curves = [...this.asked, MATHS].filter((each) => !this.isFlag(each));
    const first = curves.find((each) => this.unitOf(each) === this.unitOf(place)) ?? place;
    const row = this.rows[this.isShared && !this.isFlag(place) ? first : place];
    return { scale: numberOf(row.scale) || 1, offset: numberOf(row.offset) || 0 };
  }

  /**
   * Give each trace the scale and offset that show it whole, flags in lanes of their own.
   * @param {Channel[]} traces
   */
  fit(traces) {
    const together = traces.map((each) => {
      const group = traces.filter((other) => this.isShared && !other.isFlag && other.unit === each.unit);
      return each.isFlag || group.length < 2 ? each : { ...each, values: extremes(group.map(({ values }) => values)) };
    });
    laidOut(together).forEach((fit, n) => {
      const row = this.rows[this.rows.findIndex((_each, place) => nameOf(place) === traces[n].label)];
      if (fit) [row.scale.value, row.offset.value] = [String(fit.scale), String(fit.offset)];
    });
    this.title();
  }

  /**
   * How a channel with a source is drawn; null for one without.
   * @param {string} label
   */
  scaleOf(label) {
    const place = this.rows.findIndex((each, n) => nameOf(n) === label && each.source.value.trim());
    return place < 0 ? null : { ...this.scaling(place), color: this.rows[place].color.value };
  }

  /** Every field says its whole value when the pointer rests on it. */
  title() {
    for (const row of this.rows)
      for (const field of Object.values(row))
        if (field.type === "text") field.title = [field.ariaLabel, field.value].filter(Boolean).join(": ");
  }
}

/**
 * What a trace is called in tables and files: its channel, what it shows, and its unit.
 * @param {Channel} trace
 */
export function fullLabel({ label, id, name, unit }) {
  return `${label} ${id} ${name} ${unit && `[${unit}]`}`.trim().replace(/ +/g, " ");
}

/** @param {number} place */
function nameOf(place) {
  return place === MATHS ? "M" : `CH${place + 1}`;
}

/**
 * @param {number} place
 * @param {Partial<Kept>} kept
 * @param {() => void} changed
 * @returns {Fields}
 */
function fieldsOf(place, kept, changed) {
  const name = nameOf(place);
  const label = (/** @type {string} */ what) => `${name} ${t(/** @type {any} */ (`scope.head.${what}`))}`;
  const source = textField(label("source"), kept.source ?? "", changed);
  source.placeholder = place === MATHS ? "d(CH1) - CH2" : "P12290, BIT516";
  const formats = FORMATS.map(
    (each) => /** @type {[string, string]} */ ([each, t(/** @type {any} */ (`watch.format.${each}`))]),
  );
  return {
    source,
    scale: numberField(label("scale"), kept.scale ?? "1", changed),
    offset: numberField(label("offset"), kept.offset ?? "0", changed),
    color: h("input.field.scope-color", {
      type: "color",
      ariaLabel: label("color"),
      title: label("color"),
      value: kept.color ?? COLORS[place] ?? MATHS_COLOR,
      oninput: changed,
    }),
    unit: textField(label("unit"), kept.unit ?? "", changed),
    format: selectField(label("format"), formats, kept.format ?? FORMATS[0], changed),
  };
}
