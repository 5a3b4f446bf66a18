// The I/O STATUS tab: every input and output with its name and state.
import { get } from "../core/api.js";
import { link, model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";

const FIRST_WORD = 4096;

/** @typedef {{ number: number, bit: number, name: string }} Point */

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export async function ioTab(panel, endings) {
  panel.classList.add("scroll");
  endings.add(link.subscribe({ topic: "flags", hz: 10, inputs: true }));
  const io = await get("io").catch(() => plainPoints());
  const draws = [["io.inputs", io.inputs], ["io.outputs", io.outputs]].map(([title, points]) => columnOf(panel, t(title), points));
  endings.add(model.flags.watch((words) => draws.forEach((draw) => draw(words))));
}

/** Without names from the machine: inputs 0 to 31 and outputs 32 to 63 of the card. */
function plainPoints() {
  const points = (/** @type {number} */ from) => Array.from({ length: 32 }, (_each, n) => ({ number: from + n, bit: from + n, name: "" }));
  return { inputs: points(0), outputs: points(32) };
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
      const word = words.get(FIRST_WORD + Math.floor(point.bit / 32));
      const isOn = word !== undefined && ((word >>> (point.bit % 32)) & 1) === 1;
      lamp.classList.toggle("is-on", isOn);
      setText(state, word === undefined ? "\u2013" : isOn ? t("io.on") : t("io.off"));
    }
  };
}
