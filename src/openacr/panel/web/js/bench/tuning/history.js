// What was changed of some named values, with undo, redo, and the values at the start.

/** @typedef {{ name: string, before: number, after: number, at: Date }} Change */

export class History {
  constructor() {
    /** @type {Change[]} */
    this.done = [];
    /** @type {Change[]} */
    this.undone = [];
  }

  /**
   * A value has been changed.
   * @param {string} name
   * @param {number} before
   * @param {number} after
   * @param {Date} [at]
   */
  note(name, before, after, at = new Date()) {
    if (before === after) return;
    this.done.push({ name, before, after, at });
    this.undone = [];
  }

  /**
   * The change that was undone: its value before is to be set.
   * @returns {Change | undefined}
   */
  undo() {
    const change = this.done.pop();
    if (change) this.undone.push(change);
    return change;
  }

  /**
   * The change that is done again.
   * @returns {Change | undefined}
   */
  redo() {
    const change = this.undone.pop();
    if (change) this.done.push(change);
    return change;
  }

  /**
   * Go back until a number of changes is left; the values that are to be set, by name.
   * @param {number} count
   * @returns {Map<string, number>}
   */
  backTo(count) {
    /** @type {Map<string, number>} */
    const found = new Map();
    while (this.done.length > count) {
      const change = this.undo();
      if (change) found.set(change.name, change.before);
    }
    return found;
  }

  /**
   * Values as they were at the start, of what has been changed since.
   * @returns {Map<string, number>}
   */
  atStart() {
    /** @type {Map<string, number>} */
    const found = new Map();
    for (const { name, before } of this.done) if (!found.has(name)) found.set(name, before);
    return found;
  }
}
