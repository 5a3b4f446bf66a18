// CPU LOAD: how busy the processor of the card is, in per cent.
import { CommandError } from "../core/link.js";
import { link, refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

const TEXTS = {
  foreground: { en: "Servo interrupt", de: "Servo-Interrupt" },
  background: { en: "Left for programs", de: "Für Programme übrig" },
};

const EVERY_MS = 1000;
const SHARE = /^(\w+) ([\d.]+)%$/;

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "CPU load", de: "CPU-Last" },
  help: {
    en: "How much of its time the processor of the card is busy, in per cent.",
    de: "Wie viel seiner Zeit der Prozessor der Karte beschäftigt ist, in Prozent.",
  },
  area: "full",
  async show({ body, endings }) {
    const host = h("div.stack", { role: "status" });
    body.append(host);
    const ask = async () => {
      try {
        const { lines } = await link.command("card.query", { line: "CPU" });
        fill(host, ...lines.map(rowOf));
      } catch (error) {
        if (!(error instanceof CommandError)) throw error;
        refuse(error);
      }
    };
    await ask();
    const timer = setInterval(ask, EVERY_MS);
    endings.add(() => clearInterval(timer));
  },
};

/**
 * "Foreground 29.0%": the servo interrupt; "Background": what programs have left.
 * @param {string} line
 */
function rowOf(line) {
  const found = SHARE.exec(line);
  if (!found) return h("p", {}, line);
  const label = t(found[1] === "Foreground" ? TEXTS.foreground : TEXTS.background);
  return h(
    "label.cpu-row",
    {},
    h("span", {}, label),
    h("meter", { min: 0, max: 100, value: Number(found[2]) }),
    h("strong.number", {}, `${found[2]} %`),
  );
}
