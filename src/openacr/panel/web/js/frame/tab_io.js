// The I/O STATUS tab: every input and output with its name and state.
import { get } from "../core/api.js";
import { model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { needWords, stateOf, wordsOf } from "../core/flags.js";
import { t } from "../core/texts.js";

const INPUT_NAMES = 960000;
const OUTPUT_NAMES = 970000;
const FIRST_OUTPUT = 32;
const EACH = 32;

/** @typedef {{ number: number, name: string }} Point */

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export async function ioTab(panel, endings) {
  panel.classList.add("scroll");
  const names = await readNames();
  const points = (/** @type {number} */ first, /** @type {number} */ cells) =>
    Array.from({ length: EACH }, (_each, n) => ({ number: first + n, name: names.get(cells + n) ?? "" }));
  const inputs = points(0, INPUT_NAMES);
  const outputs = points(FIRST_OUTPUT, OUTPUT_NAMES);
  const draws = [columnOf(panel, t("io.inputs"), inputs), columnOf(panel, t("io.outputs"), outputs)];
  endings.add(needWords(wordsOf([...inputs, ...outputs].map(({ number }) => number))), model.flags.watch((words) => draws.forEach((draw) => draw(words))));
}

/** The names that the builder of the machine gave, by cell. */
async function readNames() {
  const form = await get("forms/IONAMES").catch(() => ({ groups: [] }));
  const rows = form.groups.flatMap((/** @type {any} */ group) => group.rows);
  return new Map(rows.map((/** @type {any} */ row) => [Number(row.number), String(row.value)]));
}

/**
 * @param {HTMLElement} panel
 * @param {string} title
 * @param {Point[]} points
 */
function columnOf(panel, title, points) {
  const rows = points.map((point) => {
    const [lamp, state] = [h("span.lamp", { ariaHidden: "true" }), h("span.io-state", {})];
    return { point, lamp, state, element: h("div.io-row", {}, lamp, h("span.number", {}, String(point.number)), h("span.io-name", { title: point.name }, point.name), state) };
  });
  panel.append(h("section.block", { ariaLabel: title }, h("h3", {}, title), h("div.io-list", {}, ...rows.map((row) => row.element))));
  return (/** @type {Map<number, number>} */ words) => {
    for (const { point, lamp, state } of rows) {
      const isOn = stateOf(words, point.number);
      lamp.classList.toggle("is-on", isOn === true);
      setText(state, isOn === undefined ? "\u2013" : isOn ? t("io.on") : t("io.off"));
    }
  };
}
