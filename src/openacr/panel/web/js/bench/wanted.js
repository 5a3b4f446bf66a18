// What other panes want a pane to show: parameters and flags for watch list, scope and timeline, a line for the editor.
import { Signal } from "../core/signal.js";
import { openPane } from "./workspace.js";

/** By pane: what it has not taken yet, e.g. ["P12288"]; of the editor ["PROG3", "120"], or
 * ["PROG3", "", "read"] to read it anew, of the cross reference ["speed"]. */
const WANTED = {
  watch: new Signal(/** @type {string[]} */ ([])),
  scope: new Signal(/** @type {string[]} */ ([])),
  timeline: new Signal(/** @type {string[]} */ ([])),
  tree: new Signal(/** @type {string[]} */ ([])),
  editor: new Signal(/** @type {string[]} */ ([])),
  uses: new Signal(/** @type {string[]} */ ([])),
};

/** @typedef {keyof typeof WANTED} Taker */

const ONE_AT_A_TIME = new Set(["editor", "tree", "uses"]);

/**
 * Have a pane take something; it is opened where it is not.
 * @param {Taker} pane
 * @param {...string} what
 */
export function want(pane, ...what) {
  WANTED[pane].set(ONE_AT_A_TIME.has(pane) ? what : [...WANTED[pane].value, ...what]);
  openPane(pane);
}

/**
 * Take what is wanted of a pane, now and later; returns the function that ends it.
 * @param {Taker} pane
 * @param {(what: string[]) => void} take
 */
export function takeWanted(pane, take) {
  return WANTED[pane].watch((what) => {
    if (!what.length) return;
    WANTED[pane].value = [];
    take(what);
  });
}
