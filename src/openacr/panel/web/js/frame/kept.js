// Files that the server keeps under names for all browsers: their calls, their questions, and the keys of their lists.
import { address, ApiError, call, get, send } from "../core/api.js";
import { refuse, report } from "../core/app.js";
import { h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { askText, confirm } from "./dialog.js";

const TEXTS = {
  setup: { en: "set-up", de: "Vorlage" },
  reference: { en: "reference", de: "Referenz" },
  tuning: { en: "measurement", de: "Messung" },
  import: { en: "IMPORT \u2026", de: "IMPORTIEREN \u2026" },
  rename: { en: "RENAME", de: "UMBENENNEN" },
  file: { en: "FILE", de: "DATEI" },
  name: { en: "Name", de: "Name" },
  of: { en: "{what} {kind} {name}", de: "{kind} {name}: {what}" },
  delete: { en: "DELETE", de: "L\u00d6SCHEN" },
  sure: {
    en: "Delete the {kind} {name}? It cannot be brought back, in no browser; FILE makes a file of it first.",
    de: "{kind} {name} l\u00f6schen? Dann hat sie kein Browser mehr; DATEI macht vorher eine Datei aus ihr.",
  },
  there: { en: "{name} is there already: replace it?", de: "{name} gibt es schon: ersetzen?" },
  replace: { en: "REPLACE", de: "ERSETZEN" },
  kept: { en: "{kind} {name} is kept", de: "{kind} {name} ist abgelegt" },
};

/**
 * @typedef {"setup" | "reference" | "tuning"} Kind
 * @typedef {{ kind: Kind, name: string, bytes: number, changed: string, axis: string, at: string }} Entry axis and at
 *   of measurements
 */

/** How a kind is called. @param {Kind} kind */
export const nounOf = (kind) => t(TEXTS[kind]);

/** What is kept of these kinds. @param {Kind[]} kinds @returns {Promise<Entry[]>} */
export async function listKept(...kinds) {
  const found = await Promise.all(kinds.map((kind) => get("kept", { kind })));
  return found.flatMap(({ files }) => files);
}

/** What is in a file. @param {Kind} kind @param {string} name @returns {Promise<any>} */
export const readKept = (kind, name) => get("kept/file", { kind, name });

/**
 * Keep a text under a name; where that is taken, after a question.
 * @param {Kind} kind
 * @param {string} name
 * @param {string} body
 * @returns {Promise<boolean>} whether it is kept
 */
async function store(kind, name, body) {
  const headers = { "Content-Type": "application/json" };
  const put = (/** @type {boolean} */ replace) =>
    call(address("kept/file", { kind, name, replace: String(replace) }), { method: "PUT", headers, body });
  try {
    await put(false);
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 409) throw error;
    if (!(await confirm(t(TEXTS.replace), t(TEXTS.there, { name }), t(TEXTS.replace)))) return false;
    await put(true);
  }
  report(t(TEXTS.kept, { kind: nounOf(kind), name }));
  return true;
}

/**
 * Ask for a name and keep something under it.
 * @param {Kind} kind
 * @param {string} title of the question
 * @param {object} found
 * @param {string} [proposed] a name
 * @returns {Promise<string | null>} the name; null: it is not kept
 */
export async function keepAs(kind, title, found, proposed) {
  const name = await askText(title, t(TEXTS.name), proposed);
  return name && (await store(kind, name, JSON.stringify(found))) ? name : null;
}

/** The name that a file of a browser gets here. @param {string} file */
function nameOfFile(file) {
  const name = file.replace(/(\.(setup|reference|tuning))?( ?\(\d+\))?\.json$/i, "");
  return name.replace(/[^\p{L}\p{N}_ .,+-]/gu, "_");
}

/**
 * A key that imports a file, and its field.
 * @param {(text: string) => Kind} kindOf
 * @param {(name: string) => unknown} done
 */
export function importKeys(kindOf, done) {
  const input = h("input", { type: "file", accept: ".json", hidden: true, ariaLabel: t(TEXTS.import) });
  input.onchange = () => void bring().catch(refuse);
  async function bring() {
    const [chosen] = input.files ?? [];
    if (!chosen) return;
    const [name, text] = [nameOfFile(chosen.name), await chosen.text()];
    input.value = "";
    if (await store(kindOf(text), name, text)) await done(name);
  }
  return [keyOf(TEXTS.import, () => input.click()), input];
}

/**
 * The keys of a file in a list: RENAME, FILE (its export) and DELETE.
 * @param {Entry} entry
 * @param {(to?: string) => unknown} changed it has this name now; without one, it is deleted
 */
export function keysOf({ kind, name }, changed) {
  const about = { kind: nounOf(kind), name };
  const saying = (/** @type {import("../core/texts.js").Said} */ what) => ({
    ariaLabel: t(TEXTS.of, { ...about, what: t(what) }),
  });
  async function rename() {
    const to = await askText(t(TEXTS.rename), t(TEXTS.name), name);
    if (!to || to === name) return;
    await send("POST", "kept/rename", { kind, name, to });
    await changed(to);
  }
  async function remove() {
    if (!(await confirm(t(TEXTS.delete), t(TEXTS.sure, about), t(TEXTS.delete), "bad"))) return;
    await call(address("kept/file", { kind, name }), { method: "DELETE" });
    await changed();
  }
  return [
    keyOf(TEXTS.rename, () => void rename().catch(refuse), "", saying(TEXTS.rename)),
    h(
      "a.key",
      { href: address("kept/file", { kind, name }), download: `${name}.${kind}.json`, ...saying(TEXTS.file) },
      t(TEXTS.file),
    ),
    keyOf(TEXTS.delete, () => void remove().catch(refuse), "", saying(TEXTS.delete)),
  ];
}
