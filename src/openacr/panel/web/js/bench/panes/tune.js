// TUNING: an axis is measured, its motor and margins are shown, gains proposed, predicted, and set when confirmed.
import { give, link, model, report } from "../../core/app.js";
import { cardAxes } from "../../core/card_axes.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { confirm } from "../../frame/dialog.js";
import { mayMove } from "../../motion/actions.js";
import { drawTuning } from "../tuning/charts.js";
import { columnsOf, factsOf, filterText, GAINS, inMs, shown, tableOf, worseOf } from "../tuning/figures.js";
import { keptMeasurements } from "../tuning/kept.js";
import { keptOf } from "../tuning/kept_data.js";
import { gainSliders } from "../tuning/sliders.js";

const TEXTS = {
  amplitude: { en: "Amplitude, pulses", de: "Amplitude, Pulse" },
  lowest: { en: "Lowest frequency, Hz", de: "Tiefste Frequenz, Hz" },
  highest: { en: "Highest frequency, Hz", de: "H\u00f6chste Frequenz, Hz" },
  time: { en: "Time, s (empty: what fits)", de: "Dauer, s (leer: was passt)" },
  margin: { en: "Phase margin, degrees", de: "Phasenreserve, Grad" },
  wanted: { en: "Crossover, Hz (empty: the highest)", de: "Durchtritt, Hz (leer: der h\u00f6chste)" },
  integral: { en: "with IGAIN", de: "mit IGAIN" },
  measureText: {
    en: "Axis {axis} moves now: by {amplitude} pulses to both sides, for {time} s at most, quicker and quicker. Is it free to move? STOP ends it.",
    de: "Achse {axis} bewegt sich jetzt: um {amplitude} Pulse nach beiden Seiten, höchstens {time} s lang, immer schneller. Ist ihr Weg frei? STOP beendet es.",
  },
  applyText: {
    en: "Axis {axis} gets {gains}. It then makes a step; predicted overshoot: {overshoot} %. Bad gains are taken back by the card.",
    de: "Achse {axis} bekommt {gains}. Dann macht sie einen Sprung; vorhergesagtes \u00dcberschwingen: {overshoot} %. Schlechte Werte nimmt die Karte zur\u00fcck.",
  },
  moving: { en: "Axis {axis} is measured. STOP ends it.", de: "Achse {axis} wird gemessen. STOP beendet es." },
  reading: { en: "{done} of {count} {count|sample|samples}", de: "{done} von {count} Werten" },
  done: { en: "Axis {axis} is measured; nothing has been set", de: "Achse {axis} ist gemessen; nichts wurde gesetzt" },
  nothing: { en: "Nothing is proposed: {why}", de: "Nichts wird vorgeschlagen: {why}" },
  applied: { en: "Axis {axis} has the proposed gains", de: "Achse {axis} hat die vorgeschlagenen Werte" },
  stepText: {
    en: "Axis {axis} moves now: by {amplitude} pulses and back, at once. Is it free to move? STOP ends it.",
    de: "Achse {axis} bewegt sich jetzt: um {amplitude} Pulse und zur\u00fcck, auf einmal. Ist ihr Weg frei? STOP beendet es.",
  },
  stepped: {
    en: "Axis {axis}: overshoot {overshoot} %, rise {rise} ms, settling {settling} ms",
    de: "Achse {axis}: \u00dcberschwingen {overshoot} %, Anstieg {rise} ms, Einschwingen {settling} ms",
  },
  charts: { en: "CHARTS", de: "DIAGRAMME" },
  bode: { en: "BODE", de: "BODE" },
  step: { en: "STEP", de: "SPRUNG" },
  simulation: { en: "SIMULATION", de: "SIMULATION" },
  table: { en: "TABLE", de: "TABELLE" },
  view: { en: "View", de: "Ansicht" },
  noTable: {
    en: "MEASURE an axis, or show kept measurements: the table compares them.",
    de: "Eine Achse MESSEN oder abgelegte Messungen zeigen: Die Tabelle vergleicht sie.",
  },
};

const FIELDS = /** @type {const} */ ([
  ["amplitude", TEXTS.amplitude, "100"],
  ["low_hz", TEXTS.lowest, "2"],
  ["high_hz", TEXTS.highest, "60"],
  ["time_s", TEXTS.time, ""],
  ["phase_deg", TEXTS.margin, "55"],
  ["bandwidth_hz", TEXTS.wanted, ""],
]);
const LONGEST_S = 1.5; // of a sweep without a given time
const CHARTS = /** @type {const} */ (["bode", "step", "simulation"]);
const VIEWS = /** @type {const} */ (["charts", ...CHARTS, "table"]);
const WIDE = 660; // pixels in which all charts have their place beside each other

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const drawn = new Endings();
  const all = await cardAxes(); // before there is a key that moves one
  const axes = h("div.row.wrap", { role: "radiogroup", ariaLabel: t("form.axis") });
  const fields = FIELDS.map(([name, text, value]) =>
    h("input.field.number", {
      ariaLabel: t(text),
      value: kept[name] ?? value,
      inputMode: "decimal",
      autocomplete: "off",
      data: { field: name },
    }),
  );
  const integral = h("input", { type: "checkbox", checked: true });
  const store = h("input", { type: "checkbox" });
  const measure = keyOf("tune.measure", () => void onMeasure(), ".danger");
  const step = keyOf("tune.step", () => void onStep(), ".danger");
  const apply = keyOf("tune.apply", () => void onApply(), ".danger", { disabled: true });
  const state = h("p.hint", { role: "status" });
  const facts = h("div.stack", {});
  const sliders = h("div.stack.tune-sliders", {});
  const keptHost = h("div.stack.tune-measurements", {});
  const tabs = h("div.row.wrap.tune-tabs", { role: "radiogroup", ariaLabel: t(TEXTS.view) });
  const legend = h("div.tune-legend", {});
  const columns = CHARTS.map((name) => h("section.tune-column", { ariaLabel: t(TEXTS[name]), data: { part: name } }));
  const [bode, made, simulation] = columns;
  const compared = h("div.tune-compared.scroll", { tabIndex: 0, data: { part: "table" } });
  const view = h("div.tune-view", {}, tabs, legend, h("div.tune-charts", {}, ...columns), compared);
  head.append(axes, measure, step, apply);
  host.append(
    h(
      "div.tune.grow",
      {},
      h(
        "div.stack.scroll.tune-side",
        { tabIndex: 0 },
        ...FIELDS.map(([, text], n) => h("label.row", {}, h("span.grow", {}, t(text)), fields[n])),
        h("label.check", {}, integral, t(TEXTS.integral)),
        h("label.check", {}, store, t("gain.store")),
        state,
        facts,
        keptHost,
        sliders,
      ),
      view,
    ),
  );
  let axis = all[0];
  /** @type {any} */
  let found = null;
  /** @type {import("../tuning/sets.js").GainSets | null} */
  let gains = null;
  /** @type {{ made: any, former: any, set: number } | null} */
  let trial = null;
  let measuredAt = { at: "", set: 0 };
  let shownView = kept.view ?? "bode";
  let isMoving = false;
  const measurements = keptMeasurements(keptHost, present, draw, endings);

  /** @param {import("../../core/card_axes.js").CardAxis} chosen */
  async function choose(chosen) {
    if (isMoving) return;
    axis = chosen;
    fill(
      axes,
      ...all.map((each) =>
        h(
          "button.key",
          { type: "button", role: "radio", ariaChecked: String(each === axis), onclick: () => void choose(each) },
          each.title,
        ),
      ),
    );
    trial = null;
    show(null);
    gains?.end();
    gains = null;
    const shownSets = await gainSliders(sliders, chosen, () => store.checked && chosen.isMachines);
    if (axis === chosen) gains = shownSets;
    else shownSets.end(); // another axis was chosen meanwhile
  }

  /** The present measurement as it is kept; null without one. */
  function present() {
    if (!found) return null;
    return keptOf(found, { axis: axis.name, ...measuredAt, trial: trial && { ...trial.made, set: trial.set } });
  }

  /** @param {string} name */
  function look(name) {
    shownView = name;
    args();
    drawTabs();
  }

  /** The keys of the views; where all charts fit beside each other, one key is for all of them. */
  function drawTabs() {
    const isWide = view.clientWidth >= WIDE;
    const now = shownView === "table" ? "table" : isWide ? "charts" : shownView === "charts" ? "bode" : shownView;
    view.dataset.view = now;
    view.classList.toggle("is-wide", isWide);
    fill(
      tabs,
      ...VIEWS.filter((name) => name === "table" || (name === "charts") === isWide).map((name) =>
        h(
          "button.key",
          { type: "button", role: "radio", ariaChecked: String(name === now), onclick: () => look(name) },
          t(TEXTS[name]),
        ),
      ),
    );
  }

  /** Draw measurement, step and what is kept. */
  function draw() {
    drawn.end();
    const over = measurements.shown();
    drawn.add(drawTuning({ bode, step: made, simulation, legend }, found, trial, over));
    const loops = [
      ...columnsOf(found),
      ...over.map(({ name, ink, tuning }) => ({ title: name, ink, loop: tuning.present, about: tuning })),
    ];
    fill(compared, loops.length ? tableOf(loops) : h("p.hint", {}, t(TEXTS.noTable)));
  }

  /** @param {any} advice */
  function show(advice) {
    found = advice;
    apply.disabled = !advice?.proposed;
    measurements.mayKeep(Boolean(advice));
    fill(facts, ...(advice ? factsOf(advice) : []));
    draw();
  }

  /** The fields as arguments; an empty one is left out. */
  function args() {
    /** @type {Record<string, any>} */
    const given = { axis: axis.name, integral: integral.checked };
    for (const field of fields) {
      const text = field.value.trim().replace(",", ".");
      if (text) given[field.dataset.field ?? ""] = Number(text);
    }
    keep({ ...Object.fromEntries(fields.map((field) => [field.dataset.field, field.value])), view: shownView });
    return given;
  }

  /**
   * Have the axis moved; null where it was refused.
   * @param {string} command
   * @param {Record<string, any>} given
   */
  async function moved(command, given) {
    isMoving = true;
    measure.disabled = step.disabled = apply.disabled = true;
    setText(state, t(TEXTS.moving, { axis: axis.name }));
    const answer = await give(command, given);
    isMoving = false;
    measure.disabled = step.disabled = false;
    apply.disabled = !found?.proposed;
    setText(state, "");
    return answer;
  }

  async function onMeasure() {
    const given = args();
    const text = t(TEXTS.measureText, {
      axis: axis.name,
      amplitude: given.amplitude ?? 100,
      time: given.time_s ?? LONGEST_S,
    });
    if (!mayMove() || !(await confirm(t("tune.measure"), text, t("tune.measure")))) return;
    const advice = await moved("tune.measure", given);
    await gains?.refresh();
    if (!advice) return;
    measuredAt = { at: new Date().toISOString(), set: gains?.current() ?? 0 };
    show(advice);
    report(advice.refusal ? t(TEXTS.nothing, { why: advice.refusal }) : t(TEXTS.done, { axis: axis.name }));
  }

  async function onStep() {
    const { amplitude = 100 } = args();
    const text = t(TEXTS.stepText, { axis: axis.name, amplitude });
    if (!mayMove() || !(await confirm(t("tune.step"), text, t("tune.step")))) return;
    const answer = await moved("tune.step", { axis: axis.name, amplitude });
    if (!answer) return;
    await drawStep(answer);
    const { overshoot_percent: overshoot, rise_s: rise, settling_s: settling } = answer.figures;
    report(
      t(TEXTS.stepped, { axis: axis.name, overshoot: shown(overshoot), rise: inMs(rise), settling: inMs(settling) }),
    );
  }

  /**
   * Draw a step that the axis has made, and the one before it.
   * @param {any} answer
   */
  async function drawStep(answer) {
    await gains?.refresh();
    trial = { made: answer, former: trial?.made.measured ?? null, set: gains?.current() ?? 0 };
    draw();
  }

  async function onApply() {
    const { overshoot_percent: overshoot } = found.proposed.figures;
    const text = t(TEXTS.applyText, {
      axis: axis.name,
      overshoot: shown(overshoot),
      gains:
        GAINS.filter((word) => found.proposed.gains[word] || found.present.gains[word])
          .map((word) => `${word} ${shown(found.proposed.gains[word])}`)
          .join(", ") + filterText(found.proposed),
    });
    const worse = worseOf(found).map(([, said]) => said);
    const question = [...worse, text].join("\n\n");
    if (!mayMove() || !(await confirm(t("tune.apply"), question, t("tune.apply")))) return;
    const answer = await moved("tune.apply", { axis: axis.name, store: store.checked && axis.isMachines });
    await gains?.refresh();
    if (!answer) return;
    await drawStep(answer);
    report(t(TEXTS.applied, { axis: axis.name }));
  }

  endings.add(
    () => drawn.end(),
    () => gains?.end(),
    () => {
      // The pane that watches the motion has gone.
      if (isMoving && link.isOpen.value) void link.command("stop.hold").catch(() => {});
    },
    model.tuned.watch((progress) => {
      if (progress && isMoving && progress.done > 0)
        setText(state, t(TEXTS.reading, { done: progress.done, count: progress.count }));
    }),
  );
  const sizes = new ResizeObserver(drawTabs);
  sizes.observe(view);
  document.documentElement.addEventListener("theme", draw);
  endings.add(
    () => sizes.disconnect(),
    () => document.documentElement.removeEventListener("theme", draw),
  );
  drawTabs();
  await Promise.all([choose(axis), measurements.read()]);
  return () => endings.end();
}
