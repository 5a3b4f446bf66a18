// FAST STATUS: the copies that the card keeps for fast readers.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { watchTable } from "../frame/watch_table.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Fast status", de: "Fast Status" },
  help: {
    en: "The copies that the card keeps for fast readers, live.",
    de: "Die Kopien, die die Karte für schnelle Leser bereithält, laufend.",
  },
  area: "full",
  async show({ body, endings }) {
    const host = h("div.fact-groups", {});
    body.append(h("div.notice", {}, t("diag.warning")), host);
    await watchTable(host, endings)({ object: "FSTAT" });
  },
};
