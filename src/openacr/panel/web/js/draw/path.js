// The tool path of a program: fetched once, shared by every picture of it.
import { address } from "../core/api.js";
import { Signal } from "../core/signal.js";

const AGAIN_MS = 300;
const MARK = "OAP2";
const HEAD = 88;
export const KIND = Object.freeze({ rapid: 0, feed: 1, compensated: 2, inserted: 3, probe: 4 });

/**
 * @typedef {object} ToolPath points in machine coordinates, x y z
 * @property {Float32Array} points
 * @property {Uint32Array} lines line of the program that draws to each point
 * @property {Uint32Array} starts first point of each polyline
 * @property {Uint8Array} kinds of the polylines
 * @property {Uint8Array} colors of the polylines
 * @property {number[]} box min x y z, max x y z
 * @property {number} seconds predicted
 * @property {number[]} zero origin of the work coordinates at the start
 * @property {number[] | null} blank min x y z, max x y z; null where its sizes are not stored
 */

/** Path of the loaded program; null for none. */
export const path = new Signal(/** @type {ToolPath | null} */ (null));
/** Line of the program that the operator has chosen in listing or picture; 0 for none. */
export const chosenLine = new Signal(0);

/**
 * @param {ArrayBuffer} data
 * @returns {ToolPath}
 */
function readPath(data) {
  const view = new DataView(data);
  const mark = String.fromCharCode(...new Uint8Array(data, 0, 4));
  if (mark !== MARK) throw new Error(`a tool path begins with ${MARK}, not with ${mark}`);
  const [n, m] = [view.getUint32(4, true), view.getUint32(8, true)];
  const after = HEAD + 16 * n;
  const blank = [...new Float32Array(data, 60, 6)];
  return {
    points: new Float32Array(data, HEAD, 3 * n),
    lines: new Uint32Array(data, HEAD + 12 * n, n),
    starts: new Uint32Array(data, after, m),
    kinds: new Uint8Array(data, after + 4 * m, m),
    colors: new Uint8Array(data, after + 5 * m, m),
    box: [...new Float32Array(data, 16, 6)],
    seconds: view.getFloat64(40, true),
    zero: [...new Float32Array(data, 48, 3)],
    blank: blank.some(Number.isNaN) ? null : blank,
  };
}

/**
 * Fetch a path; waits while the server computes it. Null where there is none.
 * @param {string} place
 * @param {Record<string, string | number | undefined>} [query]
 * @param {RequestInit} [options]
 */
export async function fetchPath(place, query, options) {
  for (;;) {
    const response = await fetch(address(place, query), options);
    if (response.status === 202) await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
    else return response.ok ? readPath(await response.arrayBuffer()) : null;
  }
}

/**
 * The box of what is cut, without rapids: min x y z, max x y z; the whole path where nothing is.
 * @param {ToolPath} drawn
 */
function cutBox(drawn) {
  const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
  drawn.starts.forEach((first, part) => {
    if (drawn.kinds[part] === KIND.rapid) return;
    for (let at = 3 * first; at < 3 * endOf(drawn, part); at++) {
      const value = drawn.points[at];
      box[at % 3] = Math.min(box[at % 3], value);
      box[3 + (at % 3)] = Math.max(box[3 + (at % 3)], value);
    }
  });
  return box[0] <= box[3] ? box : [...drawn.box];
}

/**
 * The box of what is worth seeing: what is cut, and the blank; null for a path that leads nowhere,
 * as that of a program that asks first.
 * @param {ToolPath} drawn
 */
export function areaOf(drawn) {
  const box = drawn.lines.length ? cutBox(drawn) : [0, 0, 0, 0, 0, 0];
  const { blank } = drawn;
  if (blank) return box.map((value, n) => (n < 3 ? Math.min(value, blank[n]) : Math.max(value, blank[n])));
  return [0, 1, 2].some((n) => box[n + 3] > box[n]) ? box : null;
}

/**
 * One after the last point of a polyline; it ends with the first point of the next one.
 * @param {ToolPath} drawn
 * @param {number} n
 */
export function endOf(drawn, n) {
  return n + 1 < drawn.starts.length ? drawn.starts[n + 1] + 1 : drawn.lines.length;
}

/**
 * The place up to which the path is cut when a line is executed: searched onwards from the last
 * place, because loops come back to their lines.
 * @param {ToolPath} drawn
 * @param {number} from
 * @param {number} line
 */
export function reached(drawn, from, line) {
  const { lines } = drawn;
  for (let at = from; at < lines.length; at++) if (lines[at] === line) return at;
  const first = lines.indexOf(line);
  return first < 0 ? from : first;
}

/** @typedef {{ kind: number, color: number }} Style of a stroke: kind of its moves, colour of the store */

/**
 * The moves of a path by their looks.
 * @param {ToolPath} drawn
 * @returns {{ drawing: import("./flat.js").Drawing, styles: Style[] }}
 */
export function strokesOf(drawn) {
  /** @type {Map<number, number[]>} */
  const groups = new Map();
  drawn.kinds.forEach((kind, n) => {
    const key = 16 * kind + (kind === KIND.rapid ? 0 : drawn.colors[n]);
    const spans = groups.get(key) ?? [];
    spans.push(drawn.starts[n], endOf(drawn, n) - 1);
    groups.set(key, spans);
  });
  const keys = [...groups.keys()].sort((a, b) => a - b);
  return {
    drawing: { points: drawn.points, strokes: keys.map((key) => Uint32Array.from(groups.get(key) ?? [])) },
    styles: keys.map((key) => ({ kind: key >> 4, color: key & 15 })),
  };
}
