// The servo loop of an axis as a drawing: the path of its signals from the offsets to the output, with live values.
import { setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { svg } from "./svg.js";

const SIZE = Object.freeze([980, 352]);
const ROW = 17; // height of a line of text in a box
const HEAD = 24; // height of a box with a title only

/**
 * A box of the drawing. Values are named by the place of their parameter in the block of the axis, and shown with
 * decimals (-1: six digits): `value` beside the title, each of `rows` under its name, in as many columns as `columns` says.
 * @typedef {{ id: string, x: number, y: number, wide: number, title: import("../core/texts.js").Said,
 *   value?: [number, number], rows?: [string, number, number][], columns?: number }} Box
 */

const COUNTS = 0;
const VOLTS = 4;
const DIGITS = -1;

/** @type {Box[]} */
export const BOXES = [
  { id: "current", x: 10, y: 4, wide: 190, title: "loop.current", value: [0, COUNTS] },
  { id: "gear", x: 10, y: 33, wide: 190, title: "loop.gear", value: [8, COUNTS] },
  { id: "jog", x: 10, y: 62, wide: 190, title: "loop.jog", value: [9, COUNTS] },
  { id: "cam", x: 10, y: 91, wide: 190, title: "loop.cam", value: [10, COUNTS] },
  { id: "backlash", x: 265, y: 4, wide: 190, title: "loop.backlash", value: [12, COUNTS] },
  { id: "primary", x: 265, y: 47, wide: 190, title: "loop.primary", value: [6, COUNTS] },
  { id: "ballscrew", x: 265, y: 91, wide: 190, title: "loop.ballscrew", value: [11, COUNTS] },
  { id: "secondary", x: 520, y: 47, wide: 190, title: "loop.secondary", value: [7, COUNTS] },
  { id: "actual", x: 650, y: 91, wide: 190, title: "loop.actual", value: [2, COUNTS] },
  { id: "error", x: 775, y: 47, wide: 190, title: "loop.error", value: [3, COUNTS] },
  { id: "p", x: 40, y: 152, wide: 210, title: "loop.p", value: [24, VOLTS], rows: [["PGAIN", 16, DIGITS]] },
  {
    id: "i",
    x: 40,
    y: 202,
    wide: 210,
    title: "loop.i",
    value: [25, VOLTS],
    rows: [
      ["IGAIN", 17, DIGITS],
      ["ILIMIT", 18, DIGITS],
      ["IDELAY", 19, DIGITS],
    ],
  },
  {
    id: "d",
    x: 40,
    y: 286,
    wide: 210,
    title: "loop.d",
    value: [26, VOLTS],
    rows: [
      ["DGAIN", 20, DIGITS],
      ["DWIDTH", 21, DIGITS],
    ],
  },
  {
    id: "ffvel",
    x: 310,
    y: 152,
    wide: 225,
    title: "loop.ffvel",
    value: [66, VOLTS],
    rows: [
      ["FFVEL", 22, DIGITS],
      ["v", 27, COUNTS],
    ],
  },
  {
    id: "ffacc",
    x: 310,
    y: 220,
    wide: 225,
    title: "loop.ffacc",
    value: [67, VOLTS],
    rows: [
      ["FFACC", 23, DIGITS],
      ["a", 28, COUNTS],
    ],
  },
  { id: "fbvel", x: 310, y: 288, wide: 225, title: "loop.fbvel", value: [65, VOLTS], rows: [["FBVEL", 64, DIGITS]] },
  { id: "sum", x: 620, y: 152, wide: 170, title: "loop.sum", value: [29, VOLTS] },
  {
    id: "filter0",
    x: 620,
    y: 190,
    wide: 170,
    title: "loop.filter0",
    rows: [
      ["b2", 48, DIGITS],
      ["a2", 49, DIGITS],
      ["b1", 50, DIGITS],
      ["a1", 51, DIGITS],
      ["a0", 52, DIGITS],
    ],
    columns: 2,
  },
  {
    id: "filter1",
    x: 620,
    y: 275,
    wide: 170,
    title: "loop.filter1",
    rows: [
      ["b2", 53, DIGITS],
      ["a2", 54, DIGITS],
      ["b1", 55, DIGITS],
      ["a1", 56, DIGITS],
      ["a0", 57, DIGITS],
    ],
    columns: 2,
  },
  { id: "filtered", x: 815, y: 300, wide: 160, title: "loop.filtered", value: [30, VOLTS] },
  {
    id: "limits",
    x: 815,
    y: 222,
    wide: 160,
    title: "loop.limits",
    rows: [
      ["+", 40, DIGITS],
      ["\u2212", 41, DIGITS],
    ],
  },
  { id: "output", x: 815, y: 168, wide: 160, title: "loop.output", value: [31, VOLTS] },
];

/** Paths of the signals: points x,y; each ends in an arrow. */
const PATHS = [
  "200,16 232,16 232,47",
  "200,45 212,45 221,54",
  "200,74 212,74 221,65",
  "200,103 232,103 232,71",
  "244,59 265,59",
  "455,59 475,59",
  "455,16 487,16 487,47",
  "455,103 487,103 487,71",
  "499,59 520,59",
  "710,59 731,59",
  "743,91 743,71",
  "755,59 775,59",
  "965,59 972,59 972,134 22,134 22,172 40,172",
  "22,172 22,238 40,238",
  "22,238 22,314 40,314",
  "250,314 280,314 280,143 577,143 577,153",
  "250,238 280,238",
  "250,172 280,172",
  "535,165 565,165",
  "535,248 553,248 568,175",
  "535,308 577,308 577,177",
  "589,165 620,165",
  "705,176 705,190",
  "705,265 705,275",
  "790,312 815,312",
  "895,300 895,280",
  "895,222 895,192",
];
const SUMS = [
  [232, 59],
  [487, 59],
  [743, 59],
  [577, 165],
];
/** Signs beside the inputs that are subtracted. */
const SIGNS = [
  [754, 84, "\u2212"],
  [588, 196, "\u2212"],
];

/** Places of the parameters that the drawing shows, in the block of an axis. */
export const PLACES = Object.freeze([
  ...new Set(
    BOXES.flatMap((box) => [...(box.value ? [box.value[0]] : []), ...(box.rows ?? []).map(([, place]) => place)]),
  ),
]);

/**
 * A value as it is shown; a dash while it is not known.
 * @param {number | undefined} value
 * @param {number} decimals
 */
export function shownValue(value, decimals) {
  if (value === undefined) return "\u2013";
  return decimals === DIGITS ? String(Number(value.toPrecision(6))) : value.toFixed(decimals);
}

/**
 * Draw the loop; `update` shows values by their places.
 * @param {string} label
 */
export function drawLoop(label) {
  const [width, height] = SIZE;
  const picture = svg("svg", {
    viewBox: `0 0 ${width} ${height}`,
    role: "group",
    "aria-label": label,
    class: "loop-picture",
  });
  const tip = svg("marker", {
    id: "loop-tip",
    viewBox: "0 0 8 8",
    refX: 7,
    refY: 4,
    markerWidth: 8,
    markerHeight: 8,
    orient: "auto-start-reverse",
  });
  tip.append(svg("path", { d: "M0,0 L8,4 L0,8 Z" }));
  const definitions = svg("defs", {});
  definitions.append(tip);
  picture.append(
    definitions,
    ...PATHS.map((points) => svg("polyline", { points, class: "signal", "marker-end": "url(#loop-tip)" })),
  );
  picture.append(
    ...SUMS.flatMap(([cx, cy]) => [
      svg("circle", { cx, cy, r: 12, class: "sum" }),
      textAt(cx, cy + 5, "\u03a3", "sum-sign"),
    ]),
  );
  picture.append(...SIGNS.map(([x, y, sign]) => textAt(Number(x), Number(y), String(sign), "sum-sign")));
  /** @type {{ element: SVGElement, place: number, decimals: number }[]} */
  const values = [];
  for (const box of BOXES) {
    const group = svg("g", { "data-box": box.id });
    const put = (
      /** @type {number} */ x,
      /** @type {number} */ y,
      /** @type {[number, number]} */ [place, decimals],
      /** @type {string} */ looks,
    ) => {
      const element = textAt(x, y, "\u2013", looks, "end");
      group.append(element);
      values.push({ element, place, decimals });
    };
    group.append(
      svg("rect", { x: box.x, y: box.y, width: box.wide, height: heightOf(box), rx: 4, class: "box" }),
      textAt(box.x + 7, box.y + 17, t(box.title), "title", "start"),
    );
    if (box.value) put(box.x + box.wide - 7, box.y + 17, box.value, "value");
    const columns = box.columns ?? 1;
    const wide = box.wide / columns;
    (box.rows ?? []).forEach(([name, place, decimals], n) => {
      const [x, y] = [box.x + wide * (n % columns), box.y + 17 + ROW * (Math.floor(n / columns) + 1)];
      group.append(textAt(x + 7, y, name, "gain", "start"));
      put(x + wide - 7, y, [place, decimals], "gain");
    });
    picture.append(group);
  }
  return {
    element: picture,
    /** @param {(place: number) => number | undefined} valueAt */
    update(valueAt) {
      for (const { element, place, decimals } of values) setText(element, shownValue(valueAt(place), decimals));
    },
  };
}

/** @param {Box} box */
const heightOf = (box) => HEAD + ROW * Math.ceil((box.rows ?? []).length / (box.columns ?? 1));

/**
 * @param {number} x
 * @param {number} y
 * @param {string} text
 * @param {string} looks
 * @param {string} [anchor]
 */
function textAt(x, y, text, looks, anchor = "middle") {
  const element = svg("text", { x, y, class: looks, "text-anchor": anchor });
  element.textContent = text;
  return element;
}
