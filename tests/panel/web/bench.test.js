// The workspace of the engineer: the shown part of the history, answers of the wizard, links of the machine.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  arranged,
  differences,
  lanesOf,
  lastBefore,
  movedBy,
  spanAt,
  toggled,
} from "../../../src/openacr/panel/web/js/bench/lane_list.js";
import { freeName, inksOf, INKS, keptOf } from "../../../src/openacr/panel/web/js/bench/tuning/kept_data.js";
import { neighbours } from "../../../src/openacr/panel/web/js/bench/tuning/sets_list.js";
import {
  keyed,
  neighbour,
  placeOf,
  rulerOf,
  secondsOf,
  within,
  zoomed,
} from "../../../src/openacr/panel/web/js/bench/time_view.js";
import {
  changed,
  textOf,
  valueAt,
  valueOf,
  whereOf,
  withOneMore,
} from "../../../src/openacr/panel/web/js/bench/wizard/answers.js";
import { Camera } from "../../../src/openacr/panel/web/js/draw/camera.js";
import { frames } from "../../../src/openacr/panel/web/js/draw/kinematics.js";

test("times are typed as seconds, or with minutes and hours", () => {
  const times = {
    885.8: 885.8,
    "885,8": 885.8,
    "14:45.5": 885.5,
    "1:00:01": 3601,
    " 0 ": 0,
    "": null,
    soon: null,
    "-1": null,
    "1:2:3:4": null,
    "1e3": null,
    ":5": null,
  };
  for (const [text, expected] of Object.entries(times)) assert.equal(secondsOf(text), expected, text);
});

test("the shown part stays within the history", () => {
  assert.deepEqual(within([-50, 50], [0, 1000]), [0, 100]);
  assert.deepEqual(within([950, 1050], [0, 1000]), [900, 1000]);
  assert.deepEqual(within([0, 5000], [10, 1000]), [10, 1000]);
  assert.deepEqual(zoomed([0, 1600], true, 400, [0, 1600]), [150, 1150]);
  assert.deepEqual(zoomed([0, 1000], false, 1000, [0, 1600]), [0, 1600]);
  for (let end = 40; end < 400; end++)
    assert.deepEqual(zoomed(zoomed([0, end], true, end / 3, [0, end]), false, end / 3, [0, end]), [0, end]);
  assert.deepEqual(zoomed([100, 120], true, 110, [0, 1600]), [100, 120]);
  assert.deepEqual(zoomed([100, 105], true, 102, [0, 1600]), [100, 105]);
  assert.deepEqual([placeOf(150, [100, 200]), placeOf(7, [7, 7])], [50, 0]);
});

test("the ruler has round times", () => {
  assert.deepEqual(rulerOf([0, 2000], 0.0005, 6), [0, 0.2, 0.4, 0.6, 0.8, 1]);
  assert.deepEqual(rulerOf([500, 1500], 0.001, 4), [0.5, 1, 1.5]);
  assert.deepEqual(rulerOf([7, 7], 1, 4), []);
});

test("W and S zoom about a tick, A and D move along", () => {
  const whole = /** @type {[number, number]} */ ([0, 1600]);
  assert.deepEqual(keyed("w", [0, 1600], 400, whole), [150, 1150]);
  assert.deepEqual(keyed("S", [150, 1150], 400, whole), [0, 1600]);
  assert.deepEqual(keyed("a", [500, 1000], 400, whole), [400, 900]);
  assert.deepEqual(keyed("d", [500, 1000], 400, whole), [600, 1100]);
  assert.deepEqual(keyed("d", [1500, 1600], 400, whole), [1500, 1600]);
  assert.equal(keyed("x", [0, 10], 5, whole), null);
});

test("a neighbour of a tick is never the tick itself", () => {
  const ticks = [10, 20, 30];
  assert.deepEqual([neighbour(ticks, 20, false), neighbour(ticks, 20, true)], [30, 10]);
  assert.deepEqual([neighbour(ticks, 19, false), neighbour(ticks, 21, true)], [20, 20]);
  assert.deepEqual([neighbour(ticks, 30, false), neighbour(ticks, 10, true)], [undefined, undefined]);
});

const LANES = lanesOf({
  lanes: [
    { kind: "program", number: 5, name: "PROG5", spans: [], on: 0, changes: 0 },
    { kind: "axis", number: 0, name: "X", spans: [], on: 0, changes: 0 },
    { kind: "program", number: 6, name: "PROG6", spans: [], on: 0, changes: 0 },
    { kind: "pause", number: 5, name: "PROG5", spans: [], on: 0, changes: 0 },
  ],
  hosts: [{ stream: 2, is_own: false, spans: [[1, 2]], packets: 3, lines: 4, size_bytes: 9 }],
  sent: [{ stream: 2, is_own: true, spans: [[2, 3]], packets: 1, lines: 0, size_bytes: 5 }],
});

/** @param {any} arrangement */
const rowsOf = (arrangement) =>
  arranged(LANES, arrangement, (lane) => `${lane.name} ${lane.kind}`).map((row) =>
    "group" in row ? `${row.isFolded ? "+" : "-"}${row.group} ${row.count}` : row.lane.id,
  );

test("lanes are in groups that fold, pinned ones first, in their own order, filtered by words", () => {
  assert.deepEqual(rowsOf({}), [
    "-axes 1",
    "axis 0",
    "-programs 3",
    "program 5",
    "program 6",
    "pause 5",
    "-hosts 1",
    "host 2",
    "-sent 1",
    "sent 2",
  ]);
  assert.deepEqual(rowsOf({ folded: ["programs", "hosts", "sent"], pinned: ["host 2", "axis 0", "axis 7"] }), [
    "-pinned 2",
    "host 2",
    "axis 0",
    "+programs 3",
    "+sent 1",
  ]);
  assert.deepEqual(rowsOf({ order: ["pause 5", "program 6"], filter: " PROGRAM prog " }), [
    "-programs 2",
    "program 6",
    "program 5",
  ]);
  assert.equal(LANES[4].changes, 7);
});

test("what the panel asks for itself is named as such, not as the traffic of another host", () => {
  const host = { spans: [], packets: 0, lines: 0, size_bytes: 0 };
  const hosts = [
    { ...host, stream: 1, is_own: true },
    { ...host, stream: 2, is_own: false },
  ];
  assert.deepEqual(
    lanesOf({ lanes: [], hosts, sent: hosts }).map((lane) => lane.name),
    ["PANEL STREAM1", "STREAM2", "PANEL STREAM1", "STREAM2"],
  );
});

test("a lane changes its place with its neighbour, and at the end it stays", () => {
  assert.deepEqual(movedBy(["a", "b", "c"], "b", -1), ["b", "a", "c"]);
  assert.deepEqual(movedBy(["a", "b", "c"], "b", 1), ["a", "c", "b"]);
  assert.deepEqual(movedBy(["a", "b"], "a", -1), ["a", "b"]);
  assert.deepEqual(movedBy(["a", "b"], "b", 1), ["a", "b"]);
  assert.deepEqual(movedBy(["a", "b"], "z", 1), ["a", "b"]);
  assert.deepEqual([toggled(["a"], "b"), toggled(["a", "b"], "a")], [["a", "b"], ["b"]]);
});

test("two lanes differ where exactly one of them is on", () => {
  assert.deepEqual(
    differences(
      [
        [0, 10],
        [20, 30],
      ],
      [
        [0, 10],
        [25, 40],
      ],
    ),
    [
      [20, 25],
      [30, 40],
    ],
  );
  assert.deepEqual(differences([[0, 10]], []), [[0, 10]]);
  assert.deepEqual(differences([[0, 10]], [[10, 20]]), [
    [0, 10],
    [10, 20],
  ]);
  assert.deepEqual(differences([[5, 6]], [[5, 6]]), []);
});

test("a span ends before its last tick, a slice lasts until the next one", () => {
  const spans = /** @type {[number, number][]} */ ([
    [5, 8],
    [10, 12],
  ]);
  assert.deepEqual(
    [4, 5, 7, 8, 11, 12].map((tick) => spanAt(spans, tick)?.[0]),
    [undefined, 5, 5, undefined, 10, undefined],
  );
  const slices = /** @type {[number, number][]} */ ([
    [5, 10],
    [7, 20],
    [9, 30],
  ]);
  assert.deepEqual(
    [4, 5, 6, 7, 9, 99].map((tick) => lastBefore(slices, tick)?.[1]),
    [undefined, 10, 10, 20, 30, 30],
  );
});

test("an answer is changed where its dialog has it, and an empty table goes with its last value", () => {
  const dialog = { of: "axis", within: "drive" };
  assert.deepEqual(whereOf(dialog, 1), ["axis", 1, "drive"]);
  assert.deepEqual(whereOf({ of: "card", within: "" }, 1), ["card"]);
  const answers = { axis: [{ name: "X" }, { name: "Y", drive: { gain: 2 } }] };
  const where = ["axis", 1, "drive", "gain"];
  assert.equal(valueAt(answers, where), 2);
  assert.equal(valueAt(answers, ["axis", 0, "drive", "gain"]), undefined);
  assert.deepEqual(changed(answers, where, 3).axis[1], { name: "Y", drive: { gain: 3 } });
  assert.deepEqual(changed(answers, where, undefined).axis[1], { name: "Y" });
  assert.equal(valueAt(answers, where), 2); // the answers before are left alone
});

test("an axis more has the first free number and name, and the scales of the last one", () => {
  const one = withOneMore({ axis: [] }, "axis");
  assert.deepEqual(one.axis, [{ number: 0, name: "X", units_per_rev: 5, counts_per_rev: 8000 }]);
  const two = withOneMore({ axis: [{ number: 1, name: "X", units_per_rev: 10, counts_per_rev: 4000 }] }, "axis");
  assert.deepEqual(two.axis[1], { number: 0, name: "Y", units_per_rev: 10, counts_per_rev: 4000 });
  assert.deepEqual(withOneMore({ axis: [], master: [{ number: 0, axes: [] }] }, "master").master[1], {
    number: 1,
    axes: [],
  });
  const many = [..."XYZABCUVW"].map((name, number) => ({ number, name }));
  assert.equal(withOneMore({ axis: many }, "axis").axis[9].name, "AA");
});

test("what is typed is a value of its kind, none where it is as by default, text where it is none", () => {
  const number = { kind: "number", default: 5, is_optional: false };
  assert.deepEqual(
    ["5", "2,5", "x", ""].map((text) => valueOf(number, text)),
    [undefined, 2.5, "x", undefined],
  );
  assert.deepEqual(valueOf({ kind: "names" }, "X, Y Z"), ["X", "Y", "Z"]);
  assert.deepEqual(valueOf({ kind: "pair" }, "1,5; -2"), [1.5, -2]);
  const boolean = { kind: "switch", default: false, is_optional: true };
  assert.deepEqual(
    ["1", "0", ""].map((text) => valueOf(boolean, text)),
    [true, undefined, undefined],
  );
  assert.deepEqual(
    [undefined, true, [1, 2]].map((value) => textOf(boolean, value)),
    ["0", "1", "1"],
  );
  assert.equal(textOf(number, undefined), "5");
  assert.equal(textOf({ kind: "pair", default: null }, [1.5, -2]), "1.5, -2");
});

const link = (parent, origin, direction, more) => ({
  parent,
  origin,
  direction,
  is_rotary: false,
  per_unit: 1,
  ...more,
});
const placeIn = (matrix) => [12, 13, 14].map((n) => matrix[n]);

test("a link is carried by its parent: shifted by its slide, turned by its table", () => {
  const links = [
    link(null, [1, 2, 3], [1, 0, 0], { per_unit: 25.4 }),
    link(0, [0, 0, 10], [0, 0, 1], { is_rotary: true }),
    link(1, [5, 0, 0], [0, 1, 0]),
  ];
  const found = frames(links, [2, 90, 4]);
  const near = (matrix, expected) =>
    placeIn(matrix).forEach((each, n) => assert.ok(Math.abs(each - expected[n]) < 1e-12, `${placeIn(matrix)}`));
  near(found[0].fixed, [1, 2, 3]);
  near(found[0].moving, [51.8, 2, 3]);
  near(found[1].moving, [51.8, 2, 13]);
  near(found[2].fixed, [51.8, 7, 13]);
  near(found[2].moving, [47.8, 7, 13]);
});

test("a camera fits points beside the keys and knows which ones it shows", () => {
  const camera = new Camera();
  [camera.width, camera.height, camera.inset] = [500, 300, 100];
  camera.look("front");
  const seen = [
    [10, 5, 0],
    [210, -70, 20],
    [60, 0, 40],
  ];
  camera.fitPoints(seen);
  assert.ok(Math.abs(camera.scale - (0.86 * 400) / 200) < 1e-9);
  camera.project(110, 0, 20).forEach((each, n) => assert.ok(Math.abs(each - [200, 150][n]) < 1e-9));
  assert.ok(camera.shows(seen));
  const shows = ([x, y]) => camera.shows([[110 + x / camera.scale, 0, 20 + y / camera.scale]]);
  assert.deepEqual(
    [
      [-199, 0],
      [199, 0],
      [0, 149],
      [0, -149],
    ].map(shows),
    [true, true, true, true],
  );
  assert.deepEqual(
    [
      [-201, 0],
      [201, 0],
      [0, 151],
      [0, -151],
    ].map(shows),
    [false, false, false, false],
  );
});

test("UNDO leads to what was in force before, REDO to the latest that followed, and none is lost", () => {
  const sets = [
    { number: 1, before: 0 },
    { number: 2, before: 1 },
    { number: 3, before: 2 },
    { number: 4, before: 1 },
  ];
  assert.deepEqual(neighbours({ current: 4, sets }), { undo: 1, redo: 0, start: 1 });
  assert.deepEqual(neighbours({ current: 1, sets }), { undo: 0, redo: 4, start: 0 });
  assert.deepEqual(neighbours({ current: 2, sets }), { undo: 1, redo: 3, start: 1 });
  assert.deepEqual(neighbours({ current: 3, sets: [sets[0], sets[2]] }), { undo: 0, redo: 0, start: 1 }); // 2 is dropped
  assert.deepEqual(neighbours({ current: 0, sets: [] }), { undo: 0, redo: 0, start: 0 });
});

test("a kept measurement keeps its colour while it is shown, and another one gets a free one", () => {
  const first = inksOf(["b", "a"], new Map());
  assert.deepEqual(
    [...first],
    [
      ["b", INKS[0]],
      ["a", INKS[1]],
    ],
  );
  const next = inksOf(["a", "c"], first);
  assert.deepEqual([next.get("a"), next.get("c"), next.size], [INKS[1], INKS[0], 2]);
  assert.equal(inksOf([..."abcdefg"], new Map()).size, INKS.length);
});

test("a measurement is kept with a step only where that was made with the same gains", () => {
  const curve = { time_s: [0], setpoint_cnt: [1], actual_cnt: [1], output_v: [2] };
  const loop = { gains: { PGAIN: 1 }, filters: null, margins: {}, figures: {}, rms_error_cnt: 2, step: curve };
  const bode = { frequency_hz: [1], present: {}, measured: {}, motor: {}, proposed: {} };
  const found = { present: loop, proposed: loop, bode, time_s: 1, amplitude_cnt: 100, band_hz: [2, 60] };
  const trial = { figures: { rise_s: 1 }, measured: curve, predicted: null, set: 4 };
  const kept = keptOf(found, { axis: "X", at: "now", set: 4, trial });
  const bare = { time_s: [0], setpoint_cnt: [1], actual_cnt: [1] };
  assert.deepEqual(kept.trial, { figures: { rise_s: 1 }, measured: bare });
  assert.deepEqual(kept.present.step, bare);
  assert.deepEqual(Object.keys(kept.bode), ["frequency_hz", "present", "measured"]);
  assert.equal(keptOf(found, { axis: "X", at: "now", set: 5, trial }).trial, null);
  assert.equal(keptOf(found, { axis: "X", at: "now", set: 4, trial: null }).trial, null);
});

test("a measurement is proposed a name of its axis that is free", () => {
  assert.equal(freeName("X", ["Y 1"]), "X 1");
  assert.equal(freeName("X", ["X 1", "X 2", "X 4"]), "X 3");
});
