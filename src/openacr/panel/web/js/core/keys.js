// Keys with a text: buttons of the screens.
import { h } from "./dom.js";
import { t } from "./texts.js";

/**
 * @param {import("./texts.js").Said} label
 * @param {(event: any) => unknown} onclick
 * @param {string} [kind] more classes, a point before each: ".big.main"
 * @param {Record<string, any>} [more] as of `h`
 */
export function keyOf(label, onclick, kind = "", more = {}) {
  return h(/** @type {"button"} */ (`button.key${kind}`), { type: "button", onclick, ...more }, t(label));
}
