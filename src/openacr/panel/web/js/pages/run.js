// The page of `openacr run --plot x.html`: curves of axes, path, values, outputs and events on one time axis.
import { uPlot } from "../../vendor/uplot.js";
import { h } from "../core/dom.js";

const COLOR = Object.freeze({
  commanded: "#F3BE56",
  actual: "#0072B2",
  velocity: "#009E73",
  error: "#D55E00",
  strip: "#56B4E9",
  event: "#9A4A7C",
});
const WIDE = 520;
const PATH = 560;
const STRIP = 30; // height of the strip of an output
const MARGIN = 0.05; // of the range above and below curves

/** @type {any} */
const run = JSON.parse(document.getElementById("data")?.textContent ?? "{}");
/** @type {uPlot[]} */
const timed = []; // charts over time: they are zoomed together
/** @type {((time: number | null) => void)[]} */
const followers = []; // what shows the time under the mouse beside the charts
let view = [...run.span];

const short = (/** @type {number} */ value) => String(Number(value.toPrecision(7)));

/** The first index whose time is not before `time`. @param {number[]} times @param {number} time */
function indexAt(times, time) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Show a span of time everywhere. @param {number[]} span */
function zoom(span) {
  view = span;
  for (const chart of timed) chart.setScale("x", { min: span[0], max: span[1] });
  for (const follow of followers) follow(null);
}

/** Lowest and highest value with a margin. @param {number} low @param {number} high @returns {[number, number]} */
function widened(low, high) {
  if (!(low < high)) return [low - 1, high + 1];
  return [low - MARGIN * (high - low), high + MARGIN * (high - low)];
}

/** Numbered marks of the events, one for several that are too near to each other. @param {uPlot} chart */
function drawEvents(chart) {
  const pen = chart.ctx;
  const { left, top, width, height } = chart.bbox;
  const ratio = devicePixelRatio;
  pen.save();
  pen.lineWidth = ratio;
  pen.font = `${9 * ratio}px system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "alphabetic";
  /** @type {{ x: number, from: number, to: number }[]} */
  const groups = [];
  const apart = (14 + 14 * String(run.events.length).length) * ratio;
  run.events.forEach((/** @type {{ t: number }} */ event, /** @type {number} */ n) => {
    const x = chart.valToPos(event.t, "x", true);
    if (x < left - 0.5 || x > left + width + 0.5) return;
    pen.strokeStyle = COLOR.event;
    pen.setLineDash([3 * ratio, 2 * ratio]);
    pen.beginPath();
    pen.moveTo(x, top);
    pen.lineTo(x, top + height);
    pen.stroke();
    const last = groups.at(-1);
    if (last && x - last.x < apart) last.to = n + 1;
    else groups.push({ x, from: n + 1, to: n + 1 });
  });
  pen.setLineDash([]);
  for (const { x, from, to } of groups) {
    const label = from === to ? `${from}` : `${from}\u2013${to}`;
    const wide = (6 + 5.2 * label.length) * ratio;
    pen.fillStyle = COLOR.event;
    pen.fillRect(x - wide / 2, top, wide, 12 * ratio);
    pen.fillStyle = "#fff";
    pen.fillText(label, x, top + 9 * ratio);
  }
  pen.restore();
}

/**
 * @param {HTMLElement} parent
 * @param {{ scales?: object, draws?: ((chart: uPlot) => void)[], [option: string]: any }} options of uPlot; `draws`:
 *   what is drawn over the events
 * @param {any} data
 */
function timeChart(parent, { scales = {}, draws = [], ...options }, data) {
  const chart = new uPlot(
    /** @type {any} */ ({
      width: WIDE,
      height: 200,
      cursor: {
        y: false,
        sync: { key: "run", setSeries: false, scales: ["x", null] },
        drag: { x: true, y: false },
        points: { size: 6 },
        bind: {
          dblclick: () => () => {
            zoom([...run.span]);
            return null;
          },
        },
      },
      axes: [
        { size: 28 },
        { size: 68, values: (/** @type {uPlot} */ _chart, /** @type {number[]} */ values) => values.map(short) },
      ],
      ...options,
      scales: { x: { time: false, min: view[0], max: view[1] }, ...scales },
      hooks: {
        draw: [drawEvents, ...draws],
        setSelect: [
          (/** @type {uPlot} */ one) => {
            if (one.select.width < 4) return;
            zoom([one.posToVal(one.select.left, "x"), one.posToVal(one.select.left + one.select.width, "x")]);
          },
        ],
        setCursor: [
          (/** @type {uPlot} */ one) => {
            const left = one.cursor.left ?? -1;
            const time = left < 0 ? null : one.posToVal(left, "x");
            for (const follow of followers) follow(time);
          },
        ],
      },
    }),
    data,
    parent,
  );
  timed.push(chart);
  return chart;
}

/**
 * Curves of one panel: positions, a speed, an error, a value.
 * @param {HTMLElement} parent
 * @param {string} title
 * @param {string} unit
 * @param {any} data
 * @param {("commanded" | "actual" | "velocity" | "error")[]} names
 * @param {number} height
 */
function curves(parent, title, unit, data, names, height) {
  const series = names.map((name) => ({
    label: names.length > 1 ? name : title,
    stroke: COLOR[name],
    width: name === "commanded" ? 4 : 1.3,
    points: { show: false },
    value: (/** @type {uPlot} */ _chart, /** @type {number | null} */ value) =>
      value === null ? "\u2013" : `${short(value)} ${unit}`,
  }));
  const time = {
    label: "time",
    value: (/** @type {uPlot} */ _chart, /** @type {number | null} */ value) =>
      value === null ? "\u2013" : `${short(value)} s`,
  };
  timeChart(
    parent,
    {
      title: unit ? `${title} [${unit}]` : title,
      height,
      series: [time, ...series],
      scales: {
        y: {
          range: (/** @type {uPlot} */ _chart, /** @type {number} */ low, /** @type {number} */ high) =>
            widened(low ?? 0, high ?? 0),
        },
      },
    },
    [data.t, ...names.map((name) => data[name])],
  );
}

/** The outputs as strips. @param {HTMLElement} parent @param {{ title: string, on: [number, number][] }[]} bits */
function strips(parent, bits) {
  const draw = (/** @type {uPlot} */ chart) => {
    const pen = chart.ctx;
    const ratio = devicePixelRatio;
    const { left, top, width } = chart.bbox;
    pen.save();
    pen.beginPath();
    pen.rect(left, top, width, chart.bbox.height);
    pen.clip();
    pen.font = `${11 * ratio}px system-ui, sans-serif`;
    pen.textAlign = "left";
    pen.textBaseline = "alphabetic";
    bits.forEach(({ title, on }, row) => {
      pen.fillStyle = COLOR.strip;
      for (const [from, to] of on) {
        const [a, b] = [chart.valToPos(from, "x", true), chart.valToPos(to, "x", true)];
        pen.fillRect(a, top + (STRIP * row + 14) * ratio, Math.max(b - a, ratio), 12 * ratio);
      }
      pen.fillStyle = "#444";
      pen.fillText(title, left + 3 * ratio, top + (STRIP * row + 11) * ratio);
    });
    pen.restore();
  };
  timeChart(
    parent,
    {
      height: STRIP * bits.length + 60,
      legend: { show: false },
      draws: [draw],
      scales: { y: { range: [0, 1] } },
      axes: [{ size: 28 }, { size: 68, values: () => [], grid: { show: false }, ticks: { show: false } }],
      series: [{}, { points: { show: false } }],
    },
    [run.span, [null, null]],
  );
}

/** The path in the plane of a master, with equal scales. @param {HTMLElement} parent @param {any} path */
function plane(parent, path) {
  const reading = h("p.reading", {});
  const dot = h("div.dot", {});
  const ends = (/** @type {number[][]} */ lists) =>
    lists.flat().reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
  const [x, y] = [ends([path.cx, path.ax]), ends([path.cy, path.ay])];
  const half = (0.5 + 2 * MARGIN) * Math.max(x[1] - x[0], y[1] - y[0], 1e-9);
  const around = (/** @type {number[]} */ [low, high], share = 1) =>
    /** @type {[number, number]} */ ([(low + high) / 2 - half * share, (low + high) / 2 + half * share]);
  const line = (
    /** @type {uPlot} */ chart,
    /** @type {number[]} */ xs,
    /** @type {number[]} */ ys,
    /** @type {string} */ color,
    /** @type {number} */ wide,
  ) => {
    const pen = chart.ctx;
    pen.strokeStyle = color;
    pen.lineWidth = wide * devicePixelRatio;
    pen.lineJoin = "round";
    pen.beginPath();
    const last = indexAt(path.t, view[1]);
    for (let n = Math.max(0, indexAt(path.t, view[0]) - 1); n <= last; n++)
      pen.lineTo(chart.valToPos(xs[n], "x", true), chart.valToPos(ys[n], "y", true));
    pen.stroke();
  };
  const values = (/** @type {uPlot} */ _chart, /** @type {number[]} */ list) => list.map(short);
  const chart = new uPlot(
    {
      width: PATH,
      height: PATH,
      legend: { show: false },
      cursor: { show: false },
      axes: [
        { label: path.labels[0], size: 40, labelSize: 18, values },
        { label: path.labels[1], size: 60, labelSize: 18, values },
      ],
      scales: {
        x: { time: false, range: () => around(x) },
        y: { range: (/** @type {uPlot} */ one) => around(y, (one.bbox.height || 1) / (one.bbox.width || 1)) },
      },
      series: [{}, { points: { show: false } }],
      hooks: {
        draw: [
          (one) => {
            line(one, path.cx, path.cy, COLOR.commanded, 4);
            line(one, path.ax, path.ay, COLOR.actual, 1.3);
          },
        ],
      },
    },
    [around(x), [null, null]],
    parent,
  );
  chart.over.append(dot);
  parent.append(reading);
  followers.push((time) => {
    dot.hidden = time === null;
    if (time === null) {
      reading.textContent = "\u00a0";
      chart.redraw(false);
      return;
    }
    const n = indexAt(path.t, time);
    dot.style.transform = `translate(${chart.valToPos(path.ax[n], "x")}px, ${chart.valToPos(path.ay[n], "y")}px)`;
    reading.textContent = `${short(path.ax[n])}, ${short(path.ay[n])} at ${short(path.t[n])} s`;
  });
}

/** @param {string} name @param {string} title */
function section(name, title) {
  const place = h(`div.${name}`, {}, h("h2", {}, title));
  document.getElementById("main")?.append(place);
  return place;
}

document
  .querySelector("h1")
  ?.append(`${run.title}: ${short(Number((run.span[1] - run.span[0]).toPrecision(4)))} s simulated`);
for (const axis of run.axes) {
  const place = section("column", axis.title);
  curves(place, "position", axis.unit, axis, ["commanded", "actual"], 260);
  curves(place, "velocity", `${axis.unit}/s`, axis, ["velocity"], 170);
  curves(place, "following error", axis.unit, axis, ["error"], 170);
}
if (run.path) plane(section("path", run.path.title), run.path);
if (run.numbers.length) {
  const place = section("column", "watched");
  for (const one of run.numbers) curves(place, one.title, one.unit, one, ["actual"], 170);
}
if (run.bits.length) strips(section("column", "outputs and flags"), run.bits);
if (run.events.length)
  section("column", "events").append(
    h(
      "ol",
      {},
      ...run.events.map((/** @type {any} */ event) =>
        h("li", {}, `${short(Number(event.t.toFixed(4)))} s: ${event.text}`),
      ),
    ),
  );
if (!run.axes.length && !run.numbers.length) section("column", "no axis moved");
