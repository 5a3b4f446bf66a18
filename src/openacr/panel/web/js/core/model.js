// What the browser knows of the machine: the last events and the last status frame.
import { BITS, readFlags, readScope, readStatus, readWatch, readWorld } from "./frames.js";
import { Signal } from "./signal.js";

/**
 * @typedef {{ name: string, index: number, unit: string, decimals: { mm: number, inch: number }, low: number | null,
 *   high: number | null, home_required: boolean }} Axis
 * @typedef {{ kind: string, name: string, card: string, unit: string, shown: string, is_small: boolean,
 *   is_virtual: boolean, axes: Axis[], lacks: string,
 *   attached: { name: string, index: number, master: number }[] }} Machine
 * @typedef {{ name: string, path: string, kind: string, lines: number, errors: number, warnings: number,
 *   checked: boolean, seconds: number | null,
 *   extents: Record<string, [number, number]> | null, tools: number[], id: string, drawn: boolean }} Loaded
 */

/**
 * @typedef {{ program?: number, plc?: number, line: number }} CodePlace of a program, or of a PLC
 * @typedef {{ why_not: string, breakpoints: (CodePlace & { condition: string })[],
 *   held: (CodePlace & { why: string, hit: number })[] }} Breakpoints
 *
 * @typedef {{ number: number, name: string, parent: number | null, fork: number | null, first: number,
 *   last: number | null }} TimeBranch
 * @typedef {{ why: string, period_s: number, still: boolean, away: boolean, speed: number | null, branch: number,
 *   most_bytes: number, branches: TimeBranch[],
 *   bookmarks: { tick: number, kind: string, text: string }[] }} Times
 */

const PRINTED = 200;
export const ROLES = Object.freeze(["view", "operate", "setup", "service"]);

/** The state of the machine as this browser has received it. */
export class Model {
  constructor() {
    this.hello = new Signal({
      version: "",
      client: 0,
      role: "view",
      login: false,
      local: false,
      machine: /** @type {Machine} */ ({
        kind: "",
        name: "",
        card: "",
        unit: "mm",
        shown: "mm",
        is_small: false,
        is_virtual: true,
        axes: [],
        lacks: "",
        attached: [],
      }),
      limits: { tick_ms: 200, keep_ms: 50, dead_man_ms: 200, stale_ms: 500, upload: 268435456 },
    });
    this.state = new Signal(
      /** @type {any} */ ({
        state: "IDLE",
        running: false,
        reason: "",
        options: {},
        asking: null,
        tool_wanted: false,
        mode: "auto",
        estop: { wired: false, on: false },
        link: "ok",
        can: {},
      }),
    );
    this.stopped = new Signal(
      /** @type {{ found: string[], holds: boolean, moving: string[], next: string }} */ ({
        found: [],
        holds: false,
        moving: [],
        next: "",
      }),
    );
    this.lamp = new Signal(
      /** @type {{ moving: string[], running: string[], drives: string[] }} */ ({
        moving: [],
        running: [],
        drives: [],
      }),
    );
    this.program = new Signal(
      /** @type {{ loaded: Loaded | null, loading: any, line: number, file: string, text: string, batch: any }} */ ({
        loaded: null,
        loading: null,
        line: 0,
        file: "",
        text: "",
        batch: null,
      }),
    );
    this.modals = new Signal(
      /** @type {any} */ ({ codes: [], F: 0, S: 0, T: 0, D: 0, H: 0, spindle: 5, coolant: 0, work: "G54" }),
    );
    this.alarms = new Signal(
      /** @type {{ active: any[], history: any[], bars_start: boolean }} */ ({
        active: [],
        history: [],
        bars_start: false,
      }),
    );
    this.messages = new Signal(/** @type {{ shown: any[] }} */ ({ shown: [] }));
    this.control = new Signal(/** @type {any} */ ({ holder: null, you: false, asking: [], clients: [] }));
    this.overrides = new Signal(/** @type {any} */ ({}));
    this.home = new Signal(/** @type {{ axes: any[] }} */ ({ axes: [] }));
    this.mdi = new Signal(
      /** @type {{ buffer: string[], on: boolean, running: boolean, queue: string[] }} */ ({
        buffer: [],
        on: true,
        running: false,
        queue: [],
      }),
    );
    this.timeline = new Signal(
      /** @type {Times} */ ({
        why: "",
        period_s: 0,
        still: false,
        away: false,
        speed: 1,
        branch: 0,
        most_bytes: 0,
        branches: [],
        bookmarks: [],
      }),
    );
    this.moment = new Signal(
      /** @type {{ tick: number, within: number, last: number, bytes: number,
       *   block: { path: string, line: number } | null, alarms: { active: any[], history: any[] } | null }} */ ({
        tick: 0,
        within: 0,
        last: 0,
        bytes: 0,
        block: null,
        alarms: null,
      }),
    );
    this.breakpoints = new Signal(/** @type {Breakpoints} */ ({ why_not: "", breakpoints: [], held: [] }));
    this.forced = new Signal(
      /** @type {{ why_not: string, inputs: number[], forced: { input: number, on: boolean, what: string }[] }} */ ({
        why_not: "",
        inputs: [],
        forced: [],
      }),
    );
    this.says = new Signal(/** @type {{ text: string, at_s: number, homing: boolean }[]} */ ([]));
    this.changed = new Signal(/** @type {{ what: string, cells: number[] }} */ ({ what: "", cells: [] }));
    this.jogEnded = new Signal(/** @type {{ press: number, ended: string, text: string } | null} */ (null));
    this.term = new Signal(/** @type {{ terminal: number, text: string } | null} */ (null));
    this.programs = new Signal(/** @type {{ programs: any[] }} */ ({ programs: [] }));
    /** The program whose text was stored last, on the card or in its project; "": several. */
    this.texts = new Signal(/** @type {{ name: string } | null} */ (null));
    this.listened = new Signal(/** @type {{ program: number, text: string } | null} */ (null));
    this.tuned = new Signal(/** @type {{ done: number, count: number } | null} */ (null));
    this.status = new Signal(/** @type {import("./frames.js").Status | null} */ (null));
    this.flags = new Signal(/** @type {Map<number, number>} */ (new Map()));
    this.watched = new Signal(/** @type {[number, number][]} */ ([]));
    this.capture = new Signal(/** @type {{ running: boolean, trigger?: number | null }} */ ({ running: false }));
    this.scope = new Signal(/** @type {ReturnType<typeof readScope> | null} */ (null));
    /** The long record that the panel keeps. */
    this.record = new Signal(/** @type {import("../scope/long_record.js").State} */ ({ number: 0, running: false }));
    this.world = new Signal(/** @type {import("./frames.js").World | null} */ (null));
    this.isStale = new Signal(true);
    /** Card time of the last status drawn on the screen, ms; motion is asked for with it. */
    this.drawnTick = Number.NaN;
    this.readAt = -Infinity; // browser time at which the values of the last frame were read
  }

  /** @returns {Axis[]} */
  get axes() {
    return this.hello.value.machine.axes;
  }

  /** @param {string} role */
  may(role) {
    return ROLES.indexOf(this.hello.value.role) >= ROLES.indexOf(role);
  }

  /** @param {keyof typeof BITS} name */
  is(name) {
    return ((this.status.value?.bits ?? 0) & BITS[name]) !== 0;
  }

  /** @param {any} message */
  takeEvent(message) {
    const { event, ...rest } = message;
    if (event === "say") this.says.set([...this.says.value, rest].slice(-PRINTED));
    else if (event === "says") this.says.set(rest.lines);
    else if (event === "scope") this.capture.set(rest);
    else if (event === "jog") this.jogEnded.set(rest);
    else if (event === "term") this.term.set(rest);
    else if (event === "listen") this.listened.set(rest);
    else if (event === "tune") this.tuned.set(rest);
    else if (event === "hello") this.hello.set({ ...this.hello.value, ...rest });
    else if (event === "machine") this.hello.set({ ...this.hello.value, machine: rest });
    else if (event in EVENTS) /** @type {Signal<any>} */ (Reflect.get(this, event)).set(rest);
  }

  /**
   * @param {import("./frames.js").Head} head
   * @param {ArrayBuffer} data
   */
  takeFrame(head, data) {
    if (head.topic === "status") {
      this.readAt = performance.now() - head.age;
      this.status.value = readStatus(data, head); // drawn with the next picture: see frame/clock.js
    } else if (head.topic === "flags") {
      for (const [word, value] of readFlags(data, head)) this.flags.value.set(word, value);
      this.flags.set(this.flags.value);
    } else if (head.topic === "watch") this.watched.set(readWatch(data, head));
    else if (head.topic === "scope") this.scope.set(readScope(data, head));
    else if (head.topic === "world") this.world.set(readWorld(data));
  }
}

const EVENTS = Object.freeze({
  state: 1,
  stopped: 1,
  lamp: 1,
  program: 1,
  modals: 1,
  alarms: 1,
  messages: 1,
  control: 1,
  overrides: 1,
  home: 1,
  mdi: 1,
  changed: 1,
  programs: 1,
  texts: 1,
  timeline: 1,
  moment: 1,
  breakpoints: 1,
  record: 1,
  forced: 1,
});
