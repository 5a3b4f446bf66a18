// Keys with a text: buttons of the screens.
import { h } from "./dom.js";
import { inEnglish, t } from "./texts.js";

/** What is before the text of a key; without it, nothing. @type {(...names: string[]) => Element | null} */
let symbolOf = () => null;

/**
 * Have keys show symbols before their texts.
 * @param {(...names: string[]) => Element | null} of the symbol of a command by its names: its key among the texts, if
 *   it has one, and its English text
 */
export function showSymbols(of) {
  symbolOf = of;
}

/**
 * @param {import("./texts.js").Said} label
 * @param {(event: any) => unknown} onclick
 * @param {string} [kind] more classes, a point before each: ".big.main"
 * @param {Record<string, any>} [more] as of `h`
 */
export function keyOf(label, onclick, kind = "", more = {}) {
  const key = h(/** @type {"button"} */ (`button.key${kind}`), { type: "button", onclick, ...more });
  relabel(key, label);
  return key;
}

/**
 * Give a key another text, with the symbol of what it does then.
 * @param {HTMLElement} key
 * @param {import("./texts.js").Said} label
 * @param {Record<string, string | number>} [values] as of `t`
 */
export function relabel(key, label, values) {
  const text = t(label, values);
  if (key.textContent === text) return;
  const symbol = symbolOf(typeof label === "string" ? label : "", inEnglish(label).replaceAll("\u00ad", ""));
  key.classList.toggle("has-symbol", symbol !== null);
  if (symbol) key.replaceChildren(symbol, h("span.key-text", {}, text));
  else key.textContent = text;
  if (symbol && !key.title) key.title = text.replaceAll("\u00ad", "");
}
