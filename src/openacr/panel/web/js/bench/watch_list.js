// How other panes add to the watch list.
import { want } from "./wanted.js";

/** @param {string} id of a parameter or flag, e.g. P12288 */
export function addToWatchList(id) {
  want("watch", id);
}
