// The whole record below the plot, with the part that is shown: it is dragged, resized at its edges, moved by keys.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { onTheme } from "../core/theme.js";
import { DIVISIONS, extremes, HALF } from "./scales.js";

const TEXTS = {
  label: {
    en: "Whole record: arrow keys move the part that is shown, + and - zoom, Home and End go to its ends, 0 shows all",
    de: "Ganze Aufzeichnung: Pfeiltasten verschieben den gezeigten Teil, + und - vergrößern oder verkleinern, Pos1 und Ende gehen zu den Enden, 0 zeigt alles",
  },
};
const EDGE = 8; // pixels around an edge
const LEAST = 6; // pixels of the window

/** @typedef {import("./long_record.js").LongRecord} LongRecord */

/**
 * What a drag moves: 0 the left edge, 1 the right one, "window" the part, "jump" to a place outside of it.
 * @param {number} x
 * @param {[number, number]} window pixels
 * @returns {0 | 1 | "window" | "jump"}
 */
export function gripOf(x, [left, right]) {
  if (Math.abs(x - left) <= EDGE && x < (left + right) / 2) return 0;
  if (Math.abs(x - right) <= EDGE) return 1;
  return x > left && x < right ? "window" : "jump";
}

/**
 * @param {LongRecord} record
 * @param {() => string[]} colors of the channels, each drawn over the whole height
 * @param {import("../core/signal.js").Endings} endings
 */
export function createOverview(record, colors, endings) {
  const canvas = h("canvas.scope-overview", {
    tabIndex: 0,
    role: "slider",
    ariaLabel: t(TEXTS.label),
    onkeydown: byKey,
    onpointerdown: grip,
    onpointermove: drag,
    onpointerup: drop,
    onpointercancel: drop,
    ondblclick: () => record.all(),
  });
  const sizes = new ResizeObserver(() => draw());
  sizes.observe(canvas);
  endings.add(onTheme(draw), () => sizes.disconnect());
  /** @type {{ what: 0 | 1 | "window" | "jump", time: number, from: number, to: number } | null} */
  let held = null;

  const span = () => Math.max(record.ms, record.times[1] - record.times[0]);
  const timeAt = (/** @type {number} */ x) => record.times[0] + (x / Math.max(1, canvas.clientWidth)) * span();
  const placeOf = (/** @type {number} */ time) => ((time - record.times[0]) / span()) * canvas.clientWidth;
  const ends = () => [record.view.from, record.view.from + DIVISIONS * record.view.step];

  /** @returns {[number, number]} */
  function window() {
    const [left, right] = ends().map(placeOf);
    return [left, Math.max(right, left + LEAST)];
  }

  /** @param {PointerEvent} event */
  function grip(event) {
    const what = gripOf(event.offsetX, window());
    const [from, to] = ends();
    if (what === "jump") record.pan(timeAt(event.offsetX) - (from + to) / 2);
    const [begin, end] = ends();
    held = { what, time: timeAt(event.offsetX), from: begin, to: end };
    canvas.setPointerCapture(event.pointerId);
  }

  /** @param {PointerEvent} event */
  function drag(event) {
    if (!held) {
      const what = gripOf(event.offsetX, window());
      canvas.style.cursor = typeof what === "number" ? "ew-resize" : "grab";
      return;
    }
    const by = timeAt(event.offsetX) - held.time;
    const least = DIVISIONS * record.ms;
    let { from, to } = held;
    if (held.what === 0) from = Math.min(from + by, to - least);
    else if (held.what === 1) to = Math.max(to + by, from + least);
    else [from, to] = [from + by, to + by];
    record.show({ from: Math.max(from, record.times[0]), step: (to - Math.max(from, record.times[0])) / DIVISIONS });
    if (held.what !== 0 && held.what !== 1) record.show({ from, step: (held.to - held.from) / DIVISIONS });
  }

  function drop() {
    held = null;
  }

  /** @param {KeyboardEvent} event */
  function byKey(event) {
    const { from, step } = record.view;
    const middle = from + HALF * step;
    const [first, last] = record.times;
    if (event.key === "ArrowLeft") record.pan(-step);
    else if (event.key === "ArrowRight") record.pan(step);
    else if (event.key === "PageUp") record.pan(-DIVISIONS * step);
    else if (event.key === "PageDown") record.pan(DIVISIONS * step);
    else if (event.key === "+" || event.key === "-") record.zoom(event.key === "+", middle);
    else if (event.key === "Home") record.show({ from: first, step });
    else if (event.key === "End") record.show({ from: last - DIVISIONS * step, step });
    else if (event.key === "0") record.all();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  function draw() {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    [canvas.width, canvas.height] = [width * devicePixelRatio, height * devicePixelRatio];
    const ctx = canvas.getContext("2d");
    if (!ctx) return;
    ctx.scale(devicePixelRatio, devicePixelRatio);
    const style = getComputedStyle(canvas);
    const { whole } = record;
    colors().forEach((color, channel) => {
      if (!whole?.low[channel]) return;
      const [low = 0, high = 1] = extremes([whole.low[channel], whole.high[channel]]);
      ctx.strokeStyle = color;
      ctx.beginPath();
      whole.low[channel].forEach((lowest, n) => {
        const x = placeOf((whole.first + n * whole.width) * record.ms);
        const y = (/** @type {number} */ value) => height * (0.92 - (0.84 * (value - low)) / (high - low || 1));
        if (Number.isNaN(lowest)) return;
        ctx.moveTo(x, y(lowest) + 0.5);
        ctx.lineTo(x, y(whole.high[channel][n]) - 0.5);
      });
      ctx.stroke();
    });
    const [left, right] = window();
    ctx.fillStyle = style.accentColor === "auto" ? style.color : style.accentColor;
    ctx.globalAlpha = 0.16;
    ctx.fillRect(left, 0, right - left, height);
    ctx.globalAlpha = 1;
    for (const x of [left, right]) ctx.fillRect(Math.max(0, Math.min(width - 2, x - 1)), 0, 2, height);
    const [first, last] = record.times;
    canvas.ariaValueMin = String(Math.round(first / 1000));
    canvas.ariaValueMax = String(Math.round(last / 1000));
    canvas.ariaValueNow = String(Math.round(record.view.from / 1000));
    canvas.ariaValueText = `${(record.view.from / 1000).toFixed(1)} s \u2013 ${(ends()[1] / 1000).toFixed(1)} s`;
  }

  return { canvas, draw };
}
