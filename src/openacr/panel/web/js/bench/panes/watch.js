// The watch list: chosen parameters and flags with their values; the layout keeps it.
import { get } from "../../core/api.js";
import { refuse } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { FORMATS, LiveItems, fullName, isFlag } from "../../frame/card_value.js";
import { takeWanted } from "../wanted.js";

const TEXTS = {
  name: { en: "P12288, BIT516 or axis0.actual position", de: "P12288, BIT516 oder axis0.actual position" },
  add: { en: "ADD", de: "DAZU" },
  remove: { en: "Remove", de: "Entfernen" },
  format: { en: "Format", de: "Format" },
  formatOf: { en: "Format of {name}", de: "Format von {name}" },
};
/** @type {import("../../core/texts.js").Said[]} */
const HEADS = ["board.number", "board.name", "board.value", TEXTS.format, TEXTS.remove];

/**
 * @typedef {import("../../frame/card_value.js").Item} Item
 * @typedef {{ id: string, format: string }} Kept
 * @typedef {{ item: Item, format: string, value: HTMLElement }} Row
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const live = new LiveItems(update);
  /** @type {Row[]} */
  let rows = [];
  const field = h("input.field.grow", {
    ariaLabel: t(TEXTS.name),
    placeholder: t(TEXTS.name),
    autocomplete: "off",
    spellcheck: false,
  });
  const body = h("tbody", {});
  head.append(
    h(
      "form.row.grow",
      {
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          void add(field.value.split(";").filter((name) => name.trim())).then((isDone) => {
            if (isDone) field.value = "";
          });
        },
      },
      field,
      h("button.key.main", { type: "submit" }, t(TEXTS.add)),
    ),
  );
  host.append(
    h(
      "div.grow.scroll",
      { tabIndex: 0 },
      h("table.grid.watch-table", {}, h("thead", {}, h("tr", {}, ...HEADS.map((each) => h("th", {}, t(each))))), body),
    ),
  );

  /**
   * @param {string[]} names
   * @param {string[]} [formats]
   */
  async function add(names, formats = []) {
    if (!names.length) return false;
    const found = await get("card/named", { names: names.join(";") }).catch((error) => void refuse(error));
    if (!found) return false;
    for (const [n, item] of /** @type {[number, Item][]} */ (found.items.entries())) {
      if (!rows.some((row) => row.item.id === item.id))
        rows.push({ item, format: formats[n] ?? FORMATS[0], value: h("strong.live", {}) });
    }
    draw();
    return true;
  }

  function draw() {
    keep({ rows: rows.map(({ item, format }) => ({ id: item.id, format })) });
    fill(body, ...rows.map(rowOf));
    live.need(rows.map(({ item }) => item));
  }

  function update() {
    for (const { item, format, value } of rows) setText(value, live.text(item, format));
  }

  /** @param {Row} row */
  function rowOf(row) {
    const { item, value } = row;
    const format = h(
      "select.field",
      {
        ariaLabel: t(TEXTS.formatOf, { name: item.id }),
        onchange: () => {
          row.format = format.value;
          draw();
        },
      },
      ...FORMATS.map((each) =>
        h("option", { value: each, selected: each === row.format }, t(/** @type {any} */ (`watch.format.${each}`))),
      ),
    );
    const remove = h(
      "button.key",
      {
        type: "button",
        ariaLabel: t("bench.delete", { name: item.id }),
        onclick: () => {
          rows = rows.filter((each) => each !== row);
          draw();
        },
      },
      "\u00d7",
    );
    return h(
      "tr",
      { data: { item: item.id } },
      h("td.number", {}, item.id),
      h("td", { title: item.doc }, fullName(item)),
      h("td.number", {}, live.keyOf(item, value), item.unit ? ` ${item.unit}` : ""),
      h("td", {}, isFlag(item) ? "" : format),
      h("td", {}, remove),
    );
  }

  /** @type {Kept[]} */
  const before = kept.rows ?? [];
  await add(
    before.map(({ id }) => id),
    before.map(({ format }) => format),
  );
  endings.add(
    () => live.end(),
    takeWanted("watch", (ids) => void add(ids)),
  );
  return () => endings.end();
}
