// BUS: the devices of the machine's EtherCAT bus in the order of the cable, its drives, its counters.
import { get } from "../../core/api.js";
import { give, report as say } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { language, t } from "../../core/texts.js";

const TEXTS = {
  closed: {
    en: "No bus is open: openacr panel PROJECT --real opens the one that machine.toml describes.",
    de: "Kein Bus ist offen: openacr panel PROJEKT --real öffnet den, den machine.toml beschreibt.",
  },
  unknown: {
    en: "The card with the bus does not report: it starts, or has ended.",
    de: "Die Karte mit dem Bus meldet nichts: Sie startet, oder sie ist beendet.",
  },
  fine: { en: "The bus works", de: "Der Bus arbeitet" },
  comingUp: { en: "The bus is being brought up again", de: "Der Bus wird wieder hochgefahren" },
  stopped: { en: "All drives are stopped: {why}", de: "Alle Antriebe sind angehalten: {why}" },
  readOnly: {
    en: "read only: no drive can be enabled (--real)",
    de: "nur lesend: kein Antrieb kann eingeschaltet werden (--real)",
  },
  cycle: { en: "cycle {ms} ms", de: "Zyklus {ms} ms" },
  devices: { en: "Devices", de: "Teilnehmer" },
  drives: { en: "Drives", de: "Antriebe" },
  counters: { en: "Frames", de: "Telegramme" },
  sent: { en: "sent", de: "gesendet" },
  lost: { en: "lost", de: "verloren" },
  wrong: { en: "working counter wrong", de: "Working Counter falsch" },
  late: { en: "late", de: "verspätet" },
  loop: { en: "Real-time loop", de: "Echtzeitschleife" },
  noLoop: {
    en: "not in real time: Python exchanges the frames",
    de: "nicht in Echtzeit: Python tauscht die Telegramme aus",
  },
  cycles: { en: "real-time loop: cycles", de: "Echtzeitschleife: Takte" },
  missed: { en: "missed", de: "ausgelassen" },
  lateBy: { en: "late, \u00b5s", de: "Verspätung, \u00b5s" },
  computing: { en: "computing, \u00b5s", de: "Rechenzeit, \u00b5s" },
  times: {
    en: "median {median}, 99.99 % {most}, worst {worst}",
    de: "Median {median}, 99,99 % {most}, größte {worst}",
  },
  wereReset: { en: "The counters begin at 0", de: "Die Zähler beginnen bei 0" },
  place: { en: "Place", de: "Platz" },
  name: { en: "Name", de: "Name" },
  state: { en: "State", de: "Zustand" },
  error: { en: "Error", de: "Fehler" },
  mode: { en: "Mode", de: "Betriebsart" },
  actual: { en: "Position, counts", de: "Position, Inkremente" },
  target: { en: "Target", de: "Sollwert" },
  gone: { en: "does not answer", de: "antwortet nicht" },
  notReady: { en: "not ready to switch on", de: "nicht einschaltbereit" },
  disabled: { en: "switch on disabled", de: "Einschaltsperre" },
  ready: { en: "ready to switch on", de: "einschaltbereit" },
  switchedOn: { en: "switched on", de: "eingeschaltet" },
  operating: { en: "operation enabled", de: "Betrieb freigegeben" },
  quickStop: { en: "quick stop", de: "Schnellhalt" },
  reacting: { en: "reacts to a fault", de: "reagiert auf eine Störung" },
  fault: { en: "fault", de: "Störung" },
  notMapped: { en: "not known", de: "nicht bekannt" },
};
/** States of CiA 402 by their names at the server. @type {Record<string, import("../../core/texts.js").Said>} */
const STATES = {
  NOT_READY: TEXTS.notReady,
  DISABLED: TEXTS.disabled,
  READY: TEXTS.ready,
  SWITCHED_ON: TEXTS.switchedOn,
  OPERATING: TEXTS.operating,
  QUICK_STOP: TEXTS.quickStop,
  REACTING: TEXTS.reacting,
  FAULT: TEXTS.fault,
};
/** Error codes of drives (0x603F) as the server groups them, in German. @type {Record<number, string>} */
const FAULTS = {
  0x1000: "Störung ohne nähere Angabe",
  0x2000: "Strom",
  0x2200: "Strom im Antrieb",
  0x2300: "Strom am Motor",
  0x2310: "anhaltender Überstrom am Motor",
  0x2320: "Kurz- oder Erdschluss am Motor",
  0x2330: "Erdschluss am Motor",
  0x2340: "Kurzschluss am Motor",
  0x3000: "Spannung",
  0x3100: "Netzspannung",
  0x3110: "Netzspannung zu hoch",
  0x3120: "Netzspannung zu niedrig",
  0x3130: "eine Netzphase fehlt",
  0x3200: "Zwischenkreisspannung",
  0x3210: "Zwischenkreisspannung zu hoch",
  0x3220: "Zwischenkreisspannung zu niedrig",
  0x4000: "Temperatur",
  0x4100: "Umgebungstemperatur",
  0x4200: "Temperatur des Antriebs",
  0x4210: "Antrieb zu heiß",
  0x4300: "Temperatur des Motors",
  0x4310: "Motor zu heiß",
  0x5000: "Hardware des Antriebs",
  0x5100: "Versorgung der Elektronik",
  0x5400: "Leistungsteil",
  0x5500: "Speicher des Antriebs",
  0x6000: "Software des Antriebs",
  0x6300: "Parameter des Antriebs",
  0x6320: "falscher Parameter",
  0x7000: "Zusatzmodul",
  0x7100: "Leistung",
  0x7120: "Motor",
  0x7121: "Motor blockiert",
  0x7122: "falsche Kommutierung",
  0x7300: "Sensor",
  0x7305: "Geber 1",
  0x7306: "Geber 2",
  0x7500: "Kommunikation",
  0x8000: "Überwachung",
  0x8100: "Kommunikation",
  0x8300: "Drehmomentregler",
  0x8311: "Drehmoment zu hoch",
  0x8400: "Drehzahlregler",
  0x8500: "Lageregler",
  0x8600: "Positionierung",
  0x8611: "Schleppfehler",
  0x8612: "Grenze des Fahrwegs",
  0x9000: "externe Störung",
  0xf000: "Zusatzfunktionen",
  0xff00: "Störung nach Angabe des Herstellers",
};
/** @type {Record<number, string>} */
const MODES = { 8: "CSP", 9: "CSV", 10: "CST" };
const EVERY_MS = 250; // from an answer to the next question

/**
 * @typedef {{ position: number, name: string, state: string, code: number, text: string }} Device
 * @typedef {{ axis: string, position: number, state: string, mode: number, actual: number, target: number,
 *   is_enabled: boolean, code: number, group: number, text: string, alarm: string }} Drive
 * @typedef {{ interface: string, is_real: boolean, is_coming_up: boolean, alarm: string, cycle_s: number,
 *   counters: Record<"sent" | "lost" | "wrong" | "late", number>, devices: Device[], drives: Drive[],
 *   loop: Loop | null }} Report
 * @typedef {{ median_s: number, most_s: number, worst_s: number }} Times
 * @typedef {{ period_s: number, cycles: number, missed: number, late: Times, computing: Times }} Loop
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head }) {
  const endings = new Endings();
  const state = h("p", { role: "status" });
  const about = h("p.quiet", {});
  const counters = h("dl.row.wrap", { ariaLabel: t(TEXTS.counters) });
  const loop = h("dl.row.wrap", { ariaLabel: t(TEXTS.loop) });
  const devices = table(TEXTS.devices, [TEXTS.place, TEXTS.name, TEXTS.state, TEXTS.error]);
  const drives = table(TEXTS.drives, [
    "form.axis",
    TEXTS.place,
    TEXTS.state,
    TEXTS.mode,
    TEXTS.actual,
    TEXTS.target,
    TEXTS.error,
  ]);
  const key = keyOf("bus.reset", async () => (await give("bus.reset")) && say(t(TEXTS.wereReset)));
  const all = h("div", {}, about, counters, loop, drives.element, devices.element);
  head.append(key);
  host.append(h("div.grow.scroll", { tabIndex: 0 }, state, all));
  let isOpen = true;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;

  async function look() {
    const found = await get("card/bus").catch((error) => error);
    if (!isOpen) return;
    const known = found instanceof Error ? null : /** @type {Report | null} */ (found.report);
    all.hidden = key.hidden = !known;
    state.classList.toggle("refusal", found instanceof Error || !!known?.alarm || (!known && found.is_open));
    if (known) draw(known);
    else setText(state, found instanceof Error ? found.message : t(found.is_open ? TEXTS.unknown : TEXTS.closed));
    timer = setTimeout(look, EVERY_MS);
  }

  /** @param {Report} bus */
  function draw(bus) {
    const why = bus.alarm;
    setText(state, bus.is_coming_up ? t(TEXTS.comingUp) : why ? t(TEXTS.stopped, { why }) : t(TEXTS.fine));
    const notes = [bus.interface, t(TEXTS.cycle, { ms: (bus.cycle_s * 1000).toFixed(1) })];
    if (!bus.is_real) notes.push(t(TEXTS.readOnly));
    if (!bus.loop) notes.push(t(TEXTS.noLoop));
    setText(about, notes.join(" \u00b7 "));
    const names = /** @type {const} */ (["sent", "lost", "wrong", "late"]);
    fill(counters, ...names.map((name) => figure(name, TEXTS[name], `${bus.counters[name]}`)));
    fill(loop, ...(bus.loop ? figuresOf(bus.loop) : []));
    devices.show(
      bus.devices.map((one) => ({
        key: `${one.position}`,
        cells: [`${one.position}`, one.name, one.state || t(TEXTS.gone), one.text],
        isWrong: !one.state || one.code > 0,
      })),
    );
    drives.show(
      bus.drives.map((one) => ({
        key: one.axis,
        cells: [
          one.axis,
          `${one.position}`,
          one.state ? t(STATES[one.state]) : t(TEXTS.notMapped),
          MODES[one.mode] ?? `${one.mode}`,
          number(one.actual),
          number(one.target),
          errorOf(one),
        ],
        isWrong: !!one.alarm || one.code > 0,
      })),
    );
  }

  endings.add(() => {
    isOpen = false;
    clearTimeout(timer);
  });
  await look();
  return () => endings.end();
}

/**
 * A figure with its name.
 * @param {string} counter
 * @param {import("../../core/texts.js").Said} name
 * @param {string} value
 */
function figure(counter, name, value) {
  return h("div.row", { data: { counter } }, h("dt", {}, t(name)), h("dd.mono", {}, value));
}

/**
 * How the real-time loop has kept time.
 * @param {Loop} loop
 */
function figuresOf(loop) {
  return [
    figure("cycles", TEXTS.cycles, `${loop.cycles}`),
    figure("missed", TEXTS.missed, `${loop.missed}`),
    figure("late-by", TEXTS.lateBy, timesOf(loop.late)),
    figure("computing", TEXTS.computing, timesOf(loop.computing)),
  ];
}

/** @param {Times} times */
function timesOf({ median_s, most_s, worst_s }) {
  const [median, most, worst] = [median_s, most_s, worst_s].map((s) => (1e6 * s).toFixed(0));
  return t(TEXTS.times, { median, most, worst });
}

/**
 * A table whose rows and cells stay the same elements as long as the devices do.
 * @param {import("../../core/texts.js").Said} title
 * @param {import("../../core/texts.js").Said[]} columns
 */
function table(title, columns) {
  const body = h("tbody", {});
  /** @type {Map<string, HTMLElement[]>} */
  let cells = new Map();
  const heads = columns.map((each) => h("th", { scope: "col" }, t(each)));
  const element = h("table.grid", {}, h("caption", {}, t(title)), h("thead", {}, h("tr", {}, ...heads)), body);
  return {
    element,
    /** @param {{ key: string, cells: string[], isWrong: boolean }[]} rows */
    show(rows) {
      if (rows.map((row) => row.key).join() !== [...cells.keys()].join()) {
        cells = new Map(rows.map((row) => [row.key, row.cells.map(() => h("td", {}))]));
        fill(body, ...rows.map((row) => h("tr", { data: { row: row.key } }, ...(cells.get(row.key) ?? []))));
      }
      for (const row of rows) {
        const own = cells.get(row.key) ?? [];
        row.cells.forEach((text, n) => setText(own[n], text));
        own[own.length - 1].classList.toggle("refusal", row.isWrong);
      }
    },
  };
}

/**
 * The error code of a drive with its meaning, and why its axis was stopped.
 * @param {Drive} drive
 */
function errorOf({ code, group, text, alarm }) {
  if (!code) return alarm;
  const hex = `0x${code.toString(16).toUpperCase().padStart(4, "0")}`;
  const said = language() === "de" ? (FAULTS[group] ?? text) : text;
  return said ? `${hex} ${said}` : hex;
}

/** @param {number} value */
function number(value) {
  return `${value}`.replace("-", "\u2212");
}
