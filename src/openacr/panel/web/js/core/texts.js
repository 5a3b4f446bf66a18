// One catalogue of texts per language; a key that a language lacks is shown in English.
import en from "../catalog/en.js";

/** @typedef {keyof typeof en | keyof typeof import("../catalog/bench/en.js").default | `${string}.${string}`} TextKey the last: names of commands */

export const LANGUAGES = Object.freeze({ en: "English", de: "Deutsch" });
/** Titles of the commands by language, which the page brings. @type {Record<string, Record<string, string>>} */
const titles = JSON.parse(document.querySelector("meta[name=titles]")?.getAttribute("content") ?? "{}");
/** @type {Record<string, string>} */
const english = { ...en, ...titles.en };
let chosen = english;

/**
 * Load the catalogue of a language.
 * @param {string} language
 */
export async function useLanguage(language) {
  if (language === "de") chosen = { ...(await import("../catalog/de.js")).default, ...titles.de };
  document.documentElement.lang = language;
}

/**
 * Add the texts of another workspace, in the chosen language.
 * @param {Record<string, string>} texts
 */
export function addTexts(texts) {
  chosen = { ...chosen, ...texts };
}

/**
 * The text of a key with its values filled in: `t("zero.done", { axes: "X Y" })`. `{count|line|lines}` is the first
 * word for a value of 1, else the second.
 * @param {TextKey} key
 * @param {Record<string, string | number>} [values]
 */
export function t(key, values = {}) {
  const text = chosen[key] ?? english[key] ?? key;
  return text.replace(/\{(\w+)(?:\|([^|}]*)\|([^|}]*))?\}/g, (_whole, name, one, more) => {
    const value = String(values[name] ?? "");
    return one === undefined ? value : value === "1" ? one : more;
  });
}

/**
 * The text of a key that is made at run time, or the fallback where there is none.
 * @param {string} key
 * @param {string} fallback
 */
export function textOr(key, fallback) {
  return chosen[key] ?? english[key] ?? fallback;
}
