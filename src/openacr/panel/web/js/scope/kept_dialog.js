// Set-ups and references of the scope under names, which the server keeps for all browsers.
import { address, ApiError, call, get, send } from "../core/api.js";
import { refuse, report } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask, askText, confirm } from "../frame/dialog.js";

export const KEPT = { en: "SET-UPS \u2026", de: "VORLAGEN \u2026" };
const TEXTS = {
  text: {
    en: "Set-ups (channels, trigger, scales, maths, lanes) and references that the server keeps for all browsers. A name takes it.",
    de: "Vorlagen (Kan\u00e4le, Trigger, Skalen, Rechnung, Spuren) und Referenzen, die der Server f\u00fcr alle Browser aufhebt. Ein Name nimmt sie.",
  },
  none: { en: "Nothing is kept yet", de: "Noch ist nichts abgelegt" },
  setup: { en: "set-up", de: "Vorlage" },
  reference: { en: "reference", de: "Referenz" },
  keepsetup: { en: "KEEP SET-UP AS \u2026", de: "VORLAGE ABLEGEN ALS \u2026" },
  keepreference: { en: "KEEP REFERENCE AS \u2026", de: "REFERENZ ABLEGEN ALS \u2026" },
  import: { en: "IMPORT \u2026", de: "IMPORTIEREN \u2026" },
  rename: { en: "RENAME", de: "UMBENENNEN" },
  file: { en: "FILE", de: "DATEI" },
  name: { en: "Name", de: "Name" },
  of: { en: "{what} {kind} {name}", de: "{kind} {name}: {what}" },
  delete: { en: "DELETE", de: "L\u00d6SCHEN" },
  sure: {
    en: "Delete the {kind} {name}? No browser has it then.",
    de: "{kind} {name} l\u00f6schen? Dann hat sie kein Browser mehr.",
  },
  there: { en: "{name} is there already: replace it?", de: "{name} gibt es schon: ersetzen?" },
  replace: { en: "REPLACE", de: "ERSETZEN" },
  kept: { en: "{kind} {name} is kept", de: "{kind} {name} ist abgelegt" },
  taken: { en: "{kind} {name} is taken", de: "{kind} {name} ist \u00fcbernommen" },
  empty: { en: "There is no trace to keep: START first", de: "Es gibt keine Kurve zum Ablegen: zuerst START" },
};

/**
 * @typedef {"setup" | "reference"} Kind
 * @typedef {{ kind: Kind, name: string, bytes: number, changed: string }} Entry
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
  const file = h("input", { type: "file", accept: ".json", hidden: true, onchange: () => void attempt(bring) });
  let close = () => {};

  /** @param {() => Promise<unknown>} act */
  async function attempt(act) {
    try {
      await act();
      await read();
    } catch (error) {
      refuse(error);
    }
  }

  async function read() {
    const { files } = await get("scope/files");
    fill(list, ...(files.length ? files.map(rowOf) : [h("p.hint", {}, t(TEXTS.none))]));
  }

  /** @param {Entry} entry */
  function rowOf(entry) {
    const { kind, name } = entry;
    const about = { kind: t(TEXTS[kind]), name };
    const key = (/** @type {import("../core/texts.js").Said} */ what, /** @type {() => Promise<unknown>} */ act) =>
      h(
        "button.key",
        { type: "button", ariaLabel: t(TEXTS.of, { ...about, what: t(what) }), onclick: () => void attempt(act) },
        t(what),
      );
    return h(
      "div.row",
      { role: "listitem", data: { kept: `${kind} ${name}` } },
      h("button.key.grow", { type: "button", onclick: () => void attempt(() => take(entry)) }, name),
      h("span.hint", {}, about.kind),
      key(TEXTS.rename, () => rename(entry)),
      h("a.key", { href: address("scope/file", { kind, name }), download: `${name}.${kind}.json` }, t(TEXTS.file)),
      key(TEXTS.delete, async () => {
        if (await confirm(t(TEXTS.delete), t(TEXTS.sure, about), t(TEXTS.delete)))
          await call(address("scope/file", { kind, name }), { method: "DELETE" });
      }),
    );
  }

  /** @param {Entry} entry */
  async function take({ kind, name }) {
    const found = await get("scope/file", { kind, name });
    if (kind === "setup") shown.take.setup(found);
    else shown.take.reference(referenceOf(found));
    close();
    report(t(TEXTS.taken, { kind: t(TEXTS[kind]), name }));
  }

  /** @param {Entry} entry */
  async function rename({ kind, name }) {
    const to = await askText(t(TEXTS.rename), t(TEXTS.name), name);
    if (to && to !== name) await send("POST", "scope/rename", { kind, name, to });
  }

  /**
   * @param {Kind} kind
   * @param {string} name
   * @param {string} body
   */
  async function store(kind, name, body) {
    const put = (/** @type {boolean} */ replace) =>
      call(address("scope/file", { kind, name, replace: String(replace) }), {
        method: "PUT",
        headers: { "Content-Type": "application/json" },
        body,
      });
    try {
      await put(false);
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 409) throw error;
      if (!(await confirm(t(TEXTS.replace), t(TEXTS.there, { name }), t(TEXTS.replace)))) return;
      await put(true);
    }
    report(t(TEXTS.kept, { kind: t(TEXTS[kind]), name }));
  }

  /** @param {Kind} kind */
  async function keep(kind) {
    const reference = shown.reference();
    if (kind === "reference" && !reference.traces.length) throw new Error(t(TEXTS.empty));
    const found = kind === "setup" ? shown.setup() : plainOf(reference);
    const name = await askText(t(kind === "setup" ? TEXTS.keepsetup : TEXTS.keepreference), t(TEXTS.name));
    if (name) await store(kind, name, JSON.stringify(found));
  }

  async function bring() {
    const [chosen] = file.files ?? [];
    if (!chosen) return;
    const text = await chosen.text();
    file.value = "";
    const kind = /"traces"\s*:/.test(text) ? "reference" : "setup";
    await store(kind, chosen.name.replace(/(\.(setup|reference))?\.json$/i, ""), text);
  }

  const tool = (/** @type {import("../core/texts.js").Said} */ what, /** @type {() => Promise<unknown>} */ act) =>
    h("button.key", { type: "button", onclick: () => void attempt(act) }, t(what));
  await read();
  const answer = ask({
    title: t(KEPT),
    className: "wide",
    body: [
      h("p", {}, t(TEXTS.text)),
      list,
      h(
        "div.row.wrap",
        {},
        tool(TEXTS.keepsetup, () => keep("setup")),
        tool(TEXTS.keepreference, () => keep("reference")),
        h("button.key", { type: "button", onclick: () => file.click() }, t(TEXTS.import)),
        file,
      ),
    ],
    choices: [{ text: t("key.close"), value: null, isSubmit: true }],
  });
  close = () => list.closest("form")?.requestSubmit();
  await answer;
}
