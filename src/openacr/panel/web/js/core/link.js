// The one WebSocket to the server: commands with answers, credits, and a replacement when it is silent.
import { readHead } from "./frames.js";
import { Signal } from "./signal.js";

const LATE_MS = 150; // an answer that takes longer is waited for visibly
const SILENT_MS = 1000; // before the server has named its limits
const AGAIN_MS = [100, 300, 1000, 2000];

/**
 * @typedef {{ code: string, text: string, field?: string | null, needs?: string, holder?: any }} Refusal
 * @typedef {{ topic: string, [key: string]: any }} Topic
 */

/** A command that was not carried out; `code` as the server names it, or "lost". */
export class CommandError extends Error {
  /** @param {Refusal} refusal */
  constructor(refusal) {
    super(refusal.text);
    this.code = refusal.code;
    this.refusal = refusal;
  }
}

/** Connection to the server. Commands are never kept for a later connection. */
export class Link {
  /** @param {string} url */
  constructor(url) {
    this.url = url;
    this.isOpen = new Signal(false);
    /** @type {(event: any) => void} */
    this.onEvent = () => {};
    /** @type {(head: import("./frames.js").Head, data: ArrayBuffer) => void} */
    this.onFrame = () => {};
    /** @type {WebSocket | null} */
    this.socket = null;
    /** @type {Map<number, { done: (result: any) => void, fail: (error: Error) => void }>} */
    this.waiting = new Map();
    /** Commands that were not answered at once. @type {Set<number>} */
    this.late = new Set();
    this.isLate = new Signal(false); // a command waits for its answer
    /** @type {Map<string, Topic>} */
    this.topics = new Map();
    this.lastId = 0;
    this.tries = 0;
    this.heardAt = 0;
    /** The silence after which the connection is replaced, ms. */
    this.silentMs = SILENT_MS;
    this.isEnded = false;
  }

  open() {
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.opened(socket);
    socket.onmessage = (message) => this.heard(socket, message.data);
    socket.onclose = (event) => this.lost(socket, event.code);
    this.socket = socket;
    this.heardAt = performance.now();
    clearInterval(this.watchdog);
    this.watchdog = setInterval(() => this.replaceSilent(), 200);
  }

  /** @param {WebSocket} socket */
  opened(socket) {
    if (socket !== this.socket) return;
    this.tries = 0;
    this.heardAt = performance.now();
    this.isOpen.set(true);
    for (const topic of this.topics.values()) void this.command("sub", topic).catch(() => {});
  }

  /** Replace the connection by a new one. */
  renew() {
    const socket = this.socket;
    if (!socket) return; // a new one is on its way
    socket.close();
    this.lost(socket, 0);
  }

  /** A dead peer is not waited for: `close()` alone would take minutes. */
  replaceSilent() {
    const socket = this.socket;
    if (!socket || performance.now() - this.heardAt < this.silentMs) return;
    if (socket.readyState === WebSocket.OPEN && !this.topics.has("status")) return;
    this.renew();
  }

  /**
   * @param {WebSocket} socket
   * @param {number} code
   */
  lost(socket, code) {
    if (socket !== this.socket) return;
    this.socket = null;
    clearInterval(this.watchdog);
    this.isOpen.set(false);
    for (const each of this.waiting.values()) each.fail(lostError());
    this.waiting.clear();
    this.settle();
    if (code === 4401) window.location.assign("/login");
    else if (!this.isEnded && code !== 4403)
      setTimeout(() => this.open(), AGAIN_MS[Math.min(this.tries++, AGAIN_MS.length - 1)]);
  }

  /**
   * @param {WebSocket} socket
   * @param {string | ArrayBuffer} data
   */
  heard(socket, data) {
    if (socket !== this.socket) return;
    this.heardAt = performance.now();
    if (typeof data === "string") {
      this.answered(JSON.parse(data));
      return;
    }
    const head = readHead(data);
    this.send({ ack: head.topic, seq: head.seq });
    this.onFrame(head, data);
  }

  /** @param {any} message */
  answered(message) {
    if (message.event) {
      this.onEvent(message);
      return;
    }
    const call = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    this.settle(message.id);
    if (message.ok) call?.done(message.result ?? {});
    else call?.fail(new CommandError(message.error));
  }

  /**
   * Send a command; the promise is rejected with a CommandError when it is refused.
   * @param {string} cmd
   * @param {Record<string, any>} [args]
   * @returns {Promise<any>}
   */
  command(cmd, args = {}) {
    const id = ++this.lastId;
    return new Promise((done, fail) => {
      if (!this.send({ id, cmd, args })) fail(lostError());
      else this.waiting.set(id, { done, fail });
      setTimeout(() => {
        if (!this.waiting.has(id)) return;
        this.late.add(id);
        this.isLate.set(true);
      }, LATE_MS);
    });
  }

  /**
   * A command waits no more; without a number: all of them.
   * @param {number} [id]
   */
  settle(id) {
    if (id === undefined) this.late.clear();
    else this.late.delete(id);
    if (this.isLate.value !== this.late.size > 0) this.isLate.set(this.late.size > 0);
  }

  /**
   * Send a message without an answer; false when there is no connection.
   * @param {object} message
   */
  send(message) {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  /**
   * Subscribe a topic, now and after every reconnection; returns the function that ends it.
   * @param {Topic} topic
   */
  subscribe(topic) {
    this.topics.set(topic.topic, topic);
    if (this.isOpen.value) void this.command("sub", topic).catch(() => {});
    return () => {
      if (this.topics.get(topic.topic) !== topic) return;
      this.topics.delete(topic.topic);
      if (this.isOpen.value) void this.command("unsub", { topic: topic.topic }).catch(() => {});
    };
  }
}

function lostError() {
  return new CommandError({ code: "lost", text: "the panel has no connection to the controller" });
}
