// A text in step with the server, which answers questions about it: sent whole once, then by its changes.
import { send } from "../core/api.js";

const SLOW = new Set(["findings", "formatted", "stored", "compare"]); // in a process of their own

/**
 * @typedef {import("../../vendor/codemirror.js").Text} Text
 * @typedef {import("../../vendor/codemirror.js").ChangeSet} ChangeSet
 * @typedef {{ answer: any, refusal?: string, doc: Text }} Answered
 * @typedef {{ ask: string, about: object, done: (found: Answered | null) => void }} Question
 */

/** One process of the server: what it has of the text, and the questions that wait for it. */
class Channel {
  constructor() {
    this.version = 0; // 0: it has nothing
    /** @type {Text | null} */
    this.doc = null;
    /** @type {ChangeSet | null} */
    this.changes = null;
    /** @type {Map<string, Question>} */
    this.waiting = new Map();
    this.isBusy = false;
  }
}

export class SyncedText {
  /**
   * @param {string} name of the file; prog3.8k and plc0.8k are programs of the card
   * @param {string} setup what a program finds on the card, as set-up code
   * @param {Text} doc
   */
  constructor(name, setup, doc) {
    this.name = name;
    this.setup = setup;
    this.doc = doc;
    this.version = 1;
    this.mark = Array.from(crypto.getRandomValues(new Uint8Array(12)), (byte) =>
      byte.toString(16).padStart(2, "0"),
    ).join("");
    this.quick = new Channel();
    this.slow = new Channel();
    this.isEnded = false;
  }

  /**
   * The text has changed.
   * @param {ChangeSet} changes
   * @param {Text} doc
   */
  changed(changes, doc) {
    this.version += 1;
    this.doc = doc;
    for (const channel of [this.quick, this.slow])
      channel.changes = channel.changes ? channel.changes.compose(changes) : changes;
  }

  end() {
    this.isEnded = true;
    for (const channel of [this.quick, this.slow]) for (const each of channel.waiting.values()) each.done(null);
  }

  /**
   * Ask about the text as it is when the question is sent; null where a newer question has taken its place.
   * @param {string} ask
   * @param {object} [about]
   * @returns {Promise<Answered | null>}
   */
  ask(ask, about = {}) {
    if (this.isEnded) return Promise.resolve(null);
    const channel = SLOW.has(ask) ? this.slow : this.quick;
    channel.waiting.get(ask)?.done(null);
    return new Promise((done) => {
      channel.waiting.set(ask, { ask, about, done });
      void this.pump(channel);
    });
  }

  /** @param {Channel} channel */
  async pump(channel) {
    const [next] = channel.waiting.values();
    if (channel.isBusy || !next || this.isEnded) return;
    channel.waiting.delete(next.ask);
    channel.isBusy = true;
    const [doc, version] = [this.doc, this.version];
    const changed =
      channel.version && channel.doc
        ? { base: channel.version, changes: channel.changes ? changesOf(channel.changes, channel.doc) : [] }
        : null;
    channel.changes = null;
    channel.doc = doc;
    channel.version = 0;
    const state = { mark: this.mark, name: this.name, version };
    const whole = () => ({ ...state, text: doc.toString(), setup: this.setup });
    try {
      let found = await this.sent(next, changed ? { ...state, ...changed } : whole());
      if (found.stale) found = await this.sent(next, whole());
      channel.version = version;
      next.done({ ...found, doc });
    } catch {
      next.done(null); // out of reach: it is asked again with the next change
    }
    channel.isBusy = false;
    void this.pump(channel);
  }

  /**
   * @param {Question} question
   * @param {object} state
   */
  sent({ ask, about }, state) {
    return ask === "compare"
      ? send("POST", "text/compare", { ...state, ...about })
      : send("POST", "text", { ...state, ask, ...about });
  }
}

/**
 * Changes from the last to the first, so that places of one hold when those after it are made.
 * @param {ChangeSet} changes
 * @param {Text} before
 */
function changesOf(changes, before) {
  /** @type {(number | string)[][]} */
  const found = [];
  changes.iterChanges((from, to, _fromNew, _toNew, inserted) =>
    found.unshift([...placeOf(before, from), ...placeOf(before, to), inserted.toString()]),
  );
  return found;
}

/**
 * Line and column from 0.
 * @param {Text} doc
 * @param {number} at
 * @returns {[number, number]}
 */
export function placeOf(doc, at) {
  const line = doc.lineAt(at);
  return [line.number - 1, at - line.from];
}

/**
 * The offsets of a span of the server; what the text no longer has is at its end.
 * @param {Text} doc
 * @param {number[]} span line and column, line and column, from 0
 */
export function offsetsOf(doc, [line, column, lastLine, lastColumn]) {
  const at = (/** @type {number} */ number, /** @type {number} */ place) => {
    if (number >= doc.lines) return doc.length;
    const found = doc.line(number + 1);
    return Math.min(found.to, found.from + place);
  };
  return { from: at(line, column), to: at(lastLine, lastColumn) };
}
