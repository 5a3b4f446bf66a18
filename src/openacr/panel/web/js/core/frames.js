// Binary frames of the server: typed views of what arrived, without a copy.

const TOPICS = Object.freeze({ 1: "status", 2: "flags", 3: "watch", 4: "scope", 5: "world" });
export const STATES = Object.freeze(["IDLE", "RUN", "WAIT", "HOMING", "PAUSED", "HOLD", "ALARM"]);
export const BITS = Object.freeze({
  busy: 1,
  moving: 2,
  dry: 4,
  single: 8,
  alarm: 16,
  estop: 32,
  linkLost: 64,
  skip: 128,
  optional: 256,
  spindle: 512,
  flood: 1024,
  mist: 2048,
  toolChange: 4096,
  question: 8192,
  held: 16384,
});
const HEAD = 24;
const PLACES = 112;

/**
 * @typedef {{ topic: string, count: number, seq: number, tick: number, age: number }} Head
 * @typedef {ReturnType<typeof readStatus>} Status
 * @typedef {{ commands: Record<string, boolean | number>, signals: Record<string, boolean | number> }} DeviceState
 * @typedef {{ axis: number, kind: string, value: number }} Fault
 * @typedef {{ positions: number[], on: number[], forced: number[], faults: Fault[], devices: DeviceState[] }} World
 */

/**
 * @param {ArrayBuffer} data
 * @returns {Head}
 */
export function readHead(data) {
  const view = new DataView(data);
  const topic = TOPICS[/** @type {1} */ (view.getUint8(0))] ?? "";
  return {
    topic,
    count: view.getUint16(2, true),
    seq: view.getUint32(4, true),
    tick: view.getFloat64(8, true),
    age: view.getFloat64(16, true),
  };
}

/**
 * Positions are in the unit of the machine, feeds per minute; NaN where nothing is known.
 * @param {ArrayBuffer} data
 * @param {Head} head
 */
export function readStatus(data, head) {
  const view = new DataView(data);
  const axes = (/** @type {number} */ block) => new Float64Array(data, PLACES + 8 * head.count * block, head.count);
  const real = (/** @type {number} */ at) => view.getFloat64(at, true);
  return {
    tick: head.tick,
    age: head.age,
    state: STATES[view.getUint8(24)] ?? "ALARM",
    homed: view.getUint8(25),
    jogging: view.getUint8(26),
    limit: view.getUint8(27),
    bits: view.getUint32(28, true),
    line: view.getUint32(32, true),
    tool: view.getUint32(36, true),
    feedSet: real(40),
    feedActual: real(48),
    spindle: real(56),
    fov: real(64),
    rov: real(72),
    sov: real(80),
    runTime: real(88),
    timeLeft: real(96),
    parts: real(104),
    work: axes(0),
    machine: axes(1),
    actual: axes(2),
    following: axes(3),
    toGo: axes(4),
    next: axes(5),
  };
}

/**
 * Parameter numbers with the values of their flag words.
 * @param {ArrayBuffer} data
 * @param {Head} head
 * @returns {[number, number][]}
 */
export function readFlags(data, head) {
  const words = new Uint32Array(data, HEAD, 2 * head.count);
  return Array.from({ length: head.count }, (_each, n) => [words[2 * n], words[2 * n + 1]]);
}

/**
 * Places in the list of watched parameters with their values.
 * @param {ArrayBuffer} data
 * @param {Head} head
 * @returns {[number, number][]}
 */
export function readWatch(data, head) {
  const places = new Uint32Array(data, HEAD, head.count);
  const values = new Float64Array(data, HEAD + 8 * Math.ceil(head.count / 2), head.count);
  return Array.from({ length: head.count }, (_each, n) => [places[n], values[n]]);
}

/**
 * New samples of the scope, channel by channel.
 * @param {ArrayBuffer} data
 * @param {Head} head
 */
export function readScope(data, head) {
  const view = new DataView(data);
  const samples = view.getUint32(HEAD + 8, true);
  const channel = (/** @type {number} */ n) => new Float64Array(data, HEAD + 24 + 8 * n * samples, samples);
  return {
    first: view.getFloat64(HEAD, true),
    period: view.getFloat64(HEAD + 16, true),
    channels: Array.from({ length: head.count }, (_each, n) => channel(n)),
  };
}

/**
 * The state of the world around the card.
 * @param {ArrayBuffer} data
 * @returns {World}
 */
export function readWorld(data) {
  return JSON.parse(new TextDecoder().decode(new Uint8Array(data, HEAD)));
}
