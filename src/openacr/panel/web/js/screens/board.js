// BOARD PARAMETERS: every parameter of the card, page by page or by a search, with live values.
import { get, latest } from "../core/api.js";
import { model, refuse } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { LiveItems, changeValue } from "../frame/card_value.js";
import { askNumber } from "../frame/number_pad.js";

const TEXTS = { search: { en: "Name or number", de: "Name oder Nummer" }, doc: { en: "Meaning", de: "Bedeutung" } };

/** @type {import("../core/texts.js").Said[]} */
const HEADS = ["board.number", "board.name", "board.value", TEXTS.doc];
const PAGE = 60;

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "board.title",
  area: "full",
  async show({ body, head, endings }) {
    const field = h("input.field", { type: "search", placeholder: t(TEXTS.search), ariaLabel: t(TEXTS.search) });
    let first = 0;
    const pages = h("div.row", {});
    head.append(pages, field);
    const rows = h("tbody", {});
    body.append(
      h("div.notice", {}, t("diag.warning")),
      h(
        "div.grow.scroll",
        {},
        h("table.grid", {}, h("thead", {}, h("tr", {}, ...HEADS.map((each) => h("th", {}, t(each))))), rows),
      ),
    );
    /** @type {{ item: import("../frame/card_value.js").Item, value: HTMLElement }[]} */
    let shown = [];
    const live = new LiveItems(() => {
      for (const { item, value } of shown) setText(value, live.text(item));
    });
    const newest = latest(endings);
    const search = async () => {
      try {
        const found = await newest(
          get("card/parameters", { text: field.value.trim() || undefined, first, count: PAGE }),
        );
        if (!found) return;
        drawPages(found.total);
        shown = found.parameters.map((/** @type {any} */ item) => ({ item, value: h("strong.live", {}) }));
        fill(rows, ...shown.map(({ item, value }) => rowOf(item, value)));
        live.need(shown.map(({ item }) => item));
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
        const wanted = await askNumber({
          title: t("form.goto"),
          value: first + 1,
          hint: t("form.goto.hint", { last: total }),
        });
        if (wanted !== null) go(Math.floor((wanted - 1) / PAGE) * PAGE);
      };
      fill(
        pages,
        h(
          "button.key",
          { type: "button", disabled: first === 0, ariaLabel: t("form.previous"), onclick: () => go(first - PAGE) },
          "\u25c0",
        ),
        h(
          "button.key",
          { type: "button", onclick: find },
          t("form.page", { first: total ? first + 1 : 0, last: Math.min(total, first + PAGE), total }),
        ),
        h(
          "button.key",
          {
            type: "button",
            disabled: first + PAGE >= total,
            ariaLabel: t("form.next"),
            onclick: () => go(first + PAGE),
          },
          "\u25b6",
        ),
      );
    }

    /** @type {ReturnType<typeof setTimeout> | undefined} */
    let timer;
    field.addEventListener("input", () => {
      clearTimeout(timer);
      first = 0;
      timer = setTimeout(search, 250);
    });
    endings.add(
      () => live.end(),
      () => clearTimeout(timer),
    );
    await search();
  },
};

/**
 * @param {import("../frame/card_value.js").Item} item
 * @param {HTMLElement} value
 */
function rowOf(item, value) {
  const cell =
    item.writable && model.may("service")
      ? h("button.key", { type: "button", onclick: () => changeValue(item, value.textContent ?? "") }, value)
      : value;
  return h(
    "tr",
    {},
    h("td.number", {}, item.id),
    h("td", {}, item.name),
    h("td.number", {}, cell, item.unit ? ` ${item.unit}` : ""),
    h("td.quiet", {}, item.doc),
  );
}
