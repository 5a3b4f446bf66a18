// What comes from the server: binary frames, replies in another order, values with listeners.
import assert from "node:assert/strict";
import { test } from "node:test";
import { latest } from "../../../src/openacr/panel/web/js/core/api.js";
import {
  readFlags,
  readHead,
  readScope,
  readStatus,
  readWatch,
  readWorld,
} from "../../../src/openacr/panel/web/js/core/frames.js";
import { Endings, Signal } from "../../../src/openacr/panel/web/js/core/signal.js";

/** A frame: its head, then fields by their offsets as [setter, offset, value]. */
function frame(topic, count, length, fields = []) {
  const data = new ArrayBuffer(length);
  const view = new DataView(data);
  view.setUint8(0, topic);
  view.setUint8(1, 1);
  view.setUint16(2, count, true);
  view.setUint32(4, 77, true);
  view.setFloat64(8, 1234.5, true);
  view.setFloat64(16, 2.25, true);
  for (const [set, at, value] of fields) view[`set${set}`](at, value, true);
  return data;
}

test("the head of a frame names its topic, of one that is not known with nothing", () => {
  assert.deepEqual(readHead(frame(4, 3, 24)), { topic: "scope", count: 3, seq: 77, tick: 1234.5, age: 2.25 });
  assert.equal(readHead(frame(99, 0, 24)).topic, "");
});

test("a status has each field at its offset and its axes block by block", () => {
  const places = Array.from({ length: 12 }, (_each, n) => ["Float64", 112 + 8 * n, n + 0.5]);
  const reals = Array.from({ length: 9 }, (_each, n) => ["Float64", 40 + 8 * n, 100 + n]);
  const data = frame(1, 2, 208, [
    ["Uint8", 24, 5],
    ["Uint8", 25, 1],
    ["Uint8", 26, 2],
    ["Uint8", 27, 3],
    ["Uint32", 28, 0x8001],
    ["Uint32", 32, 17],
    ["Uint32", 36, 4],
    ...reals,
    ...places,
  ]);
  const found = readStatus(data, readHead(data));
  const { work, machine, actual, following, toGo, next, ...rest } = found;
  assert.deepEqual(rest, {
    tick: 1234.5,
    age: 2.25,
    state: "HOLD",
    homed: 1,
    jogging: 2,
    limit: 3,
    bits: 0x8001,
    line: 17,
    tool: 4,
    feedSet: 100,
    feedActual: 101,
    spindle: 102,
    fov: 103,
    rov: 104,
    sov: 105,
    runTime: 106,
    timeLeft: 107,
    parts: 108,
  });
  assert.deepEqual(
    [work, machine, actual, following, toGo, next].map((each) => [...each]),
    [
      [0.5, 1.5],
      [2.5, 3.5],
      [4.5, 5.5],
      [6.5, 7.5],
      [8.5, 9.5],
      [10.5, 11.5],
    ],
  );
  new DataView(data).setUint8(24, 99);
  assert.equal(readStatus(data, readHead(data)).state, "ALARM");
});

test("flag words and watched values come in pairs, values at a multiple of 8", () => {
  const flags = frame(2, 2, 40, [
    ["Uint32", 24, 4096],
    ["Uint32", 28, 0xffffffff],
    ["Uint32", 32, 4100],
    ["Uint32", 36, 1],
  ]);
  assert.deepEqual(readFlags(flags, readHead(flags)), [
    [4096, 0xffffffff],
    [4100, 1],
  ]);
  const watch = frame(3, 1, 40, [
    ["Uint32", 24, 6],
    ["Float64", 32, -1.5],
  ]);
  assert.deepEqual(readWatch(watch, readHead(watch)), [[6, -1.5]]);
});

test("samples of the scope come channel by channel", () => {
  const values = Array.from({ length: 6 }, (_each, n) => ["Float64", 48 + 8 * n, n]);
  const data = frame(4, 2, 96, [["Float64", 24, 1000], ["Uint32", 32, 3], ["Float64", 40, 0.002], ...values]);
  const { first, period, channels } = readScope(data, readHead(data));
  assert.deepEqual(
    [first, period, channels.map((each) => [...each])],
    [
      1000,
      0.002,
      [
        [0, 1, 2],
        [3, 4, 5],
      ],
    ],
  );
});

test("the world is JSON after the head", () => {
  const text = new TextEncoder().encode('{"positions":[1]}');
  const data = frame(5, 0, 24 + text.length);
  new Uint8Array(data).set(text, 24);
  assert.deepEqual(readWorld(data), { positions: [1] });
});

test("of replies in another order the newest counts, until the end", async () => {
  const endings = new Endings();
  const newest = latest(endings);
  const asked = [];
  const ask = () => newest(new Promise((give, refuse) => asked.push({ give, refuse })));
  const three = [ask(), ask(), ask()];
  asked[2].give("third");
  asked[0].give("first");
  asked[1].refuse(new Error("second"));
  assert.deepEqual(await Promise.all(three), [undefined, undefined, "third"]);
  const refused = ask();
  asked[3].refuse(new Error("no"));
  await assert.rejects(refused, /^Error: no$/);
  const late = ask();
  endings.end();
  asked[4].give("late");
  assert.equal(await late, undefined);
});

test("a listener is called at once and with each value until it ends", () => {
  const [signal, heard] = [new Signal(1), []];
  const end = signal.watch((value) => heard.push(value));
  signal.set(2);
  end();
  signal.set(3);
  assert.deepEqual([heard, signal.value], [[1, 2], 3]);
});

test("endings are called once, in their order", () => {
  const [endings, called] = [new Endings(), []];
  endings.add(
    () => called.push("a"),
    () => called.push("b"),
  );
  endings.end();
  endings.end();
  assert.deepEqual(called, ["a", "b"]);
});
