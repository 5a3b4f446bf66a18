// Texts of settings come from the server in English, as in the guide; in German they are found by those texts.
import { language } from "./texts.js";

/** @type {Record<string, string>} */
let german = {};
const NUMBER = /\d+(?:\.\d+)*/g;
const REFUSED = /^(P\d+) (.+?)( \(axis (\d)\))? cannot be (.+?): (.+?)(?: \(([^()]*(?:\([^()]*\)[^()]*)*)\))?$/s;
// What a cell accepts, part by part.
/** @type {[RegExp, string][]} */
const ACCEPTED = [
  [/^one of /, "eines von "],
  [/^(a|any) whole number ?/, "eine ganze Zahl "],
  [/^(a|any) number ?/, "eine Zahl "],
  [/\bother than 0/, "außer 0"],
  [/\bfrom (\S+) up$/, "ab $1"],
  [/\bfrom (\S+) to /, "von $1 bis "],
  [/\babove (\S+) up to /, "über $1 bis "],
  [/\babove /, "über "],
  [/ is already used by (P\d+) (.+)$/, " gehört schon zu $1 $2"],
];

/** To be waited for before texts of settings are shown. */
export async function loadSettingTexts() {
  if (language() !== "de") return;
  const { default: settings, REASONS } = await import("../catalog/settings_de.js");
  german = { ...settings, ...REASONS };
}

/**
 * A text of a setting in the chosen language, or as it is; numbers in it are kept.
 * @param {string} english
 */
export function settingText(english) {
  const said = german[english.replace(NUMBER, "{}")];
  if (said === undefined) return english;
  const numbers = english.match(NUMBER) ?? [];
  return said.replace(/\{\}/g, () => numbers.shift() ?? "");
}

/**
 * What to search for: the words as they are and, in German, the English texts that are said with them (6 at most).
 * @param {string} words
 */
export function searchedTexts(words) {
  const wanted = words.toLowerCase();
  const meant = Object.keys(german).filter((english) => german[english]?.toLowerCase().includes(wanted));
  return [words, ...meant.slice(0, 6).map((english) => (english.split("{}")[0] || english).trim())];
}

/**
 * The reason of a refused value in the chosen language.
 * @param {string} english
 */
export function refusalText(english) {
  const found = language() === "de" ? REFUSED.exec(english) : null;
  if (!found) return english;
  const [, cell, name, , axis, value, expected, hint] = found;
  const place = axis === undefined ? "" : ` (Achse ${axis})`;
  const change = value === "changed" ? "kann nicht geändert werden" : `kann nicht ${value} sein`;
  const tail = hint === undefined ? "" : ` (${settingText(hint)})`;
  return `${cell} ${settingText(name)}${place} ${change}: ${acceptedText(expected)}${tail}`;
}

/** @param {string} english */
function acceptedText(english) {
  const whole = settingText(english);
  if (whole !== english) return whole;
  return ACCEPTED.reduce((text, [pattern, said]) => text.replace(pattern, said), english).replace(
    /(-?\d+)( \(| = )([^;,)]+)/g, // values with their words
    (_whole, value, between, word) => value + between + settingText(word),
  );
}
