// The PLC tab: the parameters of the PLC programs of the card, live.
import { refuse } from "../core/app.js";
import { h } from "../core/dom.js";
import { watchTable } from "./watch_table.js";

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export async function plcTab(panel, endings) {
  panel.classList.add("scroll");
  const host = h("div.fact-groups.block", {});
  panel.append(host);
  await watchTable(host, endings)({ object: "PLC" }).catch(refuse);
}
