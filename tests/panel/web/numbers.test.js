// Numbers: how they are shown, and sums that are typed.
import assert from "node:assert/strict";
import { test } from "node:test";
import { evaluate, numberIn, tidy } from "../../../src/openacr/panel/web/js/core/arithmetic.js";
import { ExpressionError, parse } from "../../../src/openacr/panel/web/js/core/expression.js";
import { duration, plain, position, size } from "../../../src/openacr/panel/web/js/core/format.js";

test("a position has a place for its sign and no sign at zero", () => {
  assert.equal(position(12.3456, 3), "\u200712.346");
  assert.equal(position(-0.5, 2), "\u22120.50");
  assert.equal(position(-0.0004, 3), "\u20070.000");
  assert.equal(position(Number.NaN, 3), "\u2013");
});

test("a plain number has a true minus and no sign at zero", () => {
  assert.equal(plain(-1234.5, 1), "\u22121234.5");
  assert.equal(plain(-0.4), "0");
  assert.equal(plain(2.5, 2), "2.50");
  assert.equal(plain(Infinity), "\u2013");
});

test("a duration is in minutes and seconds, from an hour on with hours", () => {
  const shown = [-3, 0, 59.4, 59.5, 3599, 3600, 36_061].map(duration);
  assert.deepEqual(shown, ["0:00", "0:00", "0:59", "1:00", "59:59", "1:00:00", "10:01:01"]);
  assert.equal(duration(Number.NaN), "\u2013");
});

test("a size is in bytes, from 1024 on in kB, from 1024 kB on in MB", () => {
  assert.deepEqual([1023, 1024, 1_048_575, 1_048_576].map(size), ["1023 B", "1.0 kB", "1024.0 kB", "1.0 MB"]);
});

test("a sum is computed with the signs and commas that people type", () => {
  assert.equal(evaluate("25.4*3/8"), 9.525);
  assert.equal(evaluate("0,1 + .2"), 0.3);
  assert.equal(evaluate("\u2212(2\u00d73) \u2013 1\u00f74"), -6.25);
  assert.equal(evaluate("-2--3"), 1);
  assert.equal(evaluate("+5 - +3"), 2);
  assert.equal(evaluate("8/4/2 - 3 - 2"), -4);
});

test("what is no sum, or has no value, is null", () => {
  for (const text of ["", "1+", "(1", "1)", "a", "1 2", "1/0", "0/0", "2**3"]) assert.equal(evaluate(text), null, text);
  assert.equal(tidy(0.1 + 0.2), "0.3");
});

test("an empty field has no number, a text that is none is refused with the name of the field", () => {
  assert.equal(numberIn({ value: " " }, "Feed"), null);
  assert.equal(numberIn({ value: "2*3" }, "Feed"), 6);
  assert.throws(() => numberIn({ value: "x" }, "Feed"), /^Error: Feed: /);
});

test("an expression is a tree in which products come before sums", () => {
  const known = { names: ["a"], functions: { max: 2 } };
  const number = (value) => ({ kind: "number", value });
  assert.deepEqual(parse("1 - 2*MAX(a, -3)", known), {
    kind: "call",
    name: "-",
    args: [
      number(1),
      {
        kind: "call",
        name: "*",
        args: [
          number(2),
          {
            kind: "call",
            name: "max",
            args: [
              { kind: "name", name: "a" },
              { kind: "call", name: "neg", args: [number(3)] },
            ],
          },
        ],
      },
    ],
  });
});

test("a text that is no expression is refused with the word at which that is seen", () => {
  const known = { names: ["ch1"], functions: { min: 2, abs: 1 } };
  const words = {
    "": "",
    "ch1 +": "",
    ch3: "ch3",
    "ch1 ch1": "ch1",
    "abs ch1": "ch1",
    "min(ch1)": ")",
    "abs(ch1, ch1)": ",",
    "(ch1": "",
    "ch1)": ")",
    "ch1 = 2": "=",
    constructor: "constructor",
    "ch1.x": ".",
    "toString(ch1)": "toString",
    "1e3": "e3",
  };
  for (const [text, what] of Object.entries(words)) {
    assert.throws(
      () => parse(text, known),
      (error) => error instanceof ExpressionError && error.what === what,
      text,
    );
  }
});
