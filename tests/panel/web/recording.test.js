// The record of the scope: which sweep is shown when triggers and samples come.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Recording, moved, placed } from "../../../src/openacr/panel/web/js/scope/recording.js";
import { stateOf, stateText } from "../../../src/openacr/panel/web/js/scope/state.js";

const PERIOD = 0.001;

/** Samples that are their own numbers. */
const numbered = (first, count) => ({
  first,
  period: PERIOD,
  channels: [Float64Array.from({ length: count }, (_each, n) => first + n)],
});
const state = (trigger = null, swept = null, first = 100) => ({ running: true, first, trigger, swept });
const plain = (window) => window && [window.first, window.zero, [...window.channels[0]]];

/** What is shown, what is under way, and whether another browser samples, after each step of sweeps of 4. */
function lived(trigger, steps, run = "sweep") {
  const recording = new Recording();
  recording.begin(1, { first: 100, samples: 4, period_s: PERIOD }, trigger, run);
  return steps.map((step) => {
    if (step.channels) recording.add(step);
    else recording.note(step);
    return { shown: plain(recording.window()), coming: plain(recording.underWay()), isTaken: recording.isTaken };
  });
}

for (const mode of ["normal", "single"]) {
  test(`${mode}: nothing is shown before a trigger, then a whole sweep until the next one is whole`, () => {
    const found = lived({ mode, before: 0.25 }, [
      numbered(100, 7),
      state(),
      state(105),
      numbered(107, 1),
      state(105, 105),
      numbered(108, 20),
      state(120, 105),
      state(123, 120),
      state(126, 123),
      numbered(128, 1),
    ]);
    const whole = [104, 105, [104, 105, 106, 107]];
    assert.deepEqual(
      found.map(({ shown }) => shown),
      [
        [107, 108, []], // its left edge is before the trigger to come
        [107, 108, []],
        [104, 105, [104, 105, 106]],
        whole,
        whole,
        whole,
        whole, // whole; it stays
        [119, 120, [119, 120, 121, 122]],
        [122, 123, [122, 123, 124, 125]],
        [122, 123, [122, 123, 124, 125]],
      ],
    );
    const coming = found.map((each) => each.coming);
    assert.deepEqual(coming.slice(0, 4), [null, null, null, null]);
    assert.deepEqual(coming.slice(8), [
      [125, 126, [125, 126, 127]],
      [125, 126, [125, 126, 127, 128]],
    ]);
  });
}

test("a whole sweep is shown once its samples have come and kept when they are old", () => {
  const found = lived({ mode: "normal", before: 0 }, [
    numbered(100, 2),
    state(101, 101),
    numbered(102, 2),
    state(104, 104),
    numbered(104, 1),
    numbered(105, 3),
    numbered(108, 25_000),
    numbered(25_108, 100),
  ]).map(({ shown }) => shown);
  assert.deepEqual(found[1], [101, 101, [101]]);
  assert.deepEqual(found[4], [101, 101, [101, 102, 103, 104]]);
  for (const each of found.slice(5)) assert.deepEqual(each, [104, 104, [104, 105, 106, 107]]);
});

test("the record holds its whole sweep also where newer samples have taken its place", () => {
  const recording = new Recording();
  recording.begin(1, { first: 0, samples: 4, period_s: PERIOD }, { mode: "normal", before: 0 });
  recording.add(numbered(0, 20));
  recording.note(state(10, 10, 0));
  recording.add(numbered(20, 30_000));
  const part = (from, to) => [...recording.part(0, from, to)];
  assert.deepEqual(recording.kept, [10, 30_020]);
  assert.deepEqual(part(9, 16), [NaN, 10, 11, 12, 13, NaN, NaN]);
  assert.deepEqual(part(10_006, 10_010), [NaN, NaN, 10_008, 10_009]); // three sweeps and 20,000 samples are kept
  assert.deepEqual(part(30_018, 30_022), [30_018, 30_019, NaN, NaN]);
  assert.equal(recording.count, 30_020);
});

test("without a trigger the last whole sweep is shown", () => {
  const steps = [numbered(100, 3), numbered(103, 2), numbered(105, 6), numbered(111, 1)];
  const found = lived(null, steps);
  assert.deepEqual(
    found.map(({ shown }) => shown),
    [
      [100, 100, [100, 101, 102]],
      [100, 100, [100, 101, 102, 103]],
      [104, 104, [104, 105, 106, 107]],
      [108, 108, [108, 109, 110, 111]],
    ],
  );
  assert.deepEqual(
    found.map(({ coming }) => coming),
    [null, [104, 104, [104]], [108, 108, [108, 109, 110]], [112, 112, []]],
  );
});

test("a rolling record ends with the newest sample, that of once begins with the first", () => {
  const steps = [numbered(100, 3), numbered(103, 2), numbered(105, 6)];
  const shown = (run) => lived(null, steps, run).map((each) => each.shown);
  assert.deepEqual(shown("roll").slice(1), [
    [101, 101, [101, 102, 103, 104]],
    [107, 107, [107, 108, 109, 110]],
  ]);
  assert.deepEqual(shown("once")[2], [100, 100, [100, 101, 102, 103]]);
});

test("an automatic sweep is that of a trigger until two sweeps bring none", () => {
  const found = lived({ mode: "auto", before: 0 }, [
    numbered(100, 5),
    state(106),
    numbered(105, 5),
    state(106, 106),
    numbered(110, 8),
    numbered(118, 1),
  ]).map(({ shown }) => shown);
  assert.deepEqual(found[0], [100, 100, [100, 101, 102, 103]]);
  assert.deepEqual(found[3], [106, 106, [106, 107, 108, 109]]);
  assert.deepEqual(found[4], [106, 106, [106, 107, 108, 109]]);
  assert.deepEqual(found[5], [114, 114, [114, 115, 116, 117]]);
});

test("samples of another browser's capture are not added", () => {
  const found = lived(null, [numbered(100, 4), state(null, null, 300), numbered(300, 4), state()]);
  assert.deepEqual(
    found.map(({ isTaken }) => isTaken),
    [false, true, true, true],
  );
  assert.deepEqual(found[3].shown, [100, 100, [100, 101, 102, 103]]);
});

test("a frame that was left out is a gap, and samples of an earlier capture or of other channels are not taken", () => {
  const recording = new Recording();
  recording.begin(1, { first: 100, samples: 6, period_s: PERIOD }, null, "once");
  recording.add(numbered(99, 3));
  recording.add({ ...numbered(100, 1), channels: [[1], [2]] });
  assert.equal(recording.count, 0);
  recording.add(numbered(100, 2));
  recording.add(numbered(104, 1));
  assert.deepEqual([...recording.part(0, 100, 105)], [100, 101, NaN, NaN, 104]);
});

test("a record that is moved has gaps where nothing was", () => {
  assert.deepEqual([...moved([1, 2, 3], 1, 3)], [NaN, 1, 2]);
  assert.deepEqual([...moved([1, 2, 3], -1, 4)], [2, 3, NaN, NaN]);
});

const SEEN = [
  [{ running: true }, null, "idle"],
  [{ running: true }, { trigger: null, isTaken: true }, "taken"],
  [{ running: false, trigger: 4 }, { trigger: {}, isTaken: false }, "stopped"],
  [{ running: true }, { trigger: null, isTaken: false }, "running"],
  [{ running: true, trigger: null }, { trigger: {}, isTaken: false }, "waiting"],
  [{ running: true, trigger: 4, swept: null }, { trigger: {}, isTaken: false }, "triggered"],
  [{ running: true, trigger: 9, swept: 4 }, { trigger: {}, isTaken: false }, "triggered"],
  [{ running: true, trigger: 9, swept: 9 }, { trigger: {}, isTaken: false }, "waiting"],
];
test("the state of the scope follows from its triggers", () => {
  for (const [capture, recording, expected] of SEEN) assert.equal(stateOf(capture, recording), expected);
});

test("every state has its words, none before the first START", () => {
  const said = (name, count = 7) => stateText(name, { owner: "Ann" }, count);
  assert.equal(said("idle"), "");
  assert.match(said("taken"), /Ann/);
  for (const name of ["stopped", "running"]) assert.match(said(name), /7/);
  assert.notEqual(said("running", 0), said("running"));
  assert.notEqual(said("waiting"), said("triggered"));
});

test("a reference is placed at its time over points of another period, columns get its lowest and highest values", () => {
  const values = [10, 11, 12, 13, 14, 15];
  const own = { start: 2, period: 0.001 };
  assert.deepEqual([...placed(values, own, { start: 1, period: 0.001 }, 4)], [NaN, 10, 11, 12]);
  assert.deepEqual([...placed(values, own, { start: 2, period: 0.002 }, 4)], [10, 12, 14, NaN]);
  assert.deepEqual([...placed(values, own, { start: 2, period: 0.0005 }, 3)], [10, 11, 11]);
  const wild = [1, 9, NaN, 4, 5, 2, 8];
  const columns = { start: 0, period: 0.0015 }; // three values each
  assert.deepEqual([...placed(wild, { start: 0, period: 0.001 }, columns, 8, true)], [1, 9, 2, 5, 8, 8, NaN, NaN]);
  assert.deepEqual([...placed(wild, own, columns, 4, true)], [1, 1, 4, 9]);
});
