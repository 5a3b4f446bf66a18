// The set-up of the card beside that of the project: what differs, setting by setting, and whether anything does.
import { get, latest, send } from "../core/api.js";
import { refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { Signal } from "../core/signal.js";
import { t } from "../core/texts.js";

const TEXTS = {
  title: {
    en: "Set-up: memory, attachments, aliases, settings",
    de: "Einrichtung: Speicher, Zuordnungen, Aliasse, Einstellungen",
  },
  setting: { en: "Setting", de: "Einstellung" },
  line: { en: "Line", de: "Zeile" },
  project: { en: "In the project", de: "Im Projekt" },
  card: { en: "On the card", de: "Auf der Karte" },
  equal: { en: "The set-up is equal", de: "Die Einrichtung ist gleich" },
  differs: {
    en: "{count} {count|setting differs|settings differ}",
    de: "{count} {count|Einstellung ist|Einstellungen sind} verschieden",
  },
  reading: {
    en: "The card is asked: this takes some seconds",
    de: "Die Karte wird gefragt: Das dauert einige Sekunden",
  },
  none: { en: "not there", de: "nicht vorhanden" },
  machine: {
    en: "Set by AcroMill for its machine, no difference ({count})",
    de: "Von AcroMill für seine Maschine gesetzt, kein Unterschied ({count})",
  },
  restart: {
    en: "The card gets the set-up of the project when the panel is started again. UPLOAD stores what differs in its lines of setup.8k.",
    de: "Die Karte bekommt die Einrichtung des Projekts, wenn das Panel neu gestartet wird. HOLEN schreibt, was verschieden ist, in seine Zeilen der setup.8k.",
  },
  silent: {
    en: "Not compared, as the card does not tell it: {what}",
    de: "Nicht verglichen, weil die Karte es nicht sagt: {what}",
  },
};

/**
 * @typedef {[string, string, number, string | null, string | null, "" | "machine"]} Row key, name, line of setup.8k,
 *   value in the project and on the card, whose it is
 * @typedef {{ version: string, differs: number, rows: Row[], not_compared: string[] }} Setup
 */

/** How many settings differ, as far as is known; the sign of the bar follows it. */
export const setupDiffers = new Signal(0);

/**
 * Ask the card.
 * @returns {Promise<Setup>}
 */
export async function readSetup() {
  const found = await get("project/setup");
  setupDiffers.set(found.differs);
  return found;
}

/**
 * The part of the pane Project.
 * @param {import("../core/signal.js").Endings} endings
 */
export function setupPart(endings) {
  const newest = latest(endings);
  const state = h("p", { role: "status", data: { part: "setup-state" } });
  const rows = h("div.stack", {});
  const element = h("section.stack.project-setup", {}, h("h3", {}, t(TEXTS.title)), state, rows);
  /** @type {Setup | null} */
  let known = null;

  async function read() {
    fill(state, t(TEXTS.reading));
    const found = await newest(readSetup()).catch((error) => {
      refuse(error);
      fill(state, String(error.message ?? error));
    });
    if (!found) return;
    known = found;
    const differing = found.rows.filter((row) => !row[5]);
    const others = found.rows.filter((row) => row[5]);
    state.classList.toggle("program-differs", differing.length > 0);
    fill(state, differing.length ? t(TEXTS.differs, { count: differing.length }) : t(TEXTS.equal));
    fill(
      rows,
      differing.length ? table(differing) : null,
      others.length
        ? h("details", {}, h("summary", {}, t(TEXTS.machine, { count: others.length })), table(others))
        : null,
      h("p.hint", {}, t(TEXTS.restart)),
      h("p.hint", {}, t(TEXTS.silent, { what: found.not_compared.join("; ") })),
    );
  }

  return {
    element,
    read,
    /** What would be lost in the folder: the lines of setup.8k that get another value. */
    lost: () => (known?.rows ?? []).filter((row) => !row[5] && row[2]).length,
    differs: () => known?.differs ?? 0,
    /** Store what differs into setup.8k. */
    async store() {
      await send("POST", "project/setup", { version: known?.version ?? "" });
      await read();
    },
  };
}

/** @param {Row[]} rows */
function table(rows) {
  const cell = (/** @type {string | null} */ value) => h("td.mono", {}, value ?? h("span.quiet", {}, t(TEXTS.none)));
  return h(
    "table.grid",
    {},
    h(
      "thead",
      {},
      h("tr", {}, ...[TEXTS.setting, TEXTS.line, TEXTS.project, TEXTS.card].map((text) => h("th", {}, t(text)))),
    ),
    h(
      "tbody",
      {},
      ...rows.map(([key, name, line, project, card]) =>
        h(
          "tr",
          { data: { setting: key }, title: name },
          h("th.mono", { scope: "row" }, key, name ? h("small.quiet", {}, ` ${name}`) : ""),
          h("td.number", {}, line || "\u2013"),
          cell(project),
          cell(card),
        ),
      ),
    ),
  );
}
