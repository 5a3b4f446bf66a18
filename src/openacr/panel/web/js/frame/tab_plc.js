// The PLC tab: the PLC programs of the card, whether they run, and their listings.
import { get } from "../core/api.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

const EVERY_MS = 1000;

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export async function plcTab(panel, endings) {
  panel.classList.add("scroll");
  const [list, text] = [h("div.list", {}), h("pre.listing-plain.mono", { tabIndex: 0, ariaLabel: t("plc.listing") })];
  panel.append(h("section.block", {}, h("h3", {}, t("plc.title")), list), text);
  const draw = async () => {
    const { plcs } = await get("card/programs").catch(() => ({ plcs: [] }));
    fill(list, ...(plcs.length ? plcs.map((/** @type {any} */ plc) => rowOf(plc, text)) : [h("p.hint", {}, t("plc.none"))]));
  };
  await draw();
  const timer = setInterval(draw, EVERY_MS);
  endings.add(() => clearInterval(timer));
}

/**
 * @param {{ name: string, number?: number, running: boolean, scan_ms?: number }} plc
 * @param {HTMLElement} text
 */
function rowOf(plc, text) {
  const show = async () => {
    const number = plc.number ?? Number(plc.name.replace(/\D/g, ""));
    const { lines } = await get("card/listing", { plc: number }).catch(() => ({ lines: [] }));
    text.textContent = lines.join("\n");
  };
  return h("button.key.item", { type: "button", onclick: show }, h("span.lamp", { className: plc.running ? "lamp is-on" : "lamp", ariaHidden: "true" }),
    h("span.name", {}, plc.name), h("span.quiet", {}, plc.running ? t("plc.runs") : t("plc.stopped")), plc.scan_ms ? h("span.quiet.number", {}, `${plc.scan_ms} ms`) : "");
}
