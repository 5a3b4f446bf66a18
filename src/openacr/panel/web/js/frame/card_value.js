// A parameter or flag of the card: how its value is shown, and how it is changed.
import { give, model, report } from "../core/app.js";
import { h } from "../core/dom.js";
import { needWords, stateOf, wordsOf } from "../core/flags.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";
import { needValues } from "../core/values.js";
import { ask } from "./dialog.js";
import { logIn } from "./log_in.js";
import { askNumber } from "./number_pad.js";

const TEXTS = {
  once: {
    en: "The flag is written once, not held: the card, a program or a PLC may change it at any time.",
    de: "Der Merker wird einmal geschrieben, nicht gehalten: Die Karte, ein Programm oder eine SPS kann ihn jederzeit \u00e4ndern.",
  },
  held: {
    en: "An input that the machine drives: FORCE holds it at its level until RELEASE, as a stuck contact or a cut wire.",
    de: "Ein Eingang, den die Maschine treibt: ERZWINGEN h\u00e4lt ihn auf seinem Pegel bis FREIGEBEN, wie ein klebender Kontakt oder ein Drahtbruch.",
  },
  forceOff: { en: "FORCE OFF", de: "AUS ERZWINGEN" },
  forceOn: { en: "FORCE ON", de: "EIN ERZWINGEN" },
  release: { en: "RELEASE", de: "FREIGEBEN" },
};

/**
 * @typedef {{ id: string, number: number, name: string, object: string, index: number | null, section: string,
 *   doc: string, writable: boolean, unit?: string, parameter?: number }} Item
 */

/** How numbers can be shown. */
export const FORMATS = Object.freeze(["plain", "fixed", "hex", "binary"]);

/** @param {Item} item */
export function isFlag(item) {
  return item.parameter !== undefined;
}

/** @param {Item} item */
export function fullName(item) {
  return `${item.object}${item.index ?? ""} ${item.name}`.trim();
}

/** Values of the items that are shown at present. */
export class LiveItems {
  /** @param {() => void} update called when any may have changed */
  constructor(update) {
    this.update = update;
    this.needed = new Endings();
    /** @type {Map<number, number>} */
    this.values = new Map();
  }

  /** Have the values of these items come, and of no others. @param {Item[]} items */
  need(items) {
    this.end();
    const numbers = items.filter((item) => !isFlag(item)).map((item) => item.number);
    const words = wordsOf(items.filter(isFlag).map((item) => item.number));
    if (numbers.length)
      this.needed.add(
        needValues(numbers, (values) => {
          this.values = values;
          this.update();
        }),
      );
    if (words.length) this.needed.add(needWords(words));
    this.needed.add(model.flags.watch(this.update));
  }

  end() {
    this.needed.end();
  }

  /**
   * The value of an item as a text; a dash while it is unknown.
   * @param {Item} item
   * @param {string} [format]
   */
  text(item, format = "plain") {
    if (isFlag(item)) {
      const isOn = stateOf(model.flags.value, item.number);
      return isOn === undefined ? "\u2013" : t(isOn ? "io.on" : "io.off");
    }
    const value = this.values.get(item.number);
    return value === undefined ? "\u2013" : numberText(value, format);
  }

  /**
   * What shows the value of an item, in the key that changes it, where it can be changed.
   * @param {Item} item
   * @param {HTMLElement} value
   */
  keyOf(item, value) {
    if (!item.writable) return value;
    const ariaLabel = t("watch.change", { name: item.id });
    return h("button.key", { type: "button", ariaLabel, onclick: () => changeValue(item, this.text(item)) }, value);
  }
}

/**
 * @param {number} value
 * @param {string} format
 */
export function numberText(value, format) {
  if (format === "fixed") return value.toFixed(3);
  const whole = Math.trunc(value) >>> 0; // the 32 bits of the card
  if (format === "hex") return `0x${whole.toString(16).toUpperCase().padStart(8, "0")}`;
  if (format === "binary")
    return whole
      .toString(2)
      .padStart(32, "0")
      .replace(/(.{8})(?=.)/g, "$1 ");
  return shortest(value);
}

/**
 * The fewest digits that mean this number: 0.002441 of a gain that the card keeps in 32 bits, all digits of a counter.
 * @param {number} value
 */
function shortest(value) {
  if (Number.isInteger(value)) return String(value);
  if (Math.fround(value) !== value) return String(Number(value.toPrecision(9)));
  for (let digits = 6; digits < 9; digits++) {
    const rounded = Number(value.toPrecision(digits));
    if (Math.fround(rounded) === value) return String(rounded);
  }
  return String(Number(value.toPrecision(9)));
}

/**
 * Ask for another value and write it; the card's refusal is shown.
 * @param {Item} item
 * @param {string} shown its present value
 */
export async function changeValue(item, shown) {
  if (!model.may("service") && !(await logIn("service"))) return;
  const title = `${item.id} ${fullName(item)}`;
  if (isFlag(item) && model.forced.value.inputs.includes(item.number)) {
    await forceInput(item, title, shown);
    return;
  }
  if (isFlag(item)) {
    const choices = [
      { text: t("key.cancel"), value: null },
      { text: t("values.clear"), value: 0 },
      { text: t("values.set"), value: 1 },
    ];
    const chosen = await ask({
      title,
      body: [h("p", {}, item.doc), h("p", {}, t("values.now", { value: shown })), h("p.hint", {}, t(TEXTS.once))],
      choices,
    });
    if (chosen === null) return;
    const answer = await give("card.flag", { flag: item.number, on: chosen === 1 });
    if (answer) report(t("values.is", { name: title, value: t(answer.on ? "io.on" : "io.off") }));
    return;
  }
  const number = await askNumber({ title, value: Number(shown) || 0, unit: item.unit, hint: item.doc });
  if (number === null) return;
  const answer = await give("card.write", { parameter: item.number, value: number });
  if (answer) report(t("board.written", { number: item.number, value: answer.value }));
}

/**
 * Hold an input of the machine at a level, or release it.
 * @param {Item} item
 * @param {string} title
 * @param {string} shown
 */
async function forceInput(item, title, shown) {
  const isForced = model.forced.value.forced.some(({ input }) => input === item.number);
  const state = await ask({
    title,
    body: [h("p", {}, item.doc), h("p", {}, t("values.now", { value: shown })), h("p.hint", {}, t(TEXTS.held))],
    choices: [
      { text: t("key.cancel"), value: null },
      ...(isForced ? [{ text: t(TEXTS.release), value: "released" }] : []),
      { text: t(TEXTS.forceOff), value: "off" },
      { text: t(TEXTS.forceOn), value: "on" },
    ],
  });
  if (state) await give("world.input", { input: item.number, state });
}
