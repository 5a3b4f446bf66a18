// Measurements kept under names: listed, and shown over the present one in colours of their own.
import { latest } from "../../core/api.js";
import { refuse } from "../../core/app.js";
import { fill, h } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { t } from "../../core/texts.js";
import { importKeys, keepAs, keysOf, listKept, readKept } from "../../frame/kept.js";
import { sign } from "./plot.js";
import { freeName, inksOf, INKS } from "./kept_data.js";

const TEXTS = {
  title: { en: "Kept measurements", de: "Abgelegte Messungen" },
  none: { en: "None is kept. KEEP AS … keeps the present one.", de: "Keine. ABLEGEN ALS … legt die jetzige ab." },
  keep: { en: "KEEP AS …", de: "ABLEGEN ALS …" },
  show: { en: "Show {name}", de: "{name} zeigen" },
  most: {
    en: "{count} are shown at most: take one away first",
    de: "Höchstens {count} werden gezeigt: erst eine wegnehmen",
  },
};

/**
 * @param {HTMLElement} host
 * @param {() => import("./kept_data.js").Tuning | null} present what KEEP AS keeps; null: nothing is measured
 * @param {() => void} changed another choice is shown
 * @param {import("../../core/signal.js").Endings} endings
 */
export function keptMeasurements(host, present, changed, endings) {
  /** @type {import("../../frame/kept.js").Entry[]} */
  let entries = [];
  /** @type {Map<string, string>} */
  let inks = new Map();
  /** @type {Set<string>} */
  const chosen = new Set(); // what is to be shown
  /** What was read, and of which change. @type {Map<string, { stamp: string, tuning: import("./kept_data.js").Tuning }>} */
  const tunings = new Map();
  const newest = latest(endings);
  const keep = keyOf(TEXTS.keep, () => void onKeep().catch(refuse), "", { disabled: true });
  const list = h("ul.tune-kept", { ariaLabel: t(TEXTS.title) });
  const shownAtOnce = (/** @type {string} */ name) => show(name, true);
  fill(
    host,
    h("div.row.wrap", {}, h("h3.grow", {}, t(TEXTS.title)), keep, ...importKeys(() => "tuning", shownAtOnce)),
    list,
  );

  /** The list, once what is to be shown of it was read. */
  async function load() {
    const found = await listKept("tuning");
    for (const { name, changed: stamp } of found) {
      if (!chosen.has(name) || tunings.get(name)?.stamp === stamp) continue;
      try {
        tunings.set(name, { stamp, tuning: await readKept("tuning", name) });
      } catch (error) {
        chosen.delete(name);
        refuse(error);
      }
    }
    return found;
  }

  async function read() {
    const found = await newest(load()).catch((error) => void refuse(error));
    if (!found) return;
    entries = found;
    for (const name of chosen) if (!entries.some((each) => each.name === name)) chosen.delete(name);
    inks = inksOf([...chosen], inks);
    fill(list, ...(entries.length ? entries.map(rowOf) : [h("li.hint", {}, t(TEXTS.none))]));
    changed();
  }

  /** @param {import("../../frame/kept.js").Entry} entry */
  function rowOf(entry) {
    const { name, axis, at } = entry;
    const box = h("input", {
      type: "checkbox",
      checked: chosen.has(name),
      ariaLabel: t(TEXTS.show, { name }),
      onchange: () => void show(name, box.checked),
    });
    return h(
      "li",
      { data: { kept: name } },
      h(
        "label.check.grow",
        {},
        box,
        sign(inks.get(name) ?? "transparent"),
        h("span.name", {}, name),
        h("span.quiet", {}, `${axis} \u00b7 ${new Date(at).toLocaleString()}`),
      ),
      h("div.row", {}, ...keysOf(entry, (to) => (to && chosen.has(name) ? renamed(name, to) : read()))),
    );
  }

  /**
   * @param {string} name
   * @param {boolean} isOn
   */
  async function show(name, isOn) {
    if (!isOn) chosen.delete(name);
    else if (chosen.has(name) || chosen.size < INKS.length) chosen.add(name);
    else refuse(t(TEXTS.most, { count: INKS.length }));
    await read();
  }

  /**
   * What is shown keeps its colour under another name.
   * @param {string} name
   * @param {string} to
   */
  function renamed(name, to) {
    const ink = inks.get(name);
    if (ink) inks.set(to, ink);
    return chosen.delete(name) && show(to, true);
  }

  async function onKeep() {
    const tuning = present();
    if (!tuning) return;
    const taken = entries.map((each) => each.name);
    const name = await keepAs("tuning", t(TEXTS.keep), tuning, freeName(tuning.axis, taken));
    if (name) await show(name, true);
  }

  return {
    read,
    /** @param {boolean} can whether there is something to keep */
    mayKeep(can) {
      keep.disabled = !can;
    },
    /** Those that are shown, each with its colour. */
    shown: () =>
      entries.flatMap(({ name }) => {
        const [ink, kept] = [inks.get(name), tunings.get(name)];
        return ink && kept ? [{ name, ink, tuning: kept.tuning }] : [];
      }),
  };
}
