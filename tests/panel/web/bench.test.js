// The workspace of the engineer: the shown part of the history, answers of the wizard, links of the machine.
import assert from "node:assert/strict";
import { test } from "node:test";
import { placeOf, rulerOf, secondsOf, within, zoomed } from "../../../src/openacr/panel/web/js/bench/time_view.js";
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
  assert.deepEqual(zoomed([100, 120], true, 110, [0, 1600]), [100, 120]);
  assert.deepEqual(zoomed([100, 105], true, 102, [0, 1600]), [100, 105]);
  assert.deepEqual([placeOf(150, [100, 200]), placeOf(7, [7, 7])], [50, 0]);
});

test("the ruler has round times", () => {
  assert.deepEqual(rulerOf([0, 2000], 0.0005, 6), [0, 0.2, 0.4, 0.6, 0.8, 1]);
  assert.deepEqual(rulerOf([500, 1500], 0.001, 4), [0.5, 1, 1.5]);
  assert.deepEqual(rulerOf([7, 7], 1, 4), []);
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
