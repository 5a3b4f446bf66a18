// Values that tell their listeners when they change.

/**
 * A value with listeners. Setting it calls them; a new listener is called at once.
 * @template T
 */
export class Signal {
  /** @param {T} value */
  constructor(value) {
    this.value = value;
    /** @type {Set<(value: T) => void>} */
    this.listeners = new Set();
  }

  /** @param {T} value */
  set(value) {
    this.value = value;
    for (const listener of [...this.listeners]) listener(value);
  }

  /**
   * Listen; returns the function that ends it.
   * @param {(value: T) => void} listener
   */
  watch(listener) {
    this.listeners.add(listener);
    listener(this.value);
    return () => void this.listeners.delete(listener);
  }
}

/** What a screen has to end when it closes. */
export class Endings {
  constructor() {
    /** @type {(() => void)[]} */
    this.list = [];
  }

  /** @param {...(() => void)} ends */
  add(...ends) {
    this.list.push(...ends);
  }

  end() {
    for (const each of this.list.splice(0)) each();
  }
}
