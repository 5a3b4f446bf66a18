// TUNING: an axis is measured, its motor and margins are shown, gains proposed, predicted, and set when confirmed.
import { give, link, model, report } from "../../core/app.js";
import { cardAxes } from "../../core/card_axes.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { confirm } from "../../frame/dialog.js";
import { mayMove } from "../../motion/actions.js";
import { chart, drawTuning } from "../tuning/charts.js";
import { gainSliders } from "../tuning/sliders.js";

const TEXTS = {
  amplitude: { en: "Amplitude, pulses", de: "Amplitude, Pulse" },
  lowest: { en: "Lowest frequency, Hz", de: "Tiefste Frequenz, Hz" },
  highest: { en: "Highest frequency, Hz", de: "H\u00f6chste Frequenz, Hz" },
  time: { en: "Time, s (empty: what fits)", de: "Dauer, s (leer: was passt)" },
  swept: { en: "Measured for {time} s", de: "{time} s lang gemessen" },
  worse: {
    en: "Worse than with the present gains: {name} {after} instead of {before}",
    de: "Schlechter als mit den jetzigen Werten: {name} {after} statt {before}",
  },
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
  facts: {
    en: "Motor: {accel} pulses/s\u00b2 per V, rate {rate} /s, friction {friction} V, offset {offset} V, delay {delay} servo periods",
    de: "Motor: {accel} Pulse/s\u00b2 je V, Rate {rate} /s, Reibung {friction} V, Versatz {offset} V, Verzug {delay} Servotakte",
  },
  sure: {
    en: "{error} % of the response is unexplained, coherence {coherence}",
    de: "{error} % der Antwort sind nicht erkl\u00e4rt, Koh\u00e4renz {coherence}",
  },
  unsure: {
    en: "Not sure: {error} % of the response is unexplained, coherence {coherence}",
    de: "Nicht sicher: {error} % der Antwort sind nicht erkl\u00e4rt, Koh\u00e4renz {coherence}",
  },
  limited: { en: "Faster is barred: {why}", de: "Schneller geht es nicht: {why}" },
  crossover: { en: "Crossover, Hz", de: "Durchtritt, Hz" },
  gainMargin: { en: "Gain margin, dB", de: "Amplitudenreserve, dB" },
  bandwidth: { en: "Bandwidth, Hz", de: "Bandbreite, Hz" },
  resonance: {
    en: "Resonance: {hz} Hz \u00b1 {spread}, antiresonance {anti} Hz, damping {damping}, load {ratio} of the motor",
    de: "Resonanz: {hz} Hz \u00b1 {spread}, Antiresonanz {anti} Hz, D\u00e4mpfung {damping}, Last das {ratio}-fache des Motors",
  },
  rigid: { en: "Resonance: {why}", de: "Resonanz: {why}" },
  notch: { en: "NOTCH, Hz", de: "NOTCH, Hz" },
  width: { en: "NOTCH width, Hz", de: "NOTCH, Breite, Hz" },
  lopass: { en: "LOPASS, Hz", de: "LOPASS, Hz" },
  swing: { en: "Load swings after a step, pulses", de: "Last schwingt nach einem Sprung, Pulse" },
  overshoot: { en: "Overshoot of a step, %", de: "\u00dcberschwingen eines Sprungs, %" },
  predicted: { en: "predicted", de: "vorhergesagt" },
  stepText: {
    en: "Axis {axis} moves now: by {amplitude} pulses and back, at once. Is it free to move? STOP ends it.",
    de: "Achse {axis} bewegt sich jetzt: um {amplitude} Pulse und zur\u00fcck, auf einmal. Ist ihr Weg frei? STOP beendet es.",
  },
  former: { en: "before", de: "zuvor" },
  stepped: {
    en: "Axis {axis}: overshoot {overshoot} %, rise {rise} ms, settling {settling} ms",
    de: "Achse {axis}: \u00dcberschwingen {overshoot} %, Anstieg {rise} ms, Einschwingen {settling} ms",
  },
  trial: { en: "Step, pulses", de: "Sprung, Pulse" },
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
const GAINS = ["PGAIN", "IGAIN", "ILIMIT", "DGAIN", "FFVEL", "FFACC"];

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const drawn = new Endings();
  const tried = new Endings();
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
  const charts = h("div.tune-charts", {});
  const sliders = h("div.stack.tune-sliders", {});
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
        sliders,
      ),
      h("div.scroll.tune-view", { tabIndex: 0 }, charts),
    ),
  );
  let axis = all[0];
  /** @type {any} */
  let found = null;
  /** @type {{ reload: () => Promise<void> } | null} */
  let gains = null;
  /** @type {any} */
  let former = null; // step
  let isMoving = false;

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
    show(null);
    former = null;
    gains = await gainSliders(sliders, chosen, () => store.checked && chosen.isMachines);
  }

  /** @param {any} advice */
  function show(advice) {
    found = advice;
    drawn.end();
    tried.end();
    fill(charts);
    apply.disabled = !advice?.proposed;
    fill(facts, ...(advice ? [table(advice)] : []));
    if (advice) drawn.add(drawTuning(charts, advice));
  }

  /** The fields as arguments; an empty one is left out. */
  function args() {
    /** @type {Record<string, any>} */
    const given = { axis: axis.name, integral: integral.checked };
    for (const field of fields) {
      const text = field.value.trim().replace(",", ".");
      if (text) given[field.dataset.field ?? ""] = Number(text);
    }
    keep(Object.fromEntries(fields.map((field) => [field.dataset.field, field.value])));
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
    if (!advice) return;
    show(advice);
    report(advice.refusal ? t(TEXTS.nothing, { why: advice.refusal }) : t(TEXTS.done, { axis: axis.name }));
  }

  async function onStep() {
    const { amplitude = 100 } = args();
    const text = t(TEXTS.stepText, { axis: axis.name, amplitude });
    if (!mayMove() || !(await confirm(t("tune.step"), text, t("tune.step")))) return;
    const answer = await moved("tune.step", { axis: axis.name, amplitude });
    if (!answer) return;
    drawStep(answer);
    const { overshoot_percent: overshoot, rise_s: rise, settling_s: settling } = answer.figures;
    report(
      t(TEXTS.stepped, { axis: axis.name, overshoot: shown(overshoot), rise: inMs(rise), settling: inMs(settling) }),
    );
  }

  /**
   * Draw a step that the axis has made, and the one before it.
   * @param {any} answer
   */
  function drawStep({ measured, predicted }) {
    tried.end();
    const curves = [
      { label: t("tune.setpoint"), ink: "setpoint", x: measured.time_s, y: measured.setpoint_cnt },
      { label: t("tune.measured"), ink: "measured", x: measured.time_s, y: measured.actual_cnt },
      predicted && {
        label: t(TEXTS.predicted),
        ink: "modelled",
        x: predicted.time_s,
        y: predicted.actual_cnt,
        dash: [4, 3],
      },
      former && { label: t(TEXTS.former), ink: "present", x: former.time_s, y: former.actual_cnt, dash: [6, 3] },
    ];
    tried.add(chart(charts, t(TEXTS.trial), "s", curves.filter(Boolean)));
    former = measured;
  }

  async function onApply() {
    const { overshoot_percent: overshoot } = found.proposed.figures;
    const text = t(TEXTS.applyText, {
      axis: axis.name,
      overshoot: shown(overshoot),
      gains:
        GAINS.map((word) => `${word} ${shown(found.proposed.gains[word])}`).join(", ") + filterText(found.proposed),
    });
    const worse = worseOf(found).map(([, said]) => said);
    const question = [...worse, text].join("\n\n");
    if (!mayMove() || !(await confirm(t("tune.apply"), question, t("tune.apply")))) return;
    const answer = await moved("tune.apply", { axis: axis.name, store: store.checked && axis.isMachines });
    await gains?.reload();
    if (!answer) return;
    drawStep(answer);
    report(t(TEXTS.applied, { axis: axis.name }));
  }

  endings.add(
    () => drawn.end(),
    () => tried.end(),
    () => {
      // The pane that watches the motion has gone.
      if (isMoving && link.isOpen.value) void link.command("stop.hold").catch(() => {});
    },
    model.tuned.watch((progress) => {
      if (progress && isMoving && progress.done > 0)
        setText(state, t(TEXTS.reading, { done: progress.done, count: progress.count }));
    }),
  );
  await choose(axis);
  return () => endings.end();
}

/**
 * Motor, certainty, gains and margins: present and proposed side by side.
 * @param {any} advice
 */
function table(advice) {
  const loops = [advice.present, advice.proposed].filter(Boolean);
  const { motor } = advice;
  const rows = [
    ...GAINS.map((word) => [word, (/** @type {any} */ loop) => shown(loop.gains[word])]),
    ...filterRows(loops),
    [t(TEXTS.crossover), (/** @type {any} */ loop) => shown(loop.margins.crossover_hz)],
    [t(TEXTS.margin), (/** @type {any} */ loop) => shown(loop.margins.phase_deg)],
    [t(TEXTS.gainMargin), (/** @type {any} */ loop) => shown(loop.margins.gain_db)],
    [t(TEXTS.bandwidth), (/** @type {any} */ loop) => shown(loop.margins.bandwidth_hz)],
    [t(TEXTS.overshoot), (/** @type {any} */ loop) => shown(loop.figures.overshoot_percent)],
    ...(advice.resonance.resonance_hz === null
      ? []
      : [[t(TEXTS.swing), (/** @type {any} */ loop) => shown(loop.figures.vibration_cnt)]]),
  ];
  return h(
    "div.stack",
    {},
    h(
      "p.tune-motor",
      {},
      t(TEXTS.facts, {
        accel: shown(motor.accel_per_volt),
        rate: shown(motor.rate_per_s),
        friction: shown(motor.coulomb_accel / motor.accel_per_volt),
        offset: shown(motor.offset_v),
        delay: shown(motor.delay_tk),
      }),
    ),
    h("p.tune-resonance", {}, resonance(advice.resonance)),
    h(
      "p",
      { className: advice.is_sure ? "hint" : "notice" },
      t(advice.is_sure ? TEXTS.sure : TEXTS.unsure, {
        error: shown(advice.error_percent),
        coherence: shown(advice.coherence),
      }),
    ),
    ...worseOf(advice).map(([name, said]) => h("p.notice", { data: { worse: name } }, said)),
    advice.time_s < LONGEST_S ? h("p.hint", {}, t(TEXTS.swept, { time: advice.time_s })) : null,
    advice.refusal || advice.limited_by
      ? h("p.hint", {}, advice.refusal || t(TEXTS.limited, { why: advice.limited_by }))
      : null,
    h(
      "table.grid.tune-table",
      {},
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", {}),
          ...loops.map((_loop, n) => h("th.number", {}, t(n ? "tune.proposed" : "tune.present"))),
        ),
      ),
      h(
        "tbody",
        {},
        ...rows.map(([name, cell]) =>
          h(
            "tr",
            {},
            h("th", { scope: "row" }, /** @type {string} */ (name)),
            ...loops.map((loop) => h("td.number", {}, /** @type {(loop: any) => string} */ (cell)(loop))),
          ),
        ),
      ),
    ),
  );
}

/**
 * What is predicted to become worse with the proposed gains: the name of each figure, and the sentence.
 * @param {any} advice
 * @returns {[string, string][]}
 */
function worseOf(advice) {
  return Object.entries(advice.worse).map(([name, [before, after]]) => [
    name,
    t(TEXTS.worse, {
      name: t(/** @type {any} */ (`tune.worse.${name}`)),
      before: name.endsWith("_s") ? inMs(before) : shown(before),
      after: name.endsWith("_s") ? inMs(after) : shown(after),
    }),
  ]);
}

/**
 * The resonance that was found, or up to where there is none.
 * @param {any} found
 */
function resonance({
  resonance_hz: hz,
  antiresonance_hz: anti,
  damping_ratio: damping,
  inertia_ratio: ratio,
  deviations,
  reason,
}) {
  if (hz === null) return t(TEXTS.rigid, { why: reason });
  return t(TEXTS.resonance, {
    hz: shown(hz),
    spread: Number(deviations.resonance_hz.toPrecision(1)),
    anti: shown(anti),
    damping: Number(damping.toPrecision(2)),
    ratio: Number(ratio.toPrecision(2)),
  });
}

/**
 * Rows of the filters, where one of the loops has any.
 * @param {any[]} loops
 * @returns {any[]}
 */
function filterRows(loops) {
  const words = /** @type {const} */ ([
    [TEXTS.lopass, "lopass_hz"],
    [TEXTS.notch, "notch_hz"],
    [TEXTS.width, "notch_width_hz"],
  ]);
  return words
    .filter(([, key]) => loops.some((loop) => loop.filters?.[key]))
    .map(([text, key]) => [t(text), (/** @type {any} */ loop) => shown(loop.filters?.[key] ?? null)]);
}

/** The filters of a loop as they are written in a question. @param {any} loop */
function filterText({ filters }) {
  if (!filters) return "";
  const notch = filters.notch_hz ? `, NOTCH (${shown(filters.notch_hz)},${shown(filters.notch_width_hz)})` : "";
  return `${filters.lopass_hz ? `, LOPASS ${shown(filters.lopass_hz)}` : ""}${notch}`;
}

/** @param {number | null} seconds */
function inMs(seconds) {
  return shown(seconds === null ? null : 1000 * seconds);
}

/** @param {number | null} value */
function shown(value) {
  return value === null ? "\u2013" : String(Number(value.toPrecision(4)));
}
