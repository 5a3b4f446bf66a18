// Paints the lanes of the timeline on one canvas: spans, velocities of axes, lines of programs, what two branches differ in.
import { differences } from "./lane_list.js";

const GAP = 3; // pixels above and below a span
const WIDE = 26; // pixels that a slice has at least for its text
const COLORS = { axis: "--accent", kill: "--bad", hold: "--warn", pause: "--warn", host: "--quiet", sent: "--quiet" };

/**
 * @typedef {import("./lane_list.js").Lane} Lane
 * @typedef {import("./time_view.js").Part} Part
 * @typedef {{ number: number, distance: number, places: number[], low: number[], high: number[] }} Curve
 * @typedef {{ number: number, lines: number, slices: [number, number][], texts: Record<string, string> }} Lines
 * @typedef {{ part: Part, axes: Curve[], programs: Lines[] }} Details
 * @typedef {{ lane: Lane, top: number, height: number, other: Lane | undefined }} Strip
 */

/**
 * @param {HTMLCanvasElement} canvas
 * @param {Part} part
 * @param {Strip[]} strips
 * @param {{ isCompared: boolean, details: Details | null }} more
 */
export function paint(canvas, [first, last], strips, { isCompared, details }) {
  const ratio = globalThis.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
  if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
  const to = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  if (last <= first) return;
  const style = getComputedStyle(canvas);
  /** @type {Record<string, string>} */
  const colors = {};
  const colorOf = (/** @type {string} */ name) => {
    if (!colors[name]) {
      canvas.style.color = `var(${name})`; // as the theme has it
      colors[name] = style.color;
      canvas.style.color = "";
    }
    return colors[name];
  };
  const x = (/** @type {number} */ tick) => ((Math.max(first, Math.min(last, tick)) - first) / (last - first)) * width;
  to.setTransform(ratio, 0, 0, ratio, 0, 0);
  to.clearRect(0, 0, width, height);
  to.font = `11px ${style.fontFamily}`;
  to.textBaseline = "middle";

  /** @param {[number, number][]} spans @param {number} top @param {number} high @param {string} color */
  function bars(spans, top, high, color) {
    to.fillStyle = color;
    for (const [from, end] of spans) {
      if (end < first || from > last) continue;
      to.fillRect(x(from), top, Math.max(1, x(end) - x(from)), high);
    }
  }

  for (const { lane, top, height: own, other } of strips) {
    const color = colorOf(/** @type {any} */ (COLORS)[lane.kind] ?? "--good");
    const [begin, high] = [top + GAP, own - 2 * GAP];
    if (isCompared) {
      bars(lane.spans, begin, high / 2 - 1, color);
      to.globalAlpha = 0.55;
      bars(other?.spans ?? [], begin + high / 2, high / 2, color);
      to.globalAlpha = 1;
      bars(differences(lane.spans, other?.spans ?? []), begin + high / 2 - 1, 2, colorOf("--bad"));
      continue;
    }
    const number = Number(lane.id.split(" ")[1]);
    const curve = details && lane.kind === "axis" ? details.axes.find((each) => each.number === number) : undefined;
    const lines = lane.slices
      ? { number, lines: 0, slices: lane.slices, texts: {} }
      : details && lane.kind === "program"
        ? details.programs.find((each) => each.number === number)
        : undefined;
    if (details && curve) {
      to.globalAlpha = 0.25;
      bars(lane.spans, begin, high, color);
      to.globalAlpha = 1;
      velocity(to, curve, details.part, x, begin, high, color);
    } else if (lines) {
      to.globalAlpha = 0.3;
      bars(lane.spans, begin, high, color);
      to.globalAlpha = 1;
      slices(to, lines, last, x, begin, high, [color, colorOf("--text")]);
    } else bars(lane.spans, begin, high, color);
  }
}

/**
 * The velocity of an axis, its zero in the middle: lowest and highest of each column.
 * @param {CanvasRenderingContext2D} to
 * @param {Curve} curve
 * @param {Part} part
 * @param {(tick: number) => number} x
 * @param {number} top
 * @param {number} height
 * @param {string} color
 */
function velocity(to, { low, high }, [first, last], x, top, height, color) {
  const most = Math.max(1e-12, ...high.map(Math.abs), ...low.map(Math.abs));
  const y = (/** @type {number} */ value) => top + height / 2 - (value / most) * (height / 2);
  const at = (/** @type {number} */ n) => x(first + ((n + 0.5) / low.length) * (last - first));
  to.strokeStyle = to.fillStyle = color;
  to.lineWidth = 1.2;
  to.beginPath();
  high.forEach((value, n) => (n ? to.lineTo(at(n), y(value)) : to.moveTo(at(n), y(value))));
  for (let n = low.length - 1; n >= 0; n--) to.lineTo(at(n), y(low[n]));
  to.closePath();
  to.fill();
  to.stroke();
}

/**
 * The lines of a program, with their texts where there is room.
 * @param {CanvasRenderingContext2D} to
 * @param {Lines} lines
 * @param {number} last
 * @param {(tick: number) => number} x
 * @param {number} top
 * @param {number} height
 * @param {string[]} colors
 */
function slices(to, { slices: all, texts }, last, x, top, height, [color, text]) {
  all.forEach(([tick, line], n) => {
    const [from, end] = [x(tick), x(all[n + 1]?.[0] ?? last)];
    to.fillStyle = color;
    to.fillRect(from, top, 1, height);
    if (end - from < WIDE) return;
    to.save();
    to.beginPath();
    to.rect(from, top, end - from - 2, height);
    to.clip();
    to.fillStyle = text;
    to.fillText(`${line} ${texts[line] ?? ""}`, from + 3, top + height / 2);
    to.restore();
  });
}
