// The oscilloscope: eight channels and one computed, trigger, cursors, XY, spectrum, references, files.
import { give, link, model, refuse } from "../../core/app.js";
import { h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings, Signal } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { arm, resumed } from "../../scope/arm.js";
import { BRANCH, ofBranch } from "../../scope/branch.js";
import { Channels, CHANNELS, fullLabel } from "../../scope/channels.js";
import { cursorPlugin } from "../../scope/cursors.js";
import { exportAs } from "../../scope/export.js";
import { chooseKept, KEPT } from "../../scope/kept_dialog.js";
import { LongRecord } from "../../scope/long_record.js";
import { cursorText, distanceText, samplesAt, showMeasures } from "../../scope/measure_table.js";
import { createOverview } from "../../scope/overview.js";
import { panningPlugin } from "../../scope/panning.js";
import { moved, Recording } from "../../scope/recording.js";
import { Reference, SHORT } from "../../scope/reference.js";
import { axesOf, DIVISIONS } from "../../scope/scales.js";
import { createScreen } from "../../scope/screen.js";
import { createSpectrum, showPeaks } from "../../scope/spectrum_view.js";
import { Settings } from "../../scope/settings.js";
import { shownOf } from "../../scope/shown.js";
import { recordText, stateOf, stateText } from "../../scope/state.js";
import { triggerPlugin } from "../../scope/trigger_mark.js";
import { within, zoomed } from "../../scope/view.js";
import { createXy } from "../../scope/xy.js";
import { keepInOneRow } from "../overflow.js";
import { takeWanted } from "../wanted.js";

const TEXTS = {
  settings: { en: "SETTINGS", de: "EINSTEL\u00adLUNGEN" },
  cursors: { en: "CURSORS", de: "CURSOR" },
  zoom: { en: "wheel: zoom, drag: pan, double click: back", de: "Rad: Zoom, ziehen: verschieben, Doppelklick: zurück" },
  part: {
    en: "The {count} samples between the cursors (without them: on the screen) as CSV or Parquet, or the picture.",
    de: "Die {count} Messwerte zwischen den Cursorn (ohne sie: auf dem Schirm) als CSV oder Parquet, oder das Bild.",
  },
  tooMany: {
    en: "{count} samples are on the screen: M, XY and FFT are computed of {most} at most, {seconds} s",
    de: "{count} Messwerte sind auf dem Schirm: M, XY und FFT werden aus höchstens {most} berechnet, {seconds} s",
  },
  zoomLabel: {
    en: "Screen of the scope: + and - zoom a record at rest, left and right pan it, 0 shows its sweep, up and down move the level of the trigger",
    de: "Schirm des Scope: + und - vergrößern oder verkleinern eine ruhende Aufzeichnung, links und rechts verschieben sie, 0 zeigt ihre Ablenkung, auf und ab bewegen den Pegel des Triggers",
  },
};

const VIEWS = /** @type {const} */ (["time", "xy", "spectrum"]);
const SLOW_S = 0.5; // a sweep of this time and more is also drawn while it comes
const KEYS = /** @type {Record<string, number>} */ ({ "+": 1, "-": -1 }); // zoom
const LEVELS = /** @type {Record<string, number>} */ ({ ArrowUp: 0.1, ArrowDown: -0.1 }); // divisions
const PANS = /** @type {Record<string, number>} */ ({ ArrowLeft: -1, ArrowRight: 1 }); // divisions

/**
 * @typedef {import("../../scope/channels.js").Channel} Channel
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept: layout, keep }) {
  const endings = new Endings();
  const [live, recording] = [new Endings(), new Recording()];
  const cursors = new Signal(/** @type {[number, number] | null} */ (null));
  /** @type {typeof VIEWS[number]} */
  let view = "time";
  /** The part of a record at rest that is shown, null: its sweep. @type {import("../../scope/view.js").View | null} */
  let part = null;
  /** What was drawn last. @type {import("../../scope/reference.js").Kept & { step: number }} */
  let drawn = { traces: [], period: 1, start: 0, from: 0, step: 1 };
  const changed = () => {
    keep({ channels: channels.kept(), ...settings.kept(), isFull: side.hidden });
    showRecord();
    update();
  };
  const channels = new Channels(layout.channels ?? [], changed);
  const settings = new Settings(layout, changed);
  const hosts = VIEWS.map((each) => h("div.scope-chart.grow", { hidden: each !== view, data: { view: each } }));
  Object.assign(hosts[0], { role: "group", tabIndex: 0, ariaLabel: t(TEXTS.zoomLabel), onkeydown: zoomByKey });
  const state = h("span.scope-state.grow", { role: "status" });
  const zooming = h("span.hint", {}, t(TEXTS.zoom));
  const distance = h("span.hint", { data: { cursors: "" } });
  const table = h("table.grid.scope-measures", {});
  const keys = VIEWS.map((each) => keyOf(/** @type {any} */ (`scope.view.${each}`), () => show(each)));
  const side = h(
    "div.scope-side.scroll",
    { tabIndex: 0, hidden: Boolean(layout.isFull) },
    channels.element(),
    settings.element(),
  );
  const sideKey = keyOf(TEXTS.settings, () => {
    side.hidden = !side.hidden;
    sideKey.ariaPressed = String(!side.hidden);
    side.scrollIntoView();
    changed();
  });
  sideKey.ariaPressed = String(!side.hidden);
  const cursorKey = keyOf(TEXTS.cursors, toggleCursors);
  const reference = new Reference(() => draw(), shownNow);
  const long = new LongRecord(() => settings.isRecord && update(), endings);
  const overview = createOverview(long, () => channels.asked.map((place) => channels.rows[place].color.value), endings);
  head.append(
    keyOf("scope.start", () => void (settings.isRecord ? beginRecord() : sample()).catch(refuse), ".main"),
    keyOf("scope.stop", () => void give(settings.isRecord ? "record.end" : "scope.stop")),
    keyOf("scope.autoscale", () => {
      channels.fit(shownNow().traces);
      changed();
    }),
    ...keys,
    cursorKey,
    reference.key,
    keyOf(BRANCH, () => void ofBranch(recording, channels).then((found) => found && reference.set(found), refuse)),
    keyOf(KEPT, () => void chooseKept(keeping).catch(refuse)),
    sideKey,
    keyOf("scope.export", choose),
  );
  head.classList.add("is-full");
  endings.add(keepInOneRow(head));
  host.classList.add("is-scope", "is-wide");
  host.append(
    side,
    h(
      "div.stack.grow.scope-right",
      {},
      ...hosts,
      overview.canvas,
      h("div.row.wrap.scope-line", {}, state, zooming, distance),
      h("div.scroll.scope-table", { tabIndex: 0 }, table),
    ),
  );
  const panning = panningPlugin({ isAsked: () => isAtRest() && !cursors.value, zoom, pan, reset });
  const screen = createScreen(hosts[0], endings, [
    triggerPlugin(mark, moveLevel),
    cursorPlugin(cursors, { sample: () => 1000 * drawn.period, textAt, raise }),
    panning,
  ]);
  const xy = createXy(hosts[1], endings, fullLabel);
  const spectra = createSpectrum(hosts[2], endings);
  channels.sources();
  await channels.nameUnits().catch(refuse);

  /** The state of the scope for this pane. */
  function stateNow() {
    return stateOf(model.capture.value, live.list.length ? recording : null);
  }

  /** Whether there is a record that no sample is added to. */
  function isAtRest() {
    if (settings.isRecord) return long.ends[1] > 0;
    return recording.count > 0 && ["stopped", "taken"].includes(stateNow());
  }

  function shownNow() {
    return shownOf({ settings, long, channels, recording }, part);
  }

  /** What has come of the next sweep, where it takes its time. */
  function coming() {
    const next = recording.samples * recording.period >= SLOW_S && !isAtRest() ? recording.underWay() : null;
    return {
      traces: next ? channels.traces(next.channels, recording.period) : [],
      start: next ? (next.first - next.zero) * 1000 * recording.period : 0,
    };
  }

  function draw() {
    channels.hasLanes = settings.fields.flags.value === "lanes";
    channels.isShared = settings.fields.axes.value === "unit";
    zooming.hidden = view !== "time" || !isAtRest();
    drawn = shownNow();
    const { traces: present, ...frame } = drawn;
    const { start, period } = frame;
    const length = present[0]?.values.length ?? 0;
    const at = (/** @type {Channel[]} */ traces, /** @type {number} */ begin) =>
      traces.map((each) => ({
        ...each,
        values: moved(each.values, Math.round((begin - start) / (1000 * period)), length),
      }));
    const begin = cursors.value ? Math.min(...cursors.value) : frame.from;
    const other = settings.isRecord
      ? reference.over(begin, frame, length, long.isEnvelope)
      : reference.over(reference.kept?.from ?? 0, frame, length);
    if (view === "time") {
      const next = settings.isRecord ? { traces: [], start } : coming();
      const named = other.map((each) => ({ ...each, label: `${each.label} ${t(SHORT)}`, isReference: true }));
      screen.draw([...present, ...named, ...at(next.traces, next.start).map((each) => ({ ...each, isFaint: true }))], {
        ...frame,
        axes: axesOf(present, settings.fields.axes.value).map(axisOf),
      });
    } else if (settings.isRecord && long.isEnvelope) {
      refuseOnce();
    } else if (view === "xy") {
      const isEqual = settings.fields.aspect.value === "equal";
      xy.draw(settings.traceOf(present, "x"), settings.traceOf(present, "y"), isEqual);
    } else drawSpectrum(present, period, start / 1000);
    if (view !== "spectrum")
      showMeasures(
        table,
        present,
        { period, begin: start / 1000 },
        cursors.value,
        new Map(other.map(({ label, values }) => [label, values])),
        settings.isRecord && long.isEnvelope ? long.found : null,
      );
    if (settings.isRecord) overview.draw();
    setText(distance, cursors.value ? distanceText(cursors.value) : whyNot());
  }

  /** Extremes are neither a path nor a spectrum: the screen shows its curves until a part has few enough samples. */
  function refuseOnce() {
    if (!long.why) return; // its samples are on their way
    refuse(t(TEXTS.tooMany, long.why));
    show("time");
  }

  /** What cannot be computed of a long part, where that is wanted. */
  function whyNot() {
    const isWanted = settings.isRecord && channels.rows[CHANNELS].source.value.trim();
    return isWanted && long.why ? t(TEXTS.tooMany, long.why) : "";
  }

  /** Show the record that the panel keeps, where that is what was chosen. */
  function showRecord() {
    overview.canvas.hidden = !settings.isRecord;
    long.isOn = settings.isRecord;
    compute();
    if (!settings.isRecord) return;
    long.width = hosts[0].clientWidth || long.width;
    const { state: now } = long;
    if (now.number)
      void channels
        .have(now.channels ?? [])
        .then(update)
        .catch(refuse);
    long.ask();
  }

  /** What is kept under a name, and how it is taken. @type {import("../../scope/kept_dialog.js").Shown} */
  const keeping = {
    setup: () => ({ channels: channels.kept(), ...settings.kept() }),
    reference: () => reference.kept ?? shownNow(),
    take: {
      setup: (found) => {
        settings.set(found.settings);
        channels.set(found.channels);
        void channels.nameUnits().then(changed, refuse);
      },
      reference: (found) => reference.set(found),
    },
  };

  /** Have every sample of the part, where something is computed of them. */
  function compute() {
    const isComputed = view !== "time" || Boolean(channels.rows[CHANNELS].source.value.trim());
    if (isComputed === long.isComputed) return;
    long.isComputed = isComputed;
    if (settings.isRecord) long.ask();
  }

  /** Begin a long record. */
  async function beginRecord() {
    const asked = { channels: channels.sources(), period_ms: settings.number("period") };
    await channels.nameUnits();
    long.view = { from: 0, step: settings.sweepMs };
    await arm("record.begin", asked);
  }

  /** @param {Channel} trace */
  function axisOf(trace) {
    const isShared = settings.fields.axes.value === "unit";
    return { ...trace, label: isShared ? trace.unit || trace.label : `${trace.label} ${trace.unit}`.trim() };
  }

  /** @param {import("../../scope/view.js").View | null} chosen */
  function showPart(chosen) {
    if (!isAtRest()) return;
    part = chosen;
    draw();
  }

  /** Times of the first and last sample that are kept, ms. */
  function ends() {
    const { zero } = recording.window();
    return /** @type {import("../../scope/view.js").Ends} */ (
      recording.kept.map((each) => (each - zero) * 1000 * recording.period)
    );
  }

  /**
   * @param {boolean} isFiner
   * @param {number} at
   */
  function zoom(isFiner, at) {
    if (settings.isRecord) long.zoom(isFiner, at);
    else showPart(zoomed(shownNow(), isFiner, at, ends(), 1000 * recording.period));
  }

  function reset() {
    if (settings.isRecord) long.all();
    else showPart(null);
  }

  /** @param {number} by */
  function pan(by) {
    if (settings.isRecord) {
      long.pan(by);
      return;
    }
    const { from, step } = shownNow();
    showPart(within({ from: from + by, step }, ends()));
  }

  /** @param {KeyboardEvent} event */
  function zoomByKey(event) {
    const { from, step } = shownNow();
    if (raise(event)) return;
    if (event.key in KEYS) zoom(KEYS[event.key] > 0, from + (DIVISIONS / 2) * step);
    else if (event.key in PANS) pan(PANS[event.key] * step);
    else if (event.key === "0") reset();
    else return;
    event.preventDefault();
  }

  /** A key that moves the level of the trigger: a tenth of a division, with Shift a whole one. @param {KeyboardEvent} event */
  function raise(event) {
    const by = LEVELS[event.key];
    const shown = by ? mark() : null;
    if (!by || !shown) return false;
    event.preventDefault();
    event.stopPropagation();
    moveLevel(shown.level + by * (event.shiftKey ? 10 : 1), true);
    return true;
  }

  /** @param {number} n */
  function textAt(n) {
    const at = cursors.value?.[n] ?? 0;
    const time = { period: drawn.period, begin: drawn.start / 1000 };
    return cursorText(
      drawn.traces,
      time,
      at,
      settings.isRecord && long.isEnvelope ? (long.found?.at[n] ?? {}) : undefined,
    );
  }

  /** The trigger that is set, on the screen. */
  function mark() {
    const trigger = settings.trigger;
    const scale = trigger && channels.scaleOf(trigger.channel);
    return trigger && scale ? { level: (trigger.level - scale.offset) / scale.scale, color: scale.color } : null;
  }

  /**
   * @param {number} level in divisions
   * @param {boolean} isDone
   */
  function moveLevel(level, isDone) {
    const scale = settings.trigger && channels.scaleOf(settings.trigger.channel);
    if (!scale) return;
    settings.setLevel(Number((level * scale.scale + scale.offset).toPrecision(4)));
    screen.redraw();
    if (!isDone) return;
    changed();
    if (["waiting", "triggered"].includes(stateNow())) void sample().catch(refuse);
  }

  /**
   * The spectra of what is between the cursors, else of the whole screen, with the peaks of each.
   * @param {Channel[]} present
   * @param {number} period
   * @param {number} begin s of the first sample
   */
  function drawSpectrum(present, period, begin) {
    const [from, to] = cursors.value && period ? samplesAt(cursors.value, period, begin) : [0, Infinity];
    const parts = present.map((each) => ({
      ...each,
      values: Float64Array.from(each.values).subarray(Math.max(0, from), to + 1),
    }));
    const found = spectra.draw(parts, period, settings.spectrum);
    showPeaks(table, present, found);
  }

  /** @param {typeof VIEWS[number]} chosen */
  function show(chosen) {
    view = chosen;
    VIEWS.forEach((each, n) => {
      hosts[n].hidden = each !== view;
      keys[n].ariaPressed = String(each === view);
    });
    compute();
    draw();
  }

  function toggleCursors() {
    const { from, step } = shownNow();
    cursors.set(cursors.value ? null : [from + 0.25 * DIVISIONS * step, from + 0.75 * DIVISIONS * step]);
  }

  async function sample() {
    const asked = { channels: channels.sources(), ...settings.asked(channels.asked) };
    await channels.nameUnits();
    live.end();
    live.add(link.subscribe({ topic: "scope", hz: 10 }));
    const armed = await arm("scope.arm", asked);
    if (!armed) return;
    recording.begin(armed.channels.length, armed, asked.trigger, settings.run);
    part = null;
    update();
  }

  function update() {
    const now = settings.isRecord ? (long.state.running ? "running" : "stopped") : stateNow();
    state.dataset.state = now;
    setText(state, settings.isRecord ? recordText(long) : stateText(stateNow(), model.capture.value, recording.count));
    draw();
  }

  async function choose() {
    const { traces: shown, period, start } = shownNow();
    const names = shown.filter(({ label }) => label !== "M").map(fullLabel);
    const canvas = { time: screen.canvas, xy: xy.canvas, spectrum: spectra.canvas() }[view];
    const picture = { traces: shown, period, begin: start / 1000, canvas, trigger: settings.trigger };
    if (!settings.isRecord) return exportAs(picture);
    const [first, last] = long.part();
    return exportAs(
      picture,
      t(TEXTS.part, { count: last - first }),
      last > first ? (kind) => long.file(kind, names) : null,
    );
  }

  endings.add(
    resumed(() => (live.list.length ? recording.number : 0)),
    () => live.end(),
    () =>
      void (link.isOpen.value && live.list.length && !recording.isTaken && link.command("scope.stop").catch(() => {})),
    cursors.watch((both) => {
      cursorKey.ariaPressed = String(both !== null);
      long.cursors = both;
      if (settings.isRecord) long.ask();
      screen.redraw();
      draw();
    }),
    model.scope.watch((piece) => {
      if (!piece || !live.list.length) return;
      recording.add(piece);
      update();
    }),
    model.record.watch((record) => {
      long.note(record);
      if (!settings.isRecord) return;
      showRecord();
      update();
    }),
    model.capture.watch((capture) => {
      if (!live.list.length) return;
      recording.note(capture);
      update();
    }),
  );
  long.view = { from: 0, step: settings.sweepMs };
  long.note(model.record.value);
  showRecord();
  show(view);
  update();
  const isSampling = () => live.list.length > 0 && !recording.isTaken && !isAtRest();
  const takeAll = (/** @type {string[]} */ ids) => {
    channels.takeAll(ids);
    void (isSampling() ? sample() : channels.nameUnits()).then(changed, refuse);
  };
  endings.add(takeWanted("scope", takeAll));
  return () => endings.end();
}
