// What was changed of some named values, with undo, redo, and the values at the start.

/** @typedef {{ name: string, before: number, after: number }} Change */

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
   */
  note(name, before, after) {
    if (before === after) return;
    this.done.push({ name, before, after });
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
