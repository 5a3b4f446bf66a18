// The editor of the workspace: the values beside lines; the keyboard in ladders.
import assert from "node:assert/strict";
import { test } from "node:test";
import { neighbourOf } from "../../../src/openacr/panel/web/js/draw/ladder_keys.js";
import { parted, saidOf } from "../../../src/openacr/panel/web/js/bench/editor/line_texts.js";

/** @type {(program: string, ...names: (string | [string, string])[]) => any} */
const line = (program, ...names) => ({
  program,
  names: names.map((each) => (Array.isArray(each) ? each : [each, each])),
});

test("what lines name comes from parameters, flags and the variables of their program, each once", () => {
  assert.deepEqual(parted([line("PROG3", "P5", "BIT5", "LV0"), line("PROG12", "LV0", "P5", ["speed", "SA0(2)"])]), {
    numbers: [5],
    flags: [5],
    locals: { PROG3: ["LV0"], PROG12: ["LV0", "SA0(2)"] },
  });
  assert.deepEqual(parted([line("PLC0", "BIT7", "LV0"), line("SYS", "$V1")]), { numbers: [], flags: [7], locals: {} });
  const many = line("PROG0", ...Array.from({ length: 61 }, (_each, n) => `LV${n}`));
  assert.equal(parted([many]).locals.PROG0.length, 60);
});

test("a line shows each value by its name, the tooltip what each name means", () => {
  const values = /** @type {Record<string, string>} */ ({ "PROG3 P0": "2.5", "PROG3 $V0": `'${"x".repeat(30)}'` });
  const valueOf = (/** @type {string} */ program, /** @type {string} */ name) => values[`${program} ${name}`];
  assert.deepEqual(saidOf(line("PROG3", ["speed", "P0"], "LV0"), valueOf), {
    text: "speed = 2.5   LV0 = –",
    all: "speed (P0) = 2.5\nLV0 = –",
  });
  const long = saidOf(line("PROG3", "$V0"), valueOf);
  assert.equal(long?.text, `$V0 = '${"x".repeat(22)}…`);
  assert.equal(long?.all, `$V0 = '${"x".repeat(30)}'`);
  assert.equal(saidOf(line("PROG3"), valueOf), null);
});

test("arrow keys go along a rung, and up and down to the nearest symbol", () => {
  const at = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ rung) => ({ x, y, rung });
  // two contacts and a coil, a branch below the first contact; then a rung of two
  const symbols = [at(50, 30, 0), at(150, 30, 0), at(250, 30, 0), at(50, 100, 0), at(50, 170, 1), at(150, 170, 1)];
  const to = (/** @type {number} */ from, /** @type {string} */ key) => neighbourOf(symbols, from, `Arrow${key}`);
  assert.deepEqual(
    [0, 1, 2].map((n) => to(n, "Right")),
    [1, 2, 2],
  );
  assert.deepEqual(
    [0, 1, 2].map((n) => to(n, "Left")),
    [0, 0, 1],
  );
  assert.deepEqual(
    [0, 3, 4].map((n) => to(n, "Down")),
    [3, 4, 4],
  );
  assert.deepEqual(
    [5, 4, 3, 0].map((n) => to(n, "Up")),
    [3, 3, 0, 0],
  );
  assert.equal(to(5, "Right"), 5);
  assert.equal(to(4, "Left"), 4);
  assert.equal(neighbourOf([], 0, "ArrowLeft"), 0);
});
