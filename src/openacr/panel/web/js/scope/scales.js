// Scales of the screen: divisions, lanes of flags, steps of 1, 2 and 5, labels that do not overlap.

export const DIVISIONS = 10;
export const HALF = DIVISIONS / 2;
const STEPS = [1, 2, 5];
const LANE = 1; // divisions of a flag beside curves
const LANES = 6; // divisions that flags have at most beside curves
const HIGH = 0.8; // of a lane: a flag that is set

/**
 * The smallest 1, 2 or 5 times a power of ten that is not below a value above 0.
 * @param {number} wanted
 */
export function stepAbove(wanted) {
  const decade = 10 ** Math.floor(Math.log10(wanted));
  return Number((decade * (STEPS.find((each) => each * decade >= wanted * (1 - 1e-12)) ?? 10)).toPrecision(3));
}

/**
 * The largest 1, 2 or 5 times a power of ten that is below a value above 0.
 * @param {number} value
 */
export function stepBelow(value) {
  const decade = 10 ** Math.floor(Math.log10(value));
  const below = [...STEPS].reverse().find((each) => each * decade < value * (1 - 1e-12));
  return Number((below === undefined ? decade / 2 : below * decade).toPrecision(3));
}

/**
 * A scale of 1, 2 or 5 that shows values whole in a part of the screen, and the offset that has their middle in its
 * middle; null without values.
 * @param {ArrayLike<number>} values
 * @param {number} [height] divisions of the part
 * @param {number} [middle] divisions from the middle of the screen up
 */
export function fitting(values, height = DIVISIONS, middle = 0) {
  const [low = Infinity, high = -Infinity] = extremes([values]);
  if (low > high) return null;
  const scale = high > low ? stepAbove((high - low) / (height - 2)) : 1;
  return { scale, offset: Number(((Math.round((low + high) / 2 / scale) - middle) * scale).toPrecision(9)) };
}

/**
 * Divisions of the lane of a flag.
 * @param {number} flags
 * @param {boolean} isAlone there are no curves
 */
function laneHeight(flags, isAlone) {
  return isAlone ? Math.min(2 * LANE, DIVISIONS / flags) : Math.min(LANE, LANES / Math.max(1, flags));
}

/**
 * Scale and offset of a flag in its lane; the first lane is above the others at the bottom.
 * @param {number} place of the flag among all flags
 * @param {number} flags
 * @param {boolean} isAlone there are no curves
 */
export function laneOf(place, flags, isAlone) {
  const lane = laneHeight(flags, isAlone);
  const scale = 1 / (HIGH * lane);
  const bottom = (flags - 1 - place + (1 - HIGH) / 2) * lane;
  return { scale: Number(scale.toPrecision(4)), offset: Number(((HALF - bottom) * scale).toPrecision(6)) };
}

/**
 * Scales and offsets that show all traces: flags in lanes below each other at the bottom, curves above them.
 * @param {{ values: ArrayLike<number>, isFlag: boolean }[]} traces
 */
export function laidOut(traces) {
  const flags = traces.filter(({ isFlag }) => isFlag).length;
  const isAlone = flags === traces.length;
  const free = DIVISIONS - flags * laneHeight(flags, isAlone);
  let place = 0;
  return traces.map(({ values, isFlag }) =>
    isFlag ? laneOf(place++, flags, isAlone) : fitting(values, free, HALF - free / 2),
  );
}

/**
 * Lowest and highest value of all; empty without any.
 * @param {ArrayLike<number>[]} all
 */
export function extremes(all) {
  let [low, high] = [Infinity, -Infinity];
  for (const values of all)
    for (let n = 0; n < values.length; n++) {
      if (values[n] < low) low = values[n];
      if (values[n] > high) high = values[n];
    }
  return low > high ? [] : [low, high];
}

/**
 * The axes that show the values of curves: one each, or one for all of a unit.
 * @template {{ unit: string, isFlag: boolean }} T
 * @param {T[]} traces
 * @param {string} kind "own" or "unit"; else none
 */
export function axesOf(traces, kind) {
  const curves = traces.filter(({ isFlag }) => !isFlag);
  if (kind === "own") return curves;
  return kind === "unit" ? curves.filter((each, n) => curves.findIndex(({ unit }) => unit === each.unit) === n) : [];
}

/**
 * The lines of a grid over a time: whole multiples of its step.
 * @param {number} from
 * @param {number} step
 */
export function gridOf(from, step) {
  const first = Math.ceil(from / step - 1e-6);
  const last = Math.floor(from / step + DIVISIONS + 1e-6);
  return Array.from({ length: last - first + 1 }, (_each, n) => Number(((first + n) * step).toPrecision(12)) + 0);
}

/**
 * Texts of the lines of a grid, empty where there is no room; the line of 0 has its text.
 * @param {number[]} lines
 * @param {number} step
 * @param {number} room pixels from line to line
 * @param {number} [letter] pixels of a letter
 */
export function labelsOf(lines, step, room, letter = 8) {
  const texts = lines.map((each) => String(Number(each.toPrecision(9))).replace("-", "\u2212"));
  const widest = Math.max(1, ...texts.map(({ length }) => length + 1)) * letter;
  const every = [1, 2, 5, 10].find((each) => each * room >= widest) ?? DIVISIONS;
  return texts.map((text, n) => (Math.round(lines[n] / step) % every === 0 ? text : ""));
}

/**
 * The values of an axis at lines of the grid, empty where there is no room.
 * @param {{ scale: number, offset: number }} axis
 * @param {number[]} lines in divisions
 * @param {number} room pixels from line to line
 */
export function valuesOf({ scale, offset }, lines, room) {
  const every = [1, 2, 5].find((each) => each * room >= 14) ?? DIVISIONS;
  return lines.map((line) =>
    line % every ? "" : String(Number((line * scale + offset).toPrecision(5))).replace("-", "\u2212"),
  );
}
