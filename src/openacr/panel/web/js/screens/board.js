// BOARD PARAMETERS: every parameter of the card, page by page or by a search, with live values.
import { get } from "../core/api.js";
import { give, link, model, refuse, report } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { askNumber } from "../frame/number_pad.js";

const PAGE = 60; // a browser watches 64 parameters at most

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "board.title",
  area: "full",
  async show({ body, head, endings }) {
    const field = h("input.field", { type: "search", placeholder: t("board.search"), ariaLabel: t("board.search") });
    let first = 0;
    const pages = h("div.row", {});
    head.append(pages, field);
    const rows = h("tbody", {});
    body.append(h("div.notice", {}, t("diag.warning")), h("div.grow.scroll", {}, h("table.grid", {}, h("thead", {}, h("tr", {},
      ...["board.number", "board.name", "board.value", "board.doc"].map((key) => h("th", {}, t(/** @type {any} */ (key)))))), rows)));
    /** @type {HTMLElement[]} */
    let values = [];
    let unsubscribe = () => {};
    const search = async () => {
      try {
        const { parameters: shown, total } = await get("card/parameters", { text: field.value.trim() || undefined, first, count: PAGE });
        drawPages(total);
        values = shown.map(() => h("strong.live", {}, "\u2013"));
        fill(rows, ...shown.map((/** @type {any} */ each, /** @type {number} */ n) => rowOf(each, values[n])));
        unsubscribe();
        unsubscribe = link.subscribe({ topic: "watch", hz: 5, parameters: shown.map((/** @type {any} */ each) => each.number) });
      } catch (error) {
        refuse(error);
      }
    };
    /** @param {number} total */
    function drawPages(total) {
      const go = (/** @type {number} */ place) => {
        first = Math.max(0, Math.min(place, Math.floor(Math.max(0, total - 1) / PAGE) * PAGE));
        void search();
      };
      const find = async () => {
        const wanted = await askNumber({ title: t("form.goto"), value: first + 1, hint: t("form.goto.hint", { last: total }) });
        if (wanted !== null) go(Math.floor((wanted - 1) / PAGE) * PAGE);
      };
      fill(pages, h("button.key", { type: "button", disabled: first === 0, ariaLabel: t("form.previous"), onclick: () => go(first - PAGE) }, "\u25c0"),
        h("button.key", { type: "button", onclick: find }, t("form.page", { first: total ? first + 1 : 0, last: Math.min(total, first + PAGE), total })),
        h("button.key", { type: "button", disabled: first + PAGE >= total, ariaLabel: t("form.next"), onclick: () => go(first + PAGE) }, "\u25b6"));
    }

    /** @type {ReturnType<typeof setTimeout> | undefined} */
    let timer;
    field.addEventListener("input", () => {
      clearTimeout(timer);
      first = 0;
      timer = setTimeout(search, 250);
    });
    endings.add(() => unsubscribe(), () => clearTimeout(timer), model.watched.watch((pairs) => {
      for (const [n, value] of pairs) if (values[n]) setText(values[n], String(Number(value.toPrecision(9))));
    }));
    await search();
  },
};

/**
 * @param {{ number: number, name: string, unit: string, doc: string, writable: boolean }} parameter
 * @param {HTMLElement} value
 */
function rowOf(parameter, value) {
  const write = async () => {
    const number = await askNumber({ title: `P${parameter.number} ${parameter.name}`, value: Number(value.textContent) || 0, unit: parameter.unit });
    if (number === null) return;
    const answer = await give("card.write", { parameter: parameter.number, value: number });
    if (answer) report(t("board.written", { number: parameter.number, value: answer.value }));
  };
  const cell = parameter.writable && model.may("service") ? h("button.key", { type: "button", onclick: write }, value) : value;
  return h("tr", {}, h("td.number", {}, `P${parameter.number}`), h("td", {}, parameter.name), h("td.number", {}, cell, parameter.unit ? ` ${parameter.unit}` : ""), h("td.quiet", {}, parameter.doc));
}
