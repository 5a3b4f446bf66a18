// Set-ups and references of the scope under names, which the server keeps for all browsers.
import { refuse, report } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";
import { importKeys, keepAs, keysOf, listKept, nounOf, readKept } from "../frame/kept.js";

export const KEPT = { en: "SET-UPS \u2026", de: "VORLAGEN \u2026" };
const TEXTS = {
  text: {
    en: "Set-ups (channels, trigger, scales, maths, lanes) and references that the server keeps for all browsers. A name takes it.",
    de: "Vorlagen (Kan\u00e4le, Trigger, Skalen, Rechnung, Spuren) und Referenzen, die der Server f\u00fcr alle Browser aufhebt. Ein Name nimmt sie.",
  },
  none: { en: "Nothing is kept yet", de: "Noch ist nichts abgelegt" },
  keepsetup: { en: "KEEP SET-UP AS \u2026", de: "VORLAGE ABLEGEN ALS \u2026" },
  keepreference: { en: "KEEP REFERENCE AS \u2026", de: "REFERENZ ABLEGEN ALS \u2026" },
  taken: { en: "{kind} {name} is taken", de: "{kind} {name} ist \u00fcbernommen" },
  empty: { en: "There is no trace to keep: START first", de: "Es gibt keine Kurve zum Ablegen: zuerst START" },
};

/**
 * @typedef {{ setup: () => object, reference: () => import("./reference.js").Kept,
 *   take: { setup: (found: any) => void, reference: (found: import("./reference.js").Kept) => void } }} Shown what the pane has
 */

/** What is sent of a reference. @param {import("./reference.js").Kept} kept */
export function plainOf({ traces, period, start, from }) {
  return {
    traces: traces.map(({ label, id, name, unit, format, color, isFlag, scale, offset, values }) => ({
      ...{ label, id, name, unit, format, color, isFlag, scale, offset },
      values: Array.from(values, (value) => (Number.isFinite(value) ? value : null)),
    })),
    ...{ period, start, from },
  };
}

/** A reference of what was sent. @param {any} found @returns {import("./reference.js").Kept} */
export function referenceOf(found) {
  return {
    ...found,
    traces: found.traces.map((/** @type {any} */ each) => ({
      ...each,
      values: Float64Array.from(each.values, (/** @type {number | null} */ value) => value ?? Number.NaN),
    })),
  };
}

/**
 * List what is kept; a name takes it.
 * @param {Shown} shown
 */
export async function chooseKept(shown) {
  const list = h("div.stack", { role: "list" });

  async function read() {
    const files = await listKept("setup", "reference");
    fill(list, ...(files.length ? files.map(rowOf) : [h("p.hint", {}, t(TEXTS.none))]));
  }

  /** @param {import("../frame/kept.js").Entry} entry */
  function rowOf(entry) {
    const { kind, name } = entry;
    return h(
      "div.row",
      { role: "listitem", data: { kept: `${kind} ${name}` } },
      h("button.key.grow", { type: "button", onclick: () => void take(entry).catch(refuse) }, name),
      h("span.hint", {}, nounOf(kind)),
      ...keysOf(entry, read),
    );
  }

  /** @param {import("../frame/kept.js").Entry} entry */
  async function take({ kind, name }) {
    const found = await readKept(kind, name);
    if (kind === "setup") shown.take.setup(found);
    else shown.take.reference(referenceOf(found));
    list.closest("form")?.requestSubmit();
    report(t(TEXTS.taken, { kind: nounOf(kind), name }));
  }

  async function keepSetup() {
    if (await keepAs("setup", t(TEXTS.keepsetup), shown.setup())) await read();
  }

  async function keepReference() {
    const reference = shown.reference();
    if (!reference.traces.length) throw new Error(t(TEXTS.empty));
    if (await keepAs("reference", t(TEXTS.keepreference), plainOf(reference))) await read();
  }

  await read();
  await ask({
    title: t(KEPT),
    className: "wide",
    body: [
      h("p", {}, t(TEXTS.text)),
      list,
      h(
        "div.row.wrap",
        {},
        keyOf(TEXTS.keepsetup, () => void keepSetup().catch(refuse)),
        keyOf(TEXTS.keepreference, () => void keepReference().catch(refuse)),
        ...importKeys((text) => (/"traces"\s*:/.test(text) ? "reference" : "setup"), read),
      ),
    ],
    choices: [{ text: t("key.close"), value: null, isSubmit: true }],
  });
}
