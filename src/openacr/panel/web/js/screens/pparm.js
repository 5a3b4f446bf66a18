// P PARM: the operator variables P0 to P199, read again while they are shown.
import { get, send } from "../core/api.js";
import { refuse, report } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { askNumber } from "../frame/number_pad.js";

const TEXTS = { done: { en: "P{n} is {value}", de: "P{n} ist {value}" } };

const COUNT = 200;
const EVERY_MS = 1000;

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "P parameters", de: "P-Parameter" },
  help: {
    en: "P0 to P99 are variables of the card, P100 to P199 of the store. Programs read and write them while they run.",
    de:
      "P0 bis P99 sind Variablen der Karte, P100 bis P199 solche des Speichers der Maschine. Programme lesen und " +
      "schreiben sie, während sie laufen.",
  },
  area: "full",
  show({ body, endings }) {
    /** @type {number[]} */
    let values = [];
    const cells = Array.from({ length: COUNT }, (_each, n) => {
      const value = h("strong.number.grow", {}, "\u2013");
      return {
        value,
        key: h("button.key.variable", { type: "button", onclick: () => enter(n) }, h("span.quiet", {}, `P${n}`), value),
      };
    });
    body.append(h("div.variables", {}, ...cells.map(({ key }) => key)));
    const read = async () => {
      try {
        ({ values } = await get("pparm"));
        values.forEach((value, n) => setText(cells[n].value, String(Number(value.toPrecision(10)))));
      } catch (error) {
        refuse(error);
      }
    };
    const enter = async (/** @type {number} */ n) => {
      const value = await askNumber({ title: `P${n}`, value: values[n] ?? 0 });
      if (value === null) return;
      try {
        await send("PUT", "pparm", { values: { [n]: value } });
        report(t(TEXTS.done, { n, value }));
        await read();
      } catch (error) {
        refuse(error);
      }
    };
    void read();
    const timer = setInterval(read, EVERY_MS);
    endings.add(() => clearInterval(timer));
  },
};
