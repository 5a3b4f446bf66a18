// PROG/PLC: the programs and PLC programs that are stored on the card.
import { get } from "../core/api.js";
import { give, model, refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { confirm } from "../frame/dialog.js";

const EVERY_MS = 1000;

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "card.title",
  area: "full",
  async show({ body, endings }) {
    body.classList.add("is-tabbed");
    const [list, text] = [h("div.form-tabs.list.scroll", {}), h("pre.listing-plain.mono.scroll", { tabIndex: 0, ariaLabel: t("card.listing") })];
    const keys = h("div.row", {});
    body.append(list, h("div.stack.grow", {}, keys, text));
    let chosen = "";
    const draw = async () => {
      const { programs, plcs } = await get("card/programs").catch((error) => {
        refuse(error);
        return { programs: [], plcs: [] };
      });
      const rows = [...programs.map((/** @type {any} */ each) => ({ ...each, kind: "program" })), ...plcs.map((/** @type {any} */ each) => ({ ...each, kind: "plc" }))];
      const focused = list.contains(document.activeElement) ? /** @type {HTMLElement} */ (document.activeElement).dataset.name : "";
      fill(list, ...rows.map((each) => h("button.key.item", { type: "button", data: { name: each.name }, attr: { "aria-current": String(each.name === chosen) }, onclick: () => show(each) },
        h("span.lamp", { className: each.running ? "lamp is-on" : "lamp", ariaHidden: "true" }), h("span.name", {}, each.name), h("span.quiet", {}, each.running ? t("plc.runs") : t("plc.stopped")))));
      if (focused) /** @type {HTMLElement | null} */ (list.querySelector(`[data-name="${focused}"]`))?.focus();
    };
    const show = async (/** @type {any} */ each) => {
      chosen = each.name;
      const number = each.number ?? Number(each.name.replace(/\D/g, ""));
      const { lines } = await get("card/listing", { [each.kind]: number }).catch(() => ({ lines: [] }));
      text.textContent = lines.join("\n") || t("card.empty");
      const act = async (/** @type {string} */ cmd) => {
        if (await confirm(each.name, t("card.sure"), t(cmd === "card.run" ? "card.run" : "card.halt"))) await give(cmd, { [each.kind]: number });
      };
      fill(keys, h("strong.grow", {}, each.name), ...(model.may("service") ? [h("button.key", { type: "button", onclick: () => act("card.run") }, t("card.run")), h("button.key", { type: "button", onclick: () => act("card.halt") }, t("card.halt"))] : []));
      await draw();
    };
    await draw();
    const timer = setInterval(draw, EVERY_MS);
    endings.add(() => clearInterval(timer));
  },
};
