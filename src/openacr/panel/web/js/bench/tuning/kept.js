// Measurements kept under names: listed, shown over the present one in colours of their own, renamed, deleted, exported.
import { address, get, latest, send } from "../../core/api.js";
import { refuse, report } from "../../core/app.js";
import { fill, h } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { t } from "../../core/texts.js";
import { askText, confirm } from "../../frame/dialog.js";
import { sign } from "./plot.js";
import { freeName, inksOf, INKS, ofFile } from "./kept_data.js";

const TEXTS = {
  title: { en: "Kept measurements", de: "Aufbewahrte Messungen" },
  none: { en: "None is kept. KEEP AS … keeps the present one.", de: "Keine. AUFBEWAHREN … bewahrt die jetzige auf." },
  keep: { en: "KEEP AS …", de: "AUFBEWAHREN …" },
  name: { en: "Name of the measurement", de: "Name der Messung" },
  kept: { en: "Kept: {name}", de: "Aufbewahrt: {name}" },
  open: { en: "OPEN FILE", de: "DATEI ÖFFNEN" },
  noFile: { en: "{name} is no kept measurement", de: "{name} ist keine aufbewahrte Messung" },
  show: { en: "Show {name}", de: "{name} zeigen" },
  rename: { en: "RENAME", de: "UMBENENNEN" },
  renameOf: { en: "Rename {name}", de: "{name} umbenennen" },
  remove: { en: "DELETE", de: "LÖSCHEN" },
  removeOf: { en: "Delete {name}", de: "{name} löschen" },
  removeText: {
    en: "The measurement {name} is deleted. It cannot be brought back; EXPORT makes a file of it.",
    de: "Die Messung {name} wird gelöscht. Sie ist dann verloren; EXPORT macht eine Datei aus ihr.",
  },
  export: { en: "EXPORT", de: "EXPORT" },
  exportOf: { en: "Export {name}", de: "{name} exportieren" },
  most: {
    en: "{count} are shown at most: take one away first",
    de: "Höchstens {count} werden gezeigt: erst eine wegnehmen",
  },
};

/** @typedef {{ number: number, name: string, axis: string, at: string, bytes: number }} Entry */

/**
 * @param {HTMLElement} host
 * @param {() => import("./kept_data.js").Tuning | null} present what KEEP AS keeps; null: nothing is measured
 * @param {() => void} changed another choice is shown
 * @param {import("../../core/signal.js").Endings} endings
 */
export function keptMeasurements(host, present, changed, endings) {
  /** @type {Entry[]} */
  let entries = [];
  /** @type {Map<number, string>} */
  let inks = new Map();
  /** @type {Set<number>} */
  const chosen = new Set(); // what is to be shown
  /** @type {Map<number, import("./kept_data.js").Tuning>} */
  const tunings = new Map();
  const newest = latest(endings);
  const keep = keyOf(TEXTS.keep, () => void onKeep(), "", { disabled: true });
  const input = h("input", { type: "file", hidden: true, ariaLabel: t(TEXTS.open), accept: ".json", onchange: onFile });
  const list = h("ul.tune-kept", { ariaLabel: t(TEXTS.title) });
  fill(
    host,
    h(
      "div.row.wrap",
      {},
      h("h3.grow", {}, t(TEXTS.title)),
      keep,
      keyOf(TEXTS.open, () => input.click()),
      input,
    ),
    list,
  );

  async function read() {
    const found = await newest(get("tunings")).catch((error) => void refuse(error));
    if (!found) return;
    entries = found.tunings;
    for (const number of chosen) if (!entries.some((each) => each.number === number)) chosen.delete(number);
    inks = inksOf([...chosen], inks);
    fill(list, ...(entries.length ? entries.map(rowOf) : [h("li.hint", {}, t(TEXTS.none))]));
    changed();
  }

  /** @param {Entry} entry */
  function rowOf({ number, name, axis, at }) {
    const box = h("input", {
      type: "checkbox",
      checked: chosen.has(number),
      ariaLabel: t(TEXTS.show, { name }),
      onchange: () => void show(number, box.checked),
    });
    return h(
      "li",
      { data: { kept: name } },
      h(
        "label.check.grow",
        {},
        box,
        sign(inks.get(number) ?? "transparent"),
        h("span.name", {}, name),
        h("span.quiet", {}, `${axis} \u00b7 ${new Date(at).toLocaleString()}`),
      ),
      keyOf(TEXTS.rename, () => void onRename(number, name), "", { ariaLabel: t(TEXTS.renameOf, { name }) }),
      h(
        "a.key",
        {
          href: address("tunings/file", { number }),
          download: `${name.replace(/[^\w .-]+/g, "_")}.json`,
          ariaLabel: t(TEXTS.exportOf, { name }),
        },
        t(TEXTS.export),
      ),
      keyOf(TEXTS.remove, () => void onRemove(number, name), "", { ariaLabel: t(TEXTS.removeOf, { name }) }),
    );
  }

  /**
   * @param {number} number
   * @param {boolean} isOn
   */
  async function show(number, isOn) {
    if (!isOn) chosen.delete(number);
    else if (chosen.size < INKS.length) chosen.add(number);
    else refuse(t(TEXTS.most, { count: INKS.length }));
    try {
      if (chosen.has(number) && !tunings.has(number))
        tunings.set(number, (await get("tunings/file", { number })).tuning);
    } catch (error) {
      chosen.delete(number);
      refuse(error);
    }
    await read();
  }

  /**
   * @param {string} name
   * @param {import("./kept_data.js").Tuning} tuning
   */
  async function store(name, tuning) {
    const { number } = await send("POST", "tunings", { name, tuning });
    report(t(TEXTS.kept, { name }));
    await show(number, true);
  }

  async function onKeep() {
    const tuning = present();
    if (!tuning) return;
    const name = await askText(
      t(TEXTS.keep),
      t(TEXTS.name),
      freeName(
        `${tuning.axis} 1`,
        entries.map((each) => each.name),
      ),
    );
    if (name) await store(name, tuning).catch(refuse);
  }

  async function onFile() {
    const [file] = input.files ?? [];
    input.value = "";
    const found = file ? ofFile(await file.text()) : null;
    if (!found) return file && refuse(t(TEXTS.noFile, { name: file.name }));
    await store(
      freeName(
        found.name,
        entries.map((each) => each.name),
      ),
      found.tuning,
    ).catch(refuse);
  }

  /**
   * @param {number} number
   * @param {string} name
   */
  async function onRename(number, name) {
    const wanted = await askText(t(TEXTS.renameOf, { name }), t(TEXTS.name), name);
    if (!wanted || wanted === name) return;
    await send("POST", "tunings/rename", { number, name: wanted }).catch(refuse);
    await read();
  }

  /**
   * @param {number} number
   * @param {string} name
   */
  async function onRemove(number, name) {
    if (!(await confirm(t(TEXTS.removeOf, { name }), t(TEXTS.removeText, { name }), t(TEXTS.remove), "bad"))) return;
    await send("DELETE", "tunings", {}, { number }).catch(refuse);
    await read();
  }

  return {
    read,
    /** @param {boolean} can whether there is something to keep */
    mayKeep(can) {
      keep.disabled = !can;
    },
    /** Those that are shown, each with its colour. */
    shown: () =>
      entries.flatMap(({ number, name }) => {
        const [ink, tuning] = [inks.get(number), tunings.get(number)];
        return ink && tuning ? [{ number, name, ink, tuning }] : [];
      }),
  };
}
