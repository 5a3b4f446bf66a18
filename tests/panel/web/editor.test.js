// The editor of the workspace: the values beside lines.
import assert from "node:assert/strict";
import { test } from "node:test";
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

test("a line shows each value by its name, the tooltip what the name stands for", () => {
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
