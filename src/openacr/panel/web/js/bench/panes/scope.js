// The oscilloscope: eight channels and one computed, trigger, cursors, XY, spectrum, references, files.
import { give, link, model, refuse } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { Endings, Signal } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { ask } from "../../frame/dialog.js";
import { samplesOf } from "../../scope/branch.js";
import { Channels } from "../../scope/channels.js";
import { cursorPlugin } from "../../scope/cursors.js";
import { csvOf, keepFile, parquetOf, pngOf } from "../../scope/export.js";
import { distanceText, samplesAt, showMeasures } from "../../scope/measure_table.js";
import { Recording } from "../../scope/recording.js";
import { createScreen, DIVISIONS } from "../../scope/screen.js";
import { peaks } from "../../scope/spectrum.js";
import { createSpectrum } from "../../scope/spectrum_view.js";
import { Settings } from "../../scope/settings.js";
import { createXy } from "../../scope/xy.js";

const VIEWS = /** @type {const} */ (["time", "xy", "spectrum"]);
const PEAKS = 6;

/**
 * @typedef {import("../../scope/channels.js").Channel} Channel
 * @typedef {{ traces: Channel[], period: number }} Reference
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const live = new Endings();
  const recording = new Recording();
  const cursors = new Signal(/** @type {[number, number] | null} */ (null));
  /** @type {Reference | null} */
  let reference = null;
  /** @type {typeof VIEWS[number]} */
  let view = "time";
  const changed = () => {
    keep({ channels: channels.kept(), ...settings.kept(), isFull: side.hidden });
    draw();
  };
  const channels = new Channels(kept.channels ?? [], changed);
  const settings = new Settings(kept, changed);
  const hosts = VIEWS.map((each) => h("div.scope-chart.grow", { hidden: each !== view, data: { view: each } }));
  const state = h("span.hint.grow", { role: "status" });
  const distance = h("span.hint", { data: { cursors: "" } });
  const table = h("table.grid.scope-measures", {});
  const keys = VIEWS.map((each) => key(/** @type {any} */ (`scope.view.${each}`), () => show(each)));
  const side = h("div.scope-side.scroll", { tabIndex: 0, hidden: Boolean(kept.isFull) }, channels.element(), settings.element());
  const sideKey = key("scope.settings", () => {
    side.hidden = !side.hidden;
    sideKey.ariaPressed = String(!side.hidden);
    changed();
  });
  sideKey.ariaPressed = String(!side.hidden);
  const cursorKey = key("scope.cursors", toggleCursors);
  const referenceKey = key("scope.reference", toggleReference);
  head.append(key("scope.start", () => void start().catch(refuse), "main"), key("scope.stop", () => void give("scope.stop")), key("scope.autoscale", () => {
    channels.fit(traces());
    changed();
  }), ...keys, cursorKey, referenceKey, key("scope.branch", () => void referToBranch().catch(refuse)), sideKey, key("scope.export", choose));
  host.classList.add("is-scope", "is-wide");
  host.append(side, h("div.stack.grow.scope-right", {}, ...hosts, h("div.row.wrap", {}, state, distance), h("div.scroll.scope-table", { tabIndex: 0 }, table)));
  const screen = createScreen(hosts[0], endings, [cursorPlugin(cursors)]);
  const xy = createXy(hosts[1], endings);
  const spectra = createSpectrum(hosts[2], endings);
  channels.sources();
  await channels.nameUnits().catch(refuse);

  function traces() {
    const { channels: records, period } = recording.window();
    return channels.traces(records, period);
  }

  function draw() {
    const present = traces();
    const period = recording.period;
    const other = reference?.traces.map((each) => ({ ...each, label: `${each.label} ${t("scope.reference.short")}`, isReference: true })) ?? [];
    if (view === "time") screen.draw([...present, ...other], period, settings.sweepMs);
    else if (view === "xy") xy.draw(settings.traceOf(present, "x"), settings.traceOf(present, "y"));
    else drawSpectrum(present, period);
    if (view !== "spectrum") showMeasures(table, present, period, cursors.value, new Map(reference?.traces.map(({ label, values }) => [label, values])));
    setText(distance, cursors.value ? distanceText(cursors.value) : "");
  }

  /**
   * The spectra of what is between the cursors, else of the whole screen, with the peaks of each.
   * @param {Channel[]} present
   * @param {number} period
   */
  function drawSpectrum(present, period) {
    const [from, to] = cursors.value && period ? samplesAt(cursors.value, period) : [0, Infinity];
    const parts = present.map((each) => ({ ...each, values: Float64Array.from(each.values).subarray(from, to + 1) }));
    const found = spectra.draw(parts, period, settings.spectrum);
    fill(table, h("tbody", {}, ...present.map(({ label, unit }, n) => h("tr", { data: { trace: label } }, h("th", { attr: { scope: "row" } }, label), ...peaksOf(found[n], unit)))));
  }

  /** @param {typeof VIEWS[number]} chosen */
  function show(chosen) {
    view = chosen;
    VIEWS.forEach((each, n) => {
      hosts[n].hidden = each !== view;
      keys[n].ariaPressed = String(each === view);
    });
    draw();
  }

  function toggleCursors() {
    cursors.set(cursors.value ? null : [0.25 * DIVISIONS * settings.sweepMs, 0.75 * DIVISIONS * settings.sweepMs]);
  }

  /** The traces that are shown now are kept beside the next ones. */
  function toggleReference() {
    refer(reference ? null : traces().map((each) => ({ ...each, values: Float64Array.from(each.values) })));
  }

  /** What another branch did at the ticks that are shown is the reference. */
  async function referToBranch() {
    const { why, branch: present, branches, period_s: tickTime } = model.timeline.value;
    const others = branches.flatMap((each) => (each.number === present || each.last === null ? [] : { ...each, last: each.last }));
    if (why || !others.length) throw new Error(why || t("time.noother"));
    const chosen = await ask({ title: t("scope.branch"), body: [h("p", {}, t("scope.branch.text"))], choices: others.map((each) => ({ text: each.name, value: each })) });
    if (chosen) refer(channels.traces(await samplesOf(chosen, recording, tickTime), recording.period));
  }

  /** @param {Channel[] | null} chosen */
  function refer(chosen) {
    reference = chosen && { traces: chosen, period: recording.period };
    referenceKey.ariaPressed = String(reference !== null);
    draw();
  }

  async function start() {
    const asked = { channels: channels.sources(), ...settings.asked(channels.asked) };
    await channels.nameUnits();
    live.end();
    live.add(link.subscribe({ topic: "scope", hz: 10 }));
    const armed = await give("scope.arm", asked);
    if (armed) recording.begin(armed.channels.length, armed, asked.trigger, settings.run);
    setText(state, armed ? t("scope.armed") : "");
    draw();
  }

  function update() {
    const text = model.capture.value.running ? "scope.read" : "scope.stopped";
    setText(state, recording.count ? t(text, { count: recording.count }) : t("scope.armed"));
    draw();
  }

  async function choose() {
    const kind = await ask({ title: t("scope.export"), body: [h("p", {}, t("scope.export.text"))], choices: ["csv", "parquet", "png"].map((each) => ({ text: each.toUpperCase(), value: each })) });
    if (kind) await save(kind).catch(refuse);
  }

  /** @param {string} kind */
  async function save(kind) {
    const [present, period] = [traces(), recording.period];
    if (kind !== "png" && !present.length) throw new Error(t("scope.export.none"));
    const canvas = { time: screen.canvas, xy: xy.canvas, spectrum: spectra.canvas() }[view];
    if (kind === "csv") keepFile("scope.csv", new Blob([csvOf(present, period)], { type: "text/csv" }));
    else if (kind === "parquet") keepFile("scope.parquet", await parquetOf(present, period));
    else if (canvas) keepFile("scope.png", await pngOf(canvas));
  }

  endings.add(
    () => live.end(), () => void (link.isOpen.value && live.list.length && link.command("scope.stop").catch(() => {})),
    cursors.watch((both) => {
      cursorKey.ariaPressed = String(both !== null);
      screen.redraw();
      draw();
    }),
    model.scope.watch((piece) => {
      if (!piece || !live.list.length) return;
      recording.add(piece);
      update();
    }),
    model.capture.watch((capture) => {
      recording.note(capture);
      if (live.list.length) update();
    }),
  );
  show(view);
  return () => endings.end();
}

/**
 * @param {ReturnType<typeof import("../../scope/spectrum.js").spectrum>} found
 * @param {string} unit
 */
function peaksOf(found, unit) {
  if (!found) return [h("td", {}, t("scope.spectrum.gap"))];
  const digits = (/** @type {number} */ value) => String(Number(value.toPrecision(5)));
  return peaks(found.amplitudes, PEAKS).map((n) => h("td.number", {}, `${digits(n * found.step)} Hz: ${digits(found.amplitudes[n])} ${unit}`.trim()));
}

/**
 * @param {import("../../core/texts.js").TextKey} text
 * @param {() => void} onclick
 * @param {string} [kind]
 */
function key(text, onclick, kind = "") {
  return h("button.key", { type: "button", className: `key ${kind}`, onclick }, t(text));
}
