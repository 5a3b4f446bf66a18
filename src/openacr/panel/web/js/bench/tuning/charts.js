// Charts of a measured axis, in three columns: Bode plot with margins and coherence, the step it made, and what is
// computed. Kept measurements are drawn over them.
import { t } from "../../core/texts.js";
import { h } from "../../core/dom.js";
import { chart, INK, sign } from "./plot.js";

const FULL_DEG = 180;

const TEXTS = {
  trial: { en: "Step, pulses", de: "Sprung, Pulse" },
  output: { en: "Output of the step, V", de: "Ausgang beim Sprung, V" },
  predicted: { en: "predicted", de: "vorhergesagt" },
  former: { en: "before", de: "zuvor" },
  noStep: {
    en: "STEP moves the axis by a step and draws it here.",
    de: "SPRUNG bewegt die Achse um einen Sprung und zeichnet ihn hier.",
  },
  noSweep: { en: "MEASURE sweeps the axis and draws it here.", de: "MESSEN regt die Achse an und zeichnet es hier." },
};

/**
 * @typedef {import("./plot.js").Curve} Curve
 * @typedef {import("./plot.js").Looks} Looks
 * @typedef {{ name: string, ink: string, tuning: import("./kept_data.js").Tuning }} Shown a kept measurement
 * @typedef {[string, string, Curve[], Looks]} Chart title, unit of x
 */

/**
 * Draw what was measured of an axis; returns the function that ends the charts.
 * @param {{ bode: HTMLElement, step: HTMLElement, simulation: HTMLElement, legend: HTMLElement }} places
 * @param {any} found an answer of `tune.measure`, or null
 * @param {{ made: any, former: any } | null} trial an answer of `tune.step`, and the step before it
 * @param {Shown[]} kept
 */
export function drawTuning(places, found, trial, kept) {
  const simulated = found || kept.length ? simulationCharts(found, kept) : [];
  const columns = /** @type {[HTMLElement, Chart[], import("../../core/texts.js").Text][]} */ ([
    [places.bode, found || kept.length ? bodeCharts(found, kept) : [], TEXTS.noSweep],
    [places.step, stepCharts(trial, kept), TEXTS.noStep],
    [places.simulation, simulated, TEXTS.noSweep],
  ]);
  const ends = columns.flatMap(([place, charts, without]) => {
    place.replaceChildren(...(charts.length ? [] : [h("p.hint", {}, t(without))]));
    return charts.map(([title, unit, curves, looks]) => chart(place, title, unit, curves, looks));
  });
  places.legend.replaceChildren(...legendOf(columns.flatMap(([, charts]) => charts.flatMap(([, , curves]) => curves))));
  return () => ends.forEach((end) => end());
}

/** What each colour is, once. @param {Curve[]} curves */
function legendOf(curves) {
  const names = new Map(curves.map((curve) => [curve.label, curve]));
  return [...names.values()].map(({ label, ink, dash, isDots }) =>
    h("span.tune-name", {}, sign(INK[ink] ?? ink, isDots ? "dotted" : dash ? "dashed" : "solid"), label),
  );
}

/** @param {any} found @returns {["present" | "proposed", any][]} */
function loopsOf(found) {
  const both = /** @type {["present" | "proposed", any][]} */ ([
    ["present", found?.present],
    ["proposed", found?.proposed],
  ]);
  return both.filter(([, loop]) => loop);
}

/**
 * @param {any} found
 * @param {Shown[]} kept
 * @returns {Chart[]}
 */
function bodeCharts(found, kept) {
  const loops = loopsOf(found);
  const bode = found?.bode;
  const curves = (/** @type {"magnitude_db" | "phase_deg"} */ what) => [
    ...(bode
      ? [
          {
            label: t("tune.motor"),
            ink: "measured",
            x: bode.measured.frequency_hz,
            y: bode.measured[what],
            isDots: true,
          },
          { label: t("tune.model"), ink: "modelled", x: bode.frequency_hz, y: bode.motor[what], dash: [4, 3] },
        ]
      : []),
    ...loops.map(([name]) => ({
      label: t(`tune.${name}`),
      ink: name,
      x: bode.frequency_hz,
      y: bode[name][what],
      dash: name === "present" ? [6, 3] : undefined,
    })),
    ...kept.map(({ name, ink, tuning }) => ({
      label: name,
      ink,
      x: tuning.bode.frequency_hz,
      y: tuning.bode.present[what],
    })),
  ];
  const gains = loops
    .filter(([, { margins }]) => margins.gain_db !== null)
    .map(([ink, { margins }]) => ({ at: margins.gain_at_hz, from: -margins.gain_db, to: 0, ink }));
  const phases = loops
    .filter(([, { margins }]) => margins.phase_deg !== null)
    .map(([ink, { margins }]) => ({
      at: margins.crossover_hz,
      from: -FULL_DEG,
      to: margins.phase_deg - FULL_DEG,
      ink,
    }));
  const responses = [
    ...(bode ? [{ label: t("tune.coherence"), ink: "measured", of: bode.measured }] : []),
    ...kept.map(({ name, ink, tuning }) => ({ label: name, ink, of: tuning.bode.measured })),
  ];
  const coherence = responses.map(({ label, ink, of }) => ({
    label,
    ink,
    x: of.frequency_hz ?? [],
    y: of.coherence ?? [],
  }));
  const along = curves("phase_deg").flatMap(({ x }) => [x[0], x.at(-1) ?? x[0]]);
  const log = /** @type {[number, number]} */ ([Math.min(...along), Math.max(...along, ...gains.map(({ at }) => at))]);
  return [
    [t("tune.magnitude"), "Hz", curves("magnitude_db"), { log, marks: gains, level: 0, incrs: [20, 40, 60, 100] }],
    [t("tune.phase"), "Hz", curves("phase_deg"), { log, marks: phases, level: -FULL_DEG, incrs: [45, 90, 180, 360] }],
    [t("tune.coherence"), "Hz", coherence, { log, range: [0, 1.05], incrs: [0.2, 0.5, 1] }],
  ];
}

/**
 * @param {{ made: any, former: any } | null} trial
 * @param {Shown[]} kept
 * @returns {Chart[]}
 */
function stepCharts(trial, kept) {
  const made = trial?.made;
  const tried = kept.flatMap(({ name, ink, tuning }) =>
    tuning.trial ? [{ name, ink, step: tuning.trial.measured }] : [],
  );
  if (!made && !tried.length) return [];
  const { measured, predicted } = made ?? {};
  const setpoint = measured ?? tried[0].step;
  const curves = [
    { label: t("tune.setpoint"), ink: "setpoint", x: setpoint.time_s, y: setpoint.setpoint_cnt },
    measured && { label: t("tune.measured"), ink: "measured", x: measured.time_s, y: measured.actual_cnt },
    predicted && {
      label: t(TEXTS.predicted),
      ink: "modelled",
      x: predicted.time_s,
      y: predicted.actual_cnt,
      dash: [4, 3],
    },
    trial?.former && {
      label: t(TEXTS.former),
      ink: "present",
      x: trial.former.time_s,
      y: trial.former.actual_cnt,
      dash: [6, 3],
    },
    ...tried.map(({ name, ink, step }) => ({ label: name, ink, x: step.time_s, y: step.actual_cnt })),
  ];
  const output = measured && [
    { label: t("tune.measured"), ink: "measured", x: measured.time_s, y: measured.output_v },
    predicted && {
      label: t(TEXTS.predicted),
      ink: "modelled",
      x: predicted.time_s,
      y: predicted.output_v,
      dash: [4, 3],
    },
  ];
  return /** @type {Chart[]} */ ([
    [t(TEXTS.trial), "s", curves.filter(Boolean), {}],
    ...(output ? [[t(TEXTS.output), "s", output.filter(Boolean), {}]] : []),
  ]);
}

/**
 * @param {any} found
 * @param {Shown[]} kept
 * @returns {Chart[]}
 */
function simulationCharts(found, kept) {
  const first = found?.present.step ?? kept[0].tuning.present.step;
  const steps = [
    { label: t("tune.setpoint"), ink: "setpoint", x: first.time_s, y: first.setpoint_cnt },
    ...loopsOf(found).map(([name, loop]) => ({
      label: t(`tune.${name}`),
      ink: name,
      x: loop.step.time_s,
      y: loop.step.actual_cnt,
      dash: name === "present" ? [6, 3] : undefined,
    })),
    ...kept.map(({ name, ink, tuning: { present } }) => ({
      label: name,
      ink,
      x: present.step.time_s,
      y: present.step.actual_cnt,
    })),
  ];
  if (!found) return [[t("tune.steps"), "s", steps, {}]];
  const { measured, modelled } = found;
  const record = [
    { label: t("tune.setpoint"), ink: "setpoint", x: measured.time_s, y: measured.setpoint_cnt },
    { label: t("tune.measured"), ink: "measured", x: measured.time_s, y: measured.actual_cnt },
    { label: t("tune.modelled"), ink: "modelled", x: modelled.time_s, y: modelled.actual_cnt, dash: [4, 3] },
  ];
  return [
    [t("tune.steps"), "s", steps, {}],
    [t("tune.record"), "s", record, {}],
  ];
}
