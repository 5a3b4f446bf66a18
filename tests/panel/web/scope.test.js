// The arithmetic of the scope: measures, scales, zoom, spectrum, maths channel.
import assert from "node:assert/strict";
import { test } from "node:test";
import { steppedBy } from "../../../src/openacr/panel/web/js/scope/cursors.js";
import { ExpressionError } from "../../../src/openacr/panel/web/js/core/expression.js";
import { computed, derivative, integral } from "../../../src/openacr/panel/web/js/scope/maths.js";
import { deviation, measured } from "../../../src/openacr/panel/web/js/scope/measures.js";
import { columnsOf, curveOf } from "../../../src/openacr/panel/web/js/scope/columns.js";
import { gripOf } from "../../../src/openacr/panel/web/js/scope/overview.js";
import {
  axesOf,
  extremes,
  fitting,
  gridOf,
  labelsOf,
  laidOut,
  laneOf,
  stepAbove,
  stepBelow,
  valuesOf,
} from "../../../src/openacr/panel/web/js/scope/scales.js";
import { decibels, peaks, spectrum, transformed, windowOf } from "../../../src/openacr/panel/web/js/scope/spectrum.js";
import { zoomed } from "../../../src/openacr/panel/web/js/scope/view.js";
import { valueAt } from "../../../src/openacr/panel/web/js/scope/xy.js";

const near = (found, expected, within = 1e-9) =>
  expected.forEach((each, n) => assert.ok(Math.abs(found[n] - each) <= within, `${n}: ${found[n]} is not ${each}`));
const numbers = (count, from = 0, step = 1) => Array.from({ length: count }, (_each, n) => from + step * n);

test("missing samples are not measured", () => {
  assert.deepEqual(measured([NaN, 3, NaN, -4], 0, 3), {
    count: 2,
    min: -4,
    max: 3,
    mean: -0.5,
    rms: Math.sqrt(12.5),
    span: 7,
  });
  assert.equal(measured([1, NaN], 1, 1), null);
  assert.deepEqual(measured([9, 1, 2, 9], 1, 2), { count: 2, min: 1, max: 2, mean: 1.5, rms: Math.sqrt(2.5), span: 1 });
  assert.equal(measured([1, 2], -5, 9).count, 2);
});

test("the deviation of two records is where they are farthest apart in what they share", () => {
  assert.equal(deviation([1, NaN, 5], [2, 9, 3, 100]), 2);
  assert.equal(deviation([NaN], [1]), null);
  assert.equal(deviation([1], [1]), 0);
});

test("steps are 1, 2 or 5 times a power of ten", () => {
  assert.deepEqual([0.9, 1, 1.1, 2, 2.1, 5, 5.1, 0.03].map(stepAbove), [1, 1, 2, 2, 5, 5, 10, 0.05]);
  assert.deepEqual([10, 5.1, 5, 2, 1, 0.2].map(stepBelow), [5, 5, 2, 1, 0.5, 0.1]);
});

test("autoscale shows the whole in steps of 1, 2 and 5", () => {
  const fits = [
    [[0, 80], 10, 40],
    [[-1, 7.1], 2, 4],
    [[0, 32], 5, 15],
    [[3, 3], 1, 3],
    [[-4e-6, 4e-6], 1e-6, 0],
  ];
  for (const [values, scale, offset] of fits) assert.deepEqual(fitting(values), { scale, offset });
  assert.equal(fitting([]), null);
  assert.equal(fitting([NaN]), null);
});

test("autoscale gives every flag a lane and curves the rest", () => {
  const drawn = (fit, value) => (value - fit.offset) / fit.scale;
  for (const [flags, curves] of [
    [1, 1],
    [2, 1],
    [3, 0],
    [8, 0],
    [7, 1],
    [0, 2],
  ]) {
    const traces = [
      ...numbers(flags).map((n) => ({ values: [n % 2], isFlag: true })),
      ...numbers(curves).map(() => ({ values: [-3, 5], isFlag: false })),
    ];
    const found = laidOut(traces);
    const lanes = found.slice(0, flags).map((fit) => [drawn(fit, 0), drawn(fit, 1)]);
    for (const [low, high] of lanes) assert.ok(high - low > 0.6);
    for (let n = 1; n < flags; n++) assert.ok(lanes[n - 1][0] > lanes[n][1]); // the first one is the uppermost
    for (const fit of found.slice(flags)) {
      assert.ok(drawn(fit, 5) <= 5);
      assert.ok(drawn(fit, -3) > (lanes[0]?.[1] ?? -5));
    }
    if (flags) assert.ok(lanes.at(-1)[0] > -5 && lanes[0][1] < 5);
  }
});

test("lines of the grid are multiples of a division", () => {
  assert.deepEqual(gridOf(0, 100), numbers(11, 0, 100));
  assert.deepEqual(gridOf(-25, 10), numbers(10, -20, 10));
  assert.deepEqual(gridOf(-10, 5), numbers(11, -10, 5));
});

test("labels are left out where they would overlap, and zero has one", () => {
  const labels = (room) => labelsOf(numbers(11, -200, 100), 100, room);
  assert.deepEqual(labels(60), ["\u2212200", "\u2212100", ...numbers(9, 0, 100).map(String)]);
  assert.deepEqual(labels(21), ["\u2212200", "", "0", "", "200", "", "400", "", "600", "", "800"]);
  assert.deepEqual(labels(4).filter(Boolean), ["0"]);
});

test("zoom goes by steps of 1, 2 and 5 about the pointer", () => {
  for (const [step, finer, coarser] of [
    [1, 0.5, 2],
    [2, 1, 5],
    [5, 2, 10],
    [0.2, 0.1, 0.5],
    [3, 2, 5],
  ]) {
    for (const [isFiner, expected] of [
      [true, finer],
      [false, coarser],
    ]) {
      const at = 100 + 4 * step;
      const found = zoomed({ from: 100, step }, isFiner, at, [-1000, 1000], 0.05);
      assert.equal(found.step, expected);
      near([found.from + 4 * expected], [at]);
    }
  }
});

test("zoom stays within the record", () => {
  const views = [
    [0, 100, false, 0, 100], // the whole record is shown
    [0, 1, true, 0, 1], // a sample in a division
    [900, 20, false, 500, 50], // not beyond the end
    [0, 20, false, 0, 50], // nor before the beginning
  ];
  for (const [from, step, isFiner, ...expected] of views) {
    const found = zoomed({ from, step }, isFiner, from, [0, 1000], 1);
    assert.deepEqual([found.from, found.step], expected);
  }
  assert.deepEqual(zoomed({ from: 10, step: 20 }, false, 200, [0, 1000], 1), { from: 0, step: 50 });
});

test("scales of XY are in the unit of their trace", () => {
  assert.deepEqual(
    [-5, 0, 4].map((n) => valueAt({ scale: 0.5, offset: 3 }, n)),
    ["0.5", "3", "5"],
  );
  assert.equal(valueAt({ scale: 1, offset: 0 }, -2), "\u22122");
});

test("the transform is the sum of its definition at any length", () => {
  for (const size of [2, 3, 8, 13]) {
    const real = Float64Array.from(numbers(size), (n) => Math.sin(n * n));
    const imaginary = Float64Array.from(numbers(size), (n) => Math.cos(3 * n));
    const [re, im] = transformed(real, imaginary);
    const sums = numbers(size).map((k) =>
      numbers(size).reduce(
        ([x, y], n) => {
          const [c, s] = [Math.cos((2 * Math.PI * k * n) / size), -Math.sin((2 * Math.PI * k * n) / size)];
          return [x + real[n] * c - imaginary[n] * s, y + real[n] * s + imaginary[n] * c];
        },
        [0, 0],
      ),
    );
    near(
      re,
      sums.map(([x]) => x),
    );
    near(
      im,
      sums.map(([, y]) => y),
    );
  }
});

test("a constant and a sine have their amplitudes at their bins, the highest bin is counted once", () => {
  const values = numbers(20).map((n) => 0.25 + 3 * Math.sin((2 * Math.PI * 4 * n) / 20 + 0.7));
  const found = spectrum(values, 0.01, "hann");
  near([found.step], [5], 1e-12);
  near([found.amplitudes[0], found.amplitudes[4]], [0.25, 3]);
  assert.deepEqual(peaks(found.amplitudes, 1), [4]);
  near(spectrum([2, -2, 2, -2], 0.5, "rectangle").amplitudes, [0, 0, 2]);
});

test("a record with a gap, or of one sample, has no spectrum", () => {
  assert.equal(spectrum([1, NaN, 2], 1, "hann"), null);
  assert.equal(spectrum([1], 1, "hann"), null);
});

test("windows are periodic, decibels are of one unit", () => {
  near(windowOf("hann", 4), [0, 0.5, 1, 0.5], 1e-15);
  near([1, 0.1, 0].map(decibels), [0, -20, -300]);
});

test("the maths channel computes sample by sample, its rates and integrals over time", () => {
  const channels = [
    [0, 1, 4, 9],
    [1, 1, 2, 2],
  ];
  assert.deepEqual([...computed("CH1 + 2*ch2 - min(CH1, 3)", channels, 0.5)], [2, 2, 5, 10]);
  assert.deepEqual([...computed("d(CH1)", channels, 0.5)], [2, 4, 8, 10]);
  assert.deepEqual([...computed("i(CH2)", channels, 0.5)], [0, 0.5, 1.25, 2.25]);
  assert.deepEqual([...computed("pi", channels, 1)], [Math.PI, Math.PI, Math.PI, Math.PI]);
  assert.deepEqual([...derivative(Float64Array.of(1, 2), 0.1)], [10, 10]);
  assert.deepEqual([...integral(Float64Array.of(1, 3), 2)], [0, 4]);
});

test("a name that is no channel or function of the maths channel is refused, also one of the browser", () => {
  for (const [text, what] of [
    ["CH3", "CH3"],
    ["window", "window"],
    ["alert(1)", "alert"],
    ["min(CH1)", ")"],
    ["", ""],
  ]) {
    assert.throws(
      () => computed(text, [[1], [2]], 1),
      (error) => error instanceof ExpressionError && error.what === what,
      text,
    );
  }
});

test("curves have an axis each, or one for all of a unit; flags have none", () => {
  const traces = [
    { label: "CH1", unit: "mm", isFlag: false },
    { label: "CH2", unit: "", isFlag: true },
    { label: "CH3", unit: "V", isFlag: false },
    { label: "CH4", unit: "mm", isFlag: false },
  ];
  const names = (kind) => axesOf(traces, kind).map(({ label }) => label);
  assert.deepEqual(names("divisions"), []);
  assert.deepEqual(names("own"), ["CH1", "CH3", "CH4"]);
  assert.deepEqual(names("unit"), ["CH1", "CH3"]);
});

test("an axis has the values of its curve at the lines of the grid that have room", () => {
  const axis = { scale: 2, offset: -3 };
  assert.deepEqual(valuesOf(axis, [-1, 0, 1], 14), ["\u22125", "\u22123", "\u22121"]);
  assert.deepEqual(valuesOf(axis, [-1, 0, 1, 2], 13.9), ["", "\u22123", "", "1"]);
});

test("lanes of flags are those of AUTOSCALE, whatever curves are there", () => {
  const flag = { values: [0, 1], isFlag: true };
  const curve = { values: [0, 8], isFlag: false };
  assert.deepEqual([laneOf(0, 2, false), laneOf(1, 2, false)], laidOut([curve, flag, flag]).slice(1));
  assert.deepEqual(
    [0, 1, 2].map((n) => laneOf(n, 3, true)),
    laidOut([flag, flag, flag]),
  );
  const { scale, offset } = laneOf(1, 2, false);
  near([-offset / scale, (1 - offset) / scale], [-4.9, -4.1], 1e-3); // the lowest lane has one division
});

test("extremes are those of all records together", () => {
  assert.deepEqual(
    extremes([
      [3, NaN, 5],
      [4, -1],
    ]),
    [-1, 5],
  );
  assert.deepEqual(extremes([[NaN], []]), []);
});

test("columns of a long record become a curve from low to high, single samples stay as they are", () => {
  const many = columnsOf(Float64Array.from([32, 16, 2, 2, 0, 99, 1, 2, 3, 4, 11, 12, 13, 14]).buffer);
  assert.deepEqual([many.first, many.width, many.ends], [32, 16, [0, 99]]);
  assert.deepEqual(
    curveOf(many).map((each) => [...each]),
    [
      [1, 11, 2, 12],
      [3, 13, 4, 14],
    ],
  );
  const single = columnsOf(Float64Array.from([7, 1, 3, 1, 0, 99, 5, 6, 7]).buffer);
  assert.deepEqual(
    curveOf(single).map((each) => [...each]),
    [[5, 6, 7]],
  );
});

test("the part in the overview is moved in its middle, resized at its edges, and jumps to a place beside it", () => {
  const at = (x, part = [100, 200]) => gripOf(x, part);
  assert.deepEqual(
    [92, 100, 108].map((x) => at(x)),
    [0, 0, 0],
  );
  assert.deepEqual(
    [192, 208].map((x) => at(x)),
    [1, 1],
  );
  assert.deepEqual(
    [109, 191].map((x) => at(x)),
    ["window", "window"],
  );
  assert.deepEqual(
    [91, 209].map((x) => at(x)),
    ["jump", "jump"],
  );
  assert.deepEqual(
    [99, 105].map((x) => at(x, [100, 106])),
    [0, 1],
  ); // a narrow one has both edges
});

test("a cursor is moved by a sample or by a pixel, whatever is more, with Shift by ten, within the screen", () => {
  const screen = { min: 0, max: 100, pixels: 1000, sample: 0.5 };
  const moved = (key, time, more = {}, shiftKey = false) => steppedBy({ key, shiftKey }, time, { ...screen, ...more });
  assert.equal(moved("ArrowRight", 10), 10.5);
  assert.equal(moved("ArrowLeft", 10), 9.5);
  assert.equal(moved("ArrowRight", 10, { pixels: 50 }), 12);
  assert.equal(moved("ArrowRight", 10, {}, true), 15);
  assert.equal(moved("ArrowLeft", 3, {}, true), 0);
  assert.equal(moved("ArrowRight", 99.9), 100);
  assert.equal(moved("ArrowUp", 10), null);
});
