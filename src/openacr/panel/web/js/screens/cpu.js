// CPU LOAD: how busy the card is.
import { h } from "../core/dom.js";
import { watchTable } from "../frame/watch_table.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "cpu.title",
  area: "full",
  async show({ body, endings }) {
    const host = h("div.fact-groups", {});
    body.append(host);
    await watchTable(host, endings)({ text: "load" });
  },
};
