// Charts of a measured axis: record, predicted steps, magnitude, phase and coherence, margins marked.
import { plain } from "../../core/format.js";
import { t } from "../../core/texts.js";
import { h } from "../../core/dom.js";
import { uPlot } from "../../../vendor/uplot.js";

const [LOWEST, HIGHEST] = [130, 220]; // pixels
const BESIDE = 64; // title and legend of a chart
const INK = { measured: "#1f77b4", modelled: "#d62758", setpoint: "#8a8a8a", present: "#e07b00", proposed: "#2ca02c" };
const FULL_DEG = 180;
const SPACE = 22; // pixels from one line of the grid to the next, at least

/**
 * @typedef {{ label: string, ink: keyof typeof INK, x: number[], y: number[], isDots?: boolean,
 *   dash?: number[] }} Curve
 * @typedef {{ at: number, from: number, to: number, ink: keyof typeof INK }} Mark
 *
 * @typedef {object} Looks
 * @property {[number, number]} [log] x is a logarithmic scale with these ends
 * @property {[number, number]} [range] of y
 * @property {number[]} [incrs] what lines of the grid may be apart in y
 * @property {number} [level] a line across, from which margins are read
 * @property {Mark[]} [marks]
 */

/**
 * Draw everything of an answer of `tune.measure`; returns the function that ends the charts.
 * @param {HTMLElement} host
 * @param {any} found
 */
export function drawTuning(host, found) {
  const { measured, modelled, present, proposed, bode } = found;
  const loops = /** @type {["present" | "proposed", any][]} */ (
    [
      ["present", present],
      ["proposed", proposed],
    ].filter(([, loop]) => loop)
  );
  const record = [
    { label: t("tune.setpoint"), ink: "setpoint", x: measured.time_s, y: measured.setpoint_cnt },
    { label: t("tune.measured"), ink: "measured", x: measured.time_s, y: measured.actual_cnt },
    { label: t("tune.modelled"), ink: "modelled", x: modelled.time_s, y: modelled.actual_cnt, dash: [4, 3] },
  ];
  const steps = [
    { label: t("tune.setpoint"), ink: "setpoint", x: present.step.time_s, y: present.step.setpoint_cnt },
    ...loops.map(([name, loop]) => ({
      label: t(`tune.${name}`),
      ink: name,
      x: loop.step.time_s,
      y: loop.step.actual_cnt,
      dash: name === "present" ? [6, 3] : undefined,
    })),
  ];
  const curves = (/** @type {"magnitude_db" | "phase_deg"} */ what) => [
    { label: t("tune.motor"), ink: "measured", x: bode.measured.frequency_hz, y: bode.measured[what], isDots: true },
    { label: t("tune.model"), ink: "modelled", x: bode.frequency_hz, y: bode.motor[what], dash: [4, 3] },
    ...loops.map(([name]) => ({
      label: t(`tune.${name}`),
      ink: name,
      x: bode.frequency_hz,
      y: bode[name][what],
      dash: name === "present" ? [6, 3] : undefined,
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
  const coherence = [
    { label: t("tune.coherence"), ink: "measured", x: bode.measured.frequency_hz, y: bode.measured.coherence },
  ];
  const log = /** @type {[number, number]} */ ([
    bode.frequency_hz[0],
    Math.max(bode.frequency_hz.at(-1), ...gains.map(({ at }) => at)),
  ]); // the same for all three
  const ends = /** @type {[string, string, any[], Looks][]} */ ([
    [t("tune.record"), "s", record, {}],
    [t("tune.steps"), "s", steps, {}],
    [t("tune.magnitude"), "Hz", curves("magnitude_db"), { log, marks: gains, level: 0, incrs: [20, 40, 60, 100] }],
    [t("tune.phase"), "Hz", curves("phase_deg"), { log, marks: phases, level: -FULL_DEG, incrs: [45, 90, 180, 360] }],
    [t("tune.coherence"), "Hz", coherence, { log, range: [0, 1.05], incrs: [0.2, 0.5, 1] }],
  ]).map(([title, unit, list, looks]) => chart(host, title, unit, list, looks));
  return () => ends.forEach((end) => end());
}

/**
 * One chart; the function that ends it.
 * @param {HTMLElement} host
 * @param {string} title
 * @param {string} unit of x
 * @param {Curve[]} curves
 * @param {Looks} [looks]
 */
export function chart(host, title, unit, curves, { log, range, incrs, level, marks = [] } = {}) {
  const place = h("figure.tune-chart", { role: "img", ariaLabel: title }, h("figcaption", {}, title));
  host.append(place);
  const size = () => ({
    width: Math.max(200, place.clientWidth),
    height: Math.max(LOWEST, Math.min(HIGHEST, (host.parentElement?.clientHeight ?? 0) / 2 - BESIDE)),
  });
  const style = getComputedStyle(place);
  const axis = {
    stroke: style.color,
    grid: { stroke: style.borderColor, width: 1 },
    ticks: { stroke: style.borderColor },
  };
  const value = (/** @type {any} */ _plot, /** @type {any} */ number) =>
    number === null || number === undefined ? "\u2013" : plain(number, 3);
  const series = curves.map(({ label, ink, isDots, dash }) => ({
    label,
    stroke: INK[ink],
    width: isDots ? 0 : 1.6,
    dash,
    spanGaps: true,
    value,
    points: { show: Boolean(isDots), size: 4, fill: INK[ink] },
  }));
  const data = /** @type {any} */ (uPlot).join(curves.map(({ x, y }) => [x, y]));
  const ends = [data[0][0], data[0].at(-1)];
  const whole = (/** @type {any} */ _plot, /** @type {number} */ min, /** @type {number} */ max) =>
    min === ends[0] && max === ends[1] ? log : [min, max]; // else dragged over
  const plot = new uPlot(
    /** @type {any} */ ({
      ...size(),
      cursor: { drag: { x: true, y: false } },
      scales: { x: { time: false, distr: log ? 3 : 1, range: log && whole }, y: { range } },
      axes: [
        { ...axis, label: unit, labelSize: 18, size: 32 },
        { ...axis, size: 54, space: SPACE, incrs },
      ],
      series: [{ label: unit, value }, ...series],
      hooks: {
        drawAxes: [
          (/** @type {any} */ one) => {
            if (level !== undefined) drawLevel(one, level, style.color);
          },
        ],
        draw: [(/** @type {any} */ one) => marks.forEach((mark) => drawMark(one, mark))],
      },
    }),
    data,
    place,
  );
  const sizes = new ResizeObserver(() => plot.setSize(size()));
  sizes.observe(place);
  return () => {
    sizes.disconnect();
    plot.destroy();
    place.remove();
  };
}

/**
 * A line across the chart.
 * @param {any} plot
 * @param {number} level
 * @param {string} ink
 */
function drawLevel({ ctx, bbox, valToPos }, level, ink) {
  const y = valToPos(level, "y", true);
  if (y < bbox.top || y > bbox.top + bbox.height) return;
  ctx.save();
  ctx.strokeStyle = ink;
  ctx.lineWidth = devicePixelRatio;
  ctx.beginPath();
  ctx.moveTo(bbox.left, y);
  ctx.lineTo(bbox.left + bbox.width, y);
  ctx.stroke();
  ctx.restore();
}

/**
 * A margin as an upright line with ends.
 * @param {any} plot
 * @param {Mark} mark
 */
function drawMark(plot, { at, from, to, ink }) {
  const [x, y0, y1] = [plot.valToPos(at, "x", true), plot.valToPos(from, "y", true), plot.valToPos(to, "y", true)];
  const pen = plot.ctx;
  pen.save();
  pen.strokeStyle = INK[ink];
  pen.lineWidth = 2.5 * devicePixelRatio;
  pen.beginPath();
  for (const y of [y0, y1]) {
    pen.moveTo(x - 5 * devicePixelRatio, y);
    pen.lineTo(x + 5 * devicePixelRatio, y);
  }
  pen.moveTo(x, y0);
  pen.lineTo(x, y1);
  pen.stroke();
  pen.restore();
}
