// How other panes add to the watch list.
import { Signal } from "../core/signal.js";
import { openPane } from "./workspace.js";

/** What is to be added to the watch list, e.g. ["P12288"]. */
export const wanted = new Signal(/** @type {string[]} */ ([]));

/** @param {string} id of a parameter or flag */
export function addToWatchList(id) {
  wanted.set([...wanted.value, id]);
  openPane("watch");
}
