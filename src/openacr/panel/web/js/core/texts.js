// What the screens say, in every language: texts that modules share have keys, the others are written where
// they are used.
import shared from "../catalog/operator.js";

/**
 * @typedef {{ en: string, de: string }} Text
 * @typedef {keyof typeof shared | keyof typeof import("../catalog/bench.js").default | `${string}.${string}`} TextKey the last: names of commands
 * @typedef {Text | TextKey} Said
 * @typedef {keyof typeof LANGUAGES} Language
 */

export const LANGUAGES = Object.freeze({ en: "English", de: "Deutsch" });
/** Titles of the commands by their names, which the page brings. @type {Record<string, Text>} */
const titles = JSON.parse(globalThis.document?.querySelector("meta[name=titles]")?.getAttribute("content") ?? "{}");
/** @type {Record<string, Text>} */
let catalogue = { ...shared, ...titles };
/** @type {Language} */
let chosen = "en";

/** @param {string} language any other than those of LANGUAGES: English */
export function useLanguage(language) {
  if (language in LANGUAGES) chosen = /** @type {Language} */ (language);
  document.documentElement.lang = language;
}

/** The chosen language. */
export const language = () => chosen;

/**
 * Add the texts of another workspace.
 * @param {Record<string, Text>} texts
 */
export function addTexts(texts) {
  catalogue = { ...catalogue, ...texts };
}

/**
 * A text, given as it is or by its key, with its values filled in: `t("zero.done", { axes: "X Y" })`.
 * `{count|line|lines}` is the first word for a value of 1, else the second.
 * @param {Said} what
 * @param {Record<string, string | number>} [values]
 */
export function t(what, values = {}) {
  const text = typeof what === "string" ? textOr(what, what) : what[chosen];
  return text.replace(/\{(\w+)(?:\|([^|}]*)\|([^|}]*))?\}/g, (_whole, name, one, more) => {
    const value = String(values[name] ?? "");
    return one === undefined ? value : value === "1" ? one : more;
  });
}

/**
 * A text in English, whatever language is chosen: the name by which tables find what is said.
 * @param {Said} what
 */
export function inEnglish(what) {
  return typeof what === "string" ? (catalogue[what]?.en ?? what) : what.en;
}

/**
 * The text of a key that is made at run time, or the fallback where there is none.
 * @param {string} key
 * @param {string} fallback
 */
export function textOr(key, fallback) {
  return catalogue[key]?.[chosen] ?? fallback;
}
